//! Formats by policy: the formats of `Color` and `Depth` images, if the pipeline says how exact they are to be.
//!
//! Policies apply only to images that passes of the frame alone draw and sample. An image that comes in, leaves, is a
//! storage image, or is copied to or from buffers or by custom passes has the usual format: others may rely on it. Images
//! that follow each other, or are copied texel for texel, have one format. Colour keeps its alpha, unless its format has none.

use super::passes::State;
use super::resources::Resources;
use crate::base::Span;
use crate::frame::{Access, ChosenFormat, Draw, ImageIndex, Lifetime, NoteKind, Output, Pass, Remark, Resource};
use crate::language::{self, Format as Described, Precision, Precisions};
use crate::vulkan::Format;
use petgraph::unionfind::UnionFind;
use std::collections::BTreeSet;

/// The format that a pipeline's policy wants in place of `usual`. `range`: how far the scene reaches that is drawn into the
/// image as depth, in near distances.
fn wanted(resources: &Resources<'_>, described: &Described, usual: Format, range: f64) -> WantedFormat {
    let pipeline = resources.pipeline;
    let policy = match described {
        Described::Color { .. } => &pipeline.color,
        Described::Depth | Described::DepthStencil => &pipeline.depth_format,
        Described::Output | Described::Named(_) | Described::Like(_) => return WantedFormat::Usual,
    };
    let Some(Precisions { precision, said, .. }) = policy.as_ref() else { return WantedFormat::Usual };
    let formats: &[Format] = match (described, precision) {
        (Described::Color { hdr: true, .. }, Precision::Smallest) => &[Format::B10G11R11_UFLOAT_PACK32],
        (Described::Color { hdr: true, .. }, Precision::Exact) => &[Format::R32G32B32A32_SFLOAT],
        (Described::Color { hdr: false, .. }, Precision::Exact) => &[Format::R16G16B16A16_UNORM],
        (Described::Depth, Precision::Smallest) => &[Format::D16_UNORM, Format::X8_D24_UNORM_PACK32],
        (Described::Depth, Precision::Balanced) => &[Format::X8_D24_UNORM_PACK32],
        (Described::DepthStencil, Precision::Smallest | Precision::Balanced) => &[Format::D24_UNORM_S8_UINT],
        _ => &[],
    };
    let Some(first) = formats.iter().find(|format| **format != usual) else { return WantedFormat::Usual };
    let choice = ChosenFormat { usual, because: said.clone() };
    match formats.iter().find(|format| range <= reach(**format)) {
        Some(format) if format == first => WantedFormat::Asked(*format, choice),
        fits => WantedFormat::Finer { format: *fits.unwrap_or(&usual), too_coarse: *first, choice },
    }
}

/// The format that a pipeline's policy wants for an image.
enum WantedFormat {
    /// The usual format, as without a policy.
    Usual,
    /// The format that the policy names.
    Asked(Format, ChosenFormat),
    /// Depth in a finer format, since the scene reaches too far for the format that the policy names.
    Finer { format: Format, too_coarse: Format, choice: ChosenFormat },
}

/// The farthest surface is told apart from one that lies this share of its distance behind it.
const APART: f64 = 1.0 / 64.0;

/// How many near distances away depth of a format still tells things apart that lie [`APART`]. Reversed depth without a far
/// plane is d = near / z; one step of `2ⁿ − 1` in it is Δz = z² / (near · (2ⁿ − 1)), so Δz / z ≤ APART up to
/// z / near = APART · (2ⁿ − 1). Steps of floating point are shares of d at any distance.
fn reach(format: Format) -> f64 {
    let steps = |bits: i32| 2_f64.powi(bits) - 1.0;
    match format {
        Format::D16_UNORM => APART * steps(16),
        Format::X8_D24_UNORM_PACK32 | Format::D24_UNORM_S8_UINT => APART * steps(24),
        _ => f64::INFINITY,
    }
}

