//! Formats, sizes and sample counts of images, each its own or that of an image that it follows.

use super::follow::follow_all;
use super::shapes;
use crate::base::{Code, Diagnostic, Span};
use crate::expand::mistakes::ReportedMistakes;
use crate::frame::check::Property;
use crate::frame::check::images::Declaration;
use crate::frame::{self, Image, Lifetime, check};
use crate::language::{self, Decided, Format as Described, ImageRef, Mips, Pipeline, Resolves, Samples};
use crate::vulkan::{Format, Rotation, Shape};
use std::sync::Arc;

/// An image of the frame, and where its samples come from.
pub(in crate::expand) struct FrameImage {
    pub(in crate::expand) image: Image,
    /// "msaa = 4" if a setting decides how many samples it has.
    pub(in crate::expand) samples_because: Option<Arc<str>>,
}

/// Every image of the pipeline in a frame of this size, whose outputs for a screen have the format `output`; `None` where a mistake
/// was reported.
pub(in crate::expand) fn resolve(
    pipeline: &Pipeline,
    extent: [u32; 2],
    output: Format,
    (reported, errors): (&mut ReportedMistakes, &mut Vec<Diagnostic>),
) -> Vec<Option<FrameImage>> {
    let images = &pipeline.images;
    let formats = follow_all(
        images,
        |image| image.format.value.follows().map(index),
        |image, followed| format(image, output, followed),
    );
    let before = errors.len();
    let areas = follow_all(
        images,
        |image| image.size.value.follows().map(index),
        |image, followed| {
            let view = pipeline.views.get(image.view.0 as usize);
            let area = language::area(image, view.map_or(extent, |view| view.extent), followed);
            area.map_err(|wrong| errors.push(wrong)).ok().flatten()
        },
    );
    reported.each_once(errors, before);
    let samples = follow_all(
        images,
        |image| image.samples.value.follows().map(index),
        |image, followed| samples(image, followed),
    );
    let layers = follow_all(
        images,
        |image| image.layers.value.follows().map(index),
        |image, followed| shapes::layers(image, followed),
    );
    let mips = follow_all(
        images,
        |image| image.mips.value.follows().map(index),
        |image, followed| match image.mips.value {
            Mips::Count(count) => Some(shapes::Levels::Count(count)),
            Mips::Full => Some(shapes::Levels::Full),
            Mips::Like(_) => followed,
        },
    );
    let policy = pipeline.depth.as_ref();
    let all = images.iter().zip(formats).zip(areas).zip(samples).zip(layers).zip(mips);
    all.map(|(((((described, format), area), samples), layers), mips)| {
        let (language::Area { extent: [width, height], allocated }, (samples, samples_because)) = (area?, samples?);
        let image = Image {
            name: described.name.text.clone(),
            span: described.name.span,
            format: format?,
            shape: Shape::D2,
            extent: [width, height, 1],
            allocated,
            rotation: Rotation::Identity,
            eyes: described.eyes,
            mips: 1,
            layers: 1,
            samples,
            resolve: None,
            chosen: None,
            lifetime: Lifetime::Transient,
        };
        let before = errors.len();
        let image = asked(described, &image, policy, errors)
            .and_then(|resolve| shapes::shaped(described, Image { resolve, ..image }, layers?, mips?, errors));
        reported.once(errors, before);
        Some(FrameImage { image: image?, samples_because })
    })
    .collect()
}

/// The number of the image that another one follows.
pub(in crate::expand) fn index(of: ImageRef) -> usize {
    of.index.0 as usize
}

fn format(image: &language::Image, output: Format, followed: Option<Format>) -> Option<Format> {
    match image.format.value {
        Described::Color { hdr: true, .. } => Some(Format::R16G16B16A16_SFLOAT),
        Described::Color { hdr: false, .. } => Some(Format::R8G8B8A8_SRGB),
        Described::Output => Some(output),
        Described::Depth => Some(Format::D32_SFLOAT),
        Described::DepthStencil => Some(Format::D32_SFLOAT_S8_UINT),
        Described::Named(format) => Some(format),
        Described::Like(_) => followed,
    }
}

/// How several samples of an image become one value, if it or, for depth, the pipeline says so. `None` after a mistake.
fn asked(
    described: &language::Image,
    image: &Image,
    policy: Option<&Resolves>,
    errors: &mut Vec<Diagnostic>,
) -> Option<Option<frame::Resolve>> {
    let depth = image.format.is_depth();
    let Some(Resolves { resolve, said }) = described.resolve.as_ref().or(policy.filter(|_| depth)) else {
        return Some(None);
    };
    let way = resolve.value;
    if !way.fits(image.format) {
        let ways = match (depth, image.format.is_integer()) {
            (true, _) => "write `DepthOnly`, `SampleZero`, `Min`, `Max` or `Average`",
            (false, true) => "write `SampleZero`",
            (false, false) => "write `Average` or `Weighted`",
        };
        let message = format!("`{}` can't be resolved so: it is {}", image.name, image.format);
        let wrong =
            Diagnostic::new(Code::RESOLVE_UNFIT, resolve.span, message).label(described.format.span, "its format");
        errors.push(wrong.help(ways));
        return None;
    }
    Some(Some(frame::Resolve { way, because: said.clone() }))
}

fn samples(image: &language::Image, followed: Option<(u32, Option<Arc<str>>)>) -> Option<(u32, Option<Arc<str>>)> {
    match image.samples.value {
        Samples::Like(_) => followed,
        Samples::Count(count) => Some((count, image.samples.because.clone())),
    }
}

impl FrameImage {
    /// How many samples, and why: "4 samples (msaa = 4)".
    pub(in crate::expand) fn samples_words(&self) -> String {
        check::targets::samples_words(self.image.samples, self.samples_because.as_deref())
    }
}

impl Declaration for language::Image {
    fn at(&self, property: Property) -> (Span, &str) {
        fn decided<T>(property: &Decided<T>) -> (Span, &str) {
            (property.span, property.remark())
        }
        match property {
            Property::Format => decided(&self.format),
            Property::Size => decided(&self.size),
            Property::Shape => decided(&self.shape),
            Property::Mips => decided(&self.mips),
            Property::Layers => decided(&self.layers),
            Property::Samples => decided(&self.samples),
            Property::Lifetime => (self.lifetime.span, ""),
        }
    }

    fn is_kept(&self) -> bool {
        use language::Lifetime::{File, History, Imported, Like, Persistent, Transient};
        match self.lifetime.value {
            // The frame's own images are checked once it is known what they follow.
            Transient | History { .. } | Like(_) => false,
            Persistent { .. } | Imported { .. } | File(_) => true,
        }
    }
}
