//! What expressions may ask of an image: its size, mip levels, layers and samples, as soon as it is lowered.

use super::pipeline::ImageRef;
use super::resources::{Image, Layers, Mips, Samples, Shape, Size};
use super::scope::Properties;
use super::{Diagnostic, LARGEST_SIZE, shown_number};

/// A size is rounded down, but a product that is whole in exact arithmetic stays whole: 0.29 of 100 is 29.
const ROUNDING: f64 = 1e-6;

/// Properties of an image that is lowered after those whose properties are `known`. `frame` is the size of the frame.
pub(super) fn of(image: &Image, known: &[Option<Properties>], frame: [u32; 2]) -> Result<Properties, Diagnostic> {
    let followed = |of: &ImageRef| known.get(of.index.0 as usize).copied().flatten().unwrap_or_default();
    let extent = match &image.size.value {
        Size::Output => Some(frame),
        Size::Fixed(extent) => Some(*extent),
        Size::Like(of) => followed(of).extent,
        Size::Scaled { by, of } | Size::Dynamic { by, of, .. } => {
            match of.as_ref().map_or(Some(frame), |of| followed(of).extent) {
                Some(base) => Some(scaled(image, base, *by)?),
                None => None,
            }
        }
    };
    let samples = match &image.samples.value {
        Samples::Count(count) => Some(*count),
        Samples::Like(of) => followed(of).samples,
    };
    let layers = match &image.layers.value {
        Layers::Default if image.shape.value == Shape::Cube => Some(6),
        Layers::Default => Some(1),
        Layers::Count(count) => Some(*count),
        Layers::Like(of) => followed(of).layers,
    };
    let depth = if let Shape::D3(depth) = image.shape.value { depth } else { 1 };
    let mips = match &image.mips.value {
        Mips::Count(count) => Some(*count),
        Mips::Full => extent.map(|[width, height]| (width | height | depth).max(1).ilog2() + 1),
        Mips::Like(of) => followed(of).mips,
    };
    Ok(Properties { extent, mips, layers, samples })
}

/// `base` times a factor, rounded down, at least 1.
///
/// # Errors
/// If that is more than an image may have.
pub(crate) fn scaled(image: &Image, base: [u32; 2], factor: f64) -> Result<[u32; 2], Diagnostic> {
    times(base, factor).map_err(|[width, height]| {
        let name = &image.name.text;
        let message = format!("image `{name}` would be {width}×{height}; {LARGEST_SIZE} texels are allowed");
        let because = image.size_because.as_ref().map_or_else(|| shown_number(factor), ToString::to_string);
        let remark = format!("{because} times {}×{}", base[0], base[1]);
        Diagnostic::new(image.size.span, message).remark(remark)
    })
}

/// `base` times a factor, rounded down, at least 1; or what that would be, as it is shown, if it is too much.
pub(super) fn times(base: [u32; 2], factor: f64) -> Result<[u32; 2], [String; 2]> {
    let scaled = base.map(|extent| (f64::from(extent) * factor + ROUNDING).floor().max(1.0));
    if scaled.iter().any(|extent| *extent > f64::from(LARGEST_SIZE)) {
        return Err(scaled.map(shown_number));
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 16384, as checked above")]
    Ok(scaled.map(|extent| extent as u32))
}