/// Gives images the formats of the pipeline's policies. `states` are those of the pipeline's passes. Returns remarks on
/// images whose colour must keep its format, with the reason, and on depth that takes more bits than were asked for.
/// `depth_range` is that of the scene's [`Facts`](crate::language::Facts).
pub(super) fn choose(
    depth_range: Option<f64>,
    resources: &mut Resources<'_>,
    states: &[State],
    outputs: &[Output],
) -> Vec<Remark> {
    let pipeline = resources.pipeline;
    if pipeline.color.is_none() && pipeline.depth_format.is_none() {
        return Vec::new();
    }
    let mut alike = UnionFind::<u32>::new(pipeline.images.len());
    for (image, at) in pipeline.images.iter().zip(0..) {
        if let Described::Like(of) = image.format.value {
            alike.union(at, of.index.0);
        }
    }
    let passes = running(states);
    for [one, other] in passes.iter().filter_map(|pass| copied(resources, pass)) {
        alike.union(one.0, other.0);
    }
    let fixed = fixed(resources, states, outputs);
    let mut remarks = Vec::new();
    for group in groups(&mut alike, pipeline.images.len()) {
        let format = |at: &u32| resources.image(ImageIndex(*at)).map(|image| image.image.format);
        // Maps of shadows hold distances of a projection whose steps are everywhere the same.
        let range =
            depth_range.filter(|_| group.iter().any(|at| is_seen_depth(&passes, ImageIndex(*at)))).unwrap_or(1.0);
        let of_group = group.iter().filter_map(|at| {
            let described = &pipeline.images[*at as usize];
            match wanted(resources, &described.format.value, format(at)?, range) {
                WantedFormat::Usual => None,
                WantedFormat::Asked(format, choice) => Some((described, format, choice, None)),
                WantedFormat::Finer { format, too_coarse, choice } => {
                    Some((described, format, choice, Some(too_coarse)))
                }
            }
        });
        // All images of a group have one format; the first of them decides.
        let Some((described, format, choice, too_coarse)) = of_group.into_iter().next() else { continue };
        let no_alpha = format.components() < choice.usual.components() && !format.is_depth();
        let alpha = group.iter().find_map(|at| keeps_alpha(&pipeline.images[*at as usize])).filter(|_| no_alpha);
        if let Some(Hindrance { why, span }) = group.iter().find_map(|at| fixed[*at as usize].clone()).or(alpha) {
            let text = format!("{} is taken in spite of {}: {why}", choice.usual, choice.because);
            remarks.push(Remark { kind: NoteKind::PolicyHindered, subject: described.name.text.clone(), span, text });
            continue;
        }
        if let Some(coarse) = too_coarse {
            let text = format!("{format} is taken in spite of {}: {}", choice.because, too_coarse_for(coarse, range));
            let span = described.format.span;
            remarks.push(Remark { kind: NoteKind::PolicyTooCoarse, subject: described.name.text.clone(), span, text });
        }
        if format == choice.usual {
            continue;
        }
        for at in &group {
            if let Some(image) = resources.images[*at as usize].as_mut().map(|image| &mut image.image) {
                (image.format, image.chosen) = (format, Some(choice.clone()));
            }
        }
    }
    remarks
}

/// Remarks on images whose format stands in the file, and is too coarse for the depth of the scene that is drawn into them.
/// `depth_range` is that of the scene's [`Facts`](crate::language::Facts).
pub(super) fn too_coarse(depth_range: Option<f64>, resources: &Resources<'_>, states: &[State]) -> Vec<Remark> {
    let Some(range) = depth_range else { return Vec::new() };
    let seen = running(states).into_iter().filter(|pass| draws_objects(pass)).filter_map(|pass| pass.depth.as_ref());
    let seen: BTreeSet<u32> = seen.map(|depth| depth.image.0).collect();
    let remarks = seen.into_iter().filter_map(|at| {
        let format = resources.image(ImageIndex(at))?.image.format;
        let described = &resources.pipeline.images[at as usize];
        // Formats that a policy chooses reach as far as they must.
        (range > reach(format)).then(|| Remark {
            kind: NoteKind::TooCoarse,
            subject: described.name.text.clone(),
            span: described.format.span,
            text: format!("{}; `Depth` in its place reaches any distance", too_coarse_for(format, range)),
        })
    });
    remarks.collect()
}

