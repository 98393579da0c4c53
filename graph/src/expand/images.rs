//! Formats, sizes and sample counts of images, each its own or that of an image that it follows.

use super::Chosen;
use super::settings::{SettingValue, show};
use super::shapes;
use crate::describe::{
    self, Diagnostic, Format as Described, ImageRef, LARGEST_SIZE, Layers, Mips, SAMPLE_COUNTS, Samples, Size, Value,
    shown_number,
};
use crate::format::Format;
use crate::frame::{Image, ParamValue};

/// An image of the frame, and where its samples come from.
pub(super) struct Resolved {
    pub(super) image: Image,
    /// "msaa = 4" if a setting decides how many samples it has.
    pub(super) samples_because: Option<String>,
}

/// A size is rounded down, but a product that is whole in exact arithmetic stays whole: 0.29 of 100 is 29.
const ROUNDING: f64 = 1e-6;

/// Every image of the pipeline; `None` where a mistake was reported.
pub(super) fn resolve(chosen: &Chosen<'_>, output: [u32; 2], errors: &mut Vec<Diagnostic>) -> Vec<Option<Resolved>> {
    let images = &chosen.pipeline.images;
    let formats = follow(
        images,
        |image| match image.format.value {
            Described::Like(of) => Some(of),
            _ => None,
        },
        |image, followed| format(chosen, image, followed),
    );
    let extents = follow(
        images,
        |image| match image.size.value {
            Size::Like(of) | Size::Scaled { of: Some(of), .. } => Some(of),
            _ => None,
        },
        |image, followed| extent(chosen, image, output, followed, errors),
    );
    let samples = follow(
        images,
        |image| match image.samples.value {
            Samples::Like(of) => Some(of),
            Samples::Count(_) => None,
        },
        |image, followed| samples(chosen, image, followed, errors),
    );
    let layers = follow(
        images,
        |image| match image.layers.value {
            Layers::Like(of) => Some(of),
            _ => None,
        },
        |image, followed| shapes::layers(chosen, image, followed),
    );
    let mips = follow(
        images,
        |image| match image.mips.value {
            Mips::Like(of) => Some(of),
            _ => None,
        },
        |image, followed| match image.mips.value {
            Mips::Count(count) => chosen.whole(count).map(shapes::Levels::Count),
            Mips::Full => Some(shapes::Levels::Full),
            Mips::Like(_) => followed,
        },
    );
    let all = images.iter().zip(formats).zip(extents).zip(samples).zip(layers).zip(mips);
    all.map(|(((((described, format), extent), samples), layers), mips)| {
        let ([width, height], (samples, samples_because)) = (extent?, samples?);
        let image =
            Image { span: described.name.span, samples, ..Image::new(&described.name.text, format?, width, height) };
        let image = shapes::shaped(chosen, described, image, layers?, mips?, errors)?;
        Some(Resolved { image, samples_because })
    })
    .collect()
}

/// The value of each image: its own, or made from the value of the image that it follows. Walks along what is followed
/// without recursion, since a chain may be as long as the file.
fn follow<T: Clone>(
    images: &[describe::Image],
    next: impl Fn(&describe::Image) -> Option<ImageRef>,
    mut value: impl FnMut(&describe::Image, Option<T>) -> Option<T>,
) -> Vec<Option<T>> {
    let mut known: Vec<Option<Option<T>>> = vec![None; images.len()];
    for start in 0..images.len() {
        let mut path = vec![start];
        while let Some(&at) = path.last() {
            let to = next(&images[at]).map(|of| of.index.0 as usize);
            match to.map(|to| (to, known[to].clone())) {
                _ if known[at].is_some() => {}
                // A circle would be longer than all images together; reading a pipeline has ruled it out.
                Some((to, None)) if path.len() <= images.len() => {
                    path.push(to);
                    continue;
                }
                Some((_, followed)) => known[at] = Some(followed.flatten().and_then(|of| value(&images[at], Some(of)))),
                None => known[at] = Some(value(&images[at], None)),
            }
            path.pop();
        }
    }
    known.into_iter().map(Option::flatten).collect()
}