/// Why a format can't hold depth of a scene that reaches `range` near distances.
fn too_coarse_for(format: Format, range: f64) -> String {
    format!(
        "{format} is too coarse, since the scene reaches {range:.0} times as far as the near plane, and {format} is good for {:.0} \
         times",
        reach(format).floor()
    )
}

/// Whether objects are drawn into an image as a camera sees them.
fn is_seen_depth(passes: &[&Pass], image: ImageIndex) -> bool {
    let into_it = |pass: &&Pass| pass.depth.as_ref().is_some_and(|depth| depth.image == image);
    passes.iter().any(|pass| draws_objects(pass) && into_it(pass))
}

fn draws_objects(pass: &Pass) -> bool {
    pass.work.draws(Draw::shows_objects)
}

/// Images that have one format together, each group in the order of the file.
fn groups(alike: &mut UnionFind<u32>, images: usize) -> Vec<Vec<u32>> {
    let mut groups = std::collections::BTreeMap::<u32, Vec<u32>>::new();
    for at in (0_u32..).take(images) {
        groups.entry(alike.find_mut(at)).or_default().push(at);
    }
    groups.into_values().collect()
}

/// The passes that run, those that stand in for others among them.
fn running(states: &[State]) -> Vec<&Pass> {
    let passes = states.iter().flat_map(|state| match state {
        State::On(pass) => std::slice::from_ref(pass),
        State::Off { stand_ins, .. } => stand_ins,
    });
    passes.collect()
}

/// Two images of one format that a pass copies one into the other.
fn copied(resources: &Resources<'_>, pass: &Pass) -> Option<[ImageIndex; 2]> {
    let pair = pass.moved_images()?;
    let [one, other] = pair.map(|image| resources.image(image).map(|image| image.image.format));
    (one.is_some() && one == other).then_some(pair)
}

/// Why an image keeps its usual format.
#[derive(Clone)]
struct Hindrance {
    why: String,
    span: Span,
}

/// The alpha of an image is kept, unless its format says that it has none. A format that follows another says nothing.
fn keeps_alpha(described: &language::Image) -> Option<Hindrance> {
    if matches!(described.format.value, Described::Color { alpha: false, .. } | Described::Like(_)) {
        return None;
    }
    let name = &described.name.text;
    let why = format!("the alpha of `{name}` is kept, since its format isn't `Color(alpha: false)`");
    Some(Hindrance { why, span: described.format.span })
}

/// For each image, the use that relies on its very format, if there is one.
fn fixed(resources: &Resources<'_>, states: &[State], outputs: &[Output]) -> Vec<Option<Hindrance>> {
    let lives = resources.images.iter().map(|image| {
        let image = &image.as_ref()?.image;
        let why = match image.lifetime {
            Lifetime::Imported { .. } => "it is handed in",
            Lifetime::File(_) => "it comes from a file",
            Lifetime::Transient | Lifetime::Persistent { .. } | Lifetime::History { .. } => return None,
        };
        Some(Hindrance { why: why.to_owned(), span: image.span })
    });
    let mut fixed: Vec<Option<Hindrance>> = lives.collect();
    let mut fix = |image: ImageIndex, why: String, span: Span| {
        fixed[image.0 as usize].get_or_insert(Hindrance { why, span });
    };
    // Images that are dumped are looked at as they are.
    for output in outputs.iter().filter(|output| output.span != Span::NONE) {
        if let Resource::Image(image) = output.resource {
            fix(image, "it leaves the frame".to_owned(), output.span);
        }
    }
    let format = |image: ImageIndex| resources.image(image).map(|known| known.image.format);
    for pass in running(states) {
        for access in pass.accesses().filter(|access| pass.relies_on_format(access, format)) {
            if let Some(image) = access.image_index() {
                let storage = matches!(access, Access::Storage(_));
                let what = if storage { "uses it as a storage image" } else { "moves its bytes" };
                fix(image, format!("`{}` {what}", pass.name), access.span());
            }
        }
    }
    fixed
}