fn format(chosen: &Chosen<'_>, image: &describe::Image, followed: Option<Format>) -> Option<Format> {
    match image.format.value {
        Described::Color { hdr } => {
            let hdr = match hdr {
                Value::Constant(hdr) => hdr,
                Value::Setting(reference) => matches!(chosen.setting(reference).1, ParamValue::Bool(true)),
            };
            Some(if hdr { Format::R16G16B16A16_SFLOAT } else { Format::R8G8B8A8_SRGB })
        }
        Described::Depth => Some(Format::D32_SFLOAT),
        Described::DepthStencil => Some(Format::D32_SFLOAT_S8_UINT),
        Described::Output => Some(Format::R8G8B8A8_SRGB),
        Described::Named(format) => Some(format),
        Described::Like(_) => followed,
    }
}

fn extent(
    chosen: &Chosen<'_>,
    image: &describe::Image,
    output: [u32; 2],
    followed: Option<[u32; 2]>,
    errors: &mut Vec<Diagnostic>,
) -> Option<[u32; 2]> {
    let (by, of) = match image.size.value {
        Size::Output => return Some(output),
        Size::Fixed(extent) => return Some(extent),
        Size::Like(_) => return followed,
        Size::Scaled { by, of } => (by, of),
    };
    let (factor, because) = match by {
        Value::Constant(factor) => (factor, shown_number(factor)),
        Value::Setting(reference) => {
            let (setting, value) = chosen.setting(reference);
            (number(value)?, format!("{} = {}", setting.name.text, show(value)))
        }
    };
    let base = if of.is_some() { followed? } else { output };
    let scaled = base.map(|extent| (f64::from(extent) * factor + ROUNDING).floor().max(1.0));
    if scaled.iter().any(|extent| *extent > f64::from(LARGEST_SIZE)) {
        let name = &image.name.text;
        let [width, height] = scaled.map(shown_number);
        let message = format!("image `{name}` would be {width}×{height}; {LARGEST_SIZE} texels are allowed");
        let remark = format!("{because} times {}×{}", base[0], base[1]);
        errors.push(Diagnostic::new(image.size.span, message).remark(remark));
        return None;
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 16384, as checked above")]
    Some(scaled.map(|extent| extent as u32))
}

#[allow(clippy::cast_precision_loss, reason = "a scale needs no more than 53 bits")]
fn number(value: SettingValue) -> Option<f64> {
    match value {
        ParamValue::Number(number) => Some(number),
        ParamValue::Integer(number) => Some(number as f64),
        ParamValue::Bool(_) => None,
    }
}

fn samples(
    chosen: &Chosen<'_>,
    image: &describe::Image,
    followed: Option<(u32, Option<String>)>,
    errors: &mut Vec<Diagnostic>,
) -> Option<(u32, Option<String>)> {
    match image.samples.value {
        Samples::Like(_) => followed,
        Samples::Count(Value::Constant(count)) => Some((count, None)),
        Samples::Count(Value::Setting(reference)) => {
            let (setting, value) = chosen.setting(reference);
            let because = format!("{} = {}", setting.name.text, show(value));
            let ParamValue::Integer(count) = value else { return None };
            if !SAMPLE_COUNTS.contains(&count) {
                let message = format!("image `{}` can't have {count} samples ({because})", image.name.text);
                let allowed = SAMPLE_COUNTS.map(|count| count.to_string()).join(", ");
                errors.push(Diagnostic::new(image.samples.span, message).help(format!("sample counts are {allowed}")));
                return None;
            }
            u32::try_from(count).ok().map(|count| (count, Some(because)))
        }
    }
}

impl Resolved {
    /// How many samples, and why: "4 samples (msaa = 4)".
    pub(super) fn samples_words(&self) -> String {
        let samples = self.image.samples;
        let count = if samples == 1 { "1 sample".to_owned() } else { format!("{samples} samples") };
        match &self.samples_because {
            Some(because) => format!("{count} ({because})"),
            None => count,
        }
    }
}
