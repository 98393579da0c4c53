//! Width and height of images.

use super::resources::{Image, Size};
use crate::base::{Code, Diagnostic, shown_number};
use crate::frame::least_part;

/// Largest width and height that a file may ask for.
pub(crate) const LARGEST_SIZE: u32 = 16384;

/// A size is rounded down, but a product that is whole in exact arithmetic stays whole: 0.29 of 100 is 29.
const ROUNDING: f64 = 1e-6;

/// Width and height of an image, and those that are allocated if they may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Area {
    pub(crate) extent: [u32; 2],
    pub(crate) allocated: Option<[u32; 2]>,
}

/// The area of an image in a view of the size `view`; `None`: unknown. `followed` is the area of the image that it follows.
///
/// # Errors
/// If the size is larger than an image may have.
pub(crate) fn area(image: &Image, view: [u32; 2], followed: Option<Area>) -> Result<Option<Area>, Diagnostic> {
    let whole = |extent| Area { extent, allocated: None };
    let (by, up_to, of) = match image.size.value {
        Size::Output => return Ok(Some(whole(view))),
        Size::Fixed(extent) => return Ok(Some(whole(extent))),
        Size::Like(_) => return Ok(followed),
        Size::Scaled { by, of } => (by, None, of),
        Size::Dynamic { by, up_to, of } => (by, Some(up_to), of),
    };
    let Some(base) = (if of.is_some() { followed } else { Some(whole(view)) }) else { return Ok(None) };
    let extent = scaled(image, base.extent, by)?;
    if base.allocated.is_none() && up_to.is_none() {
        return Ok(Some(whole(extent)));
    }
    // An image that follows one of changing size also has room for the greatest size.
    let allocated = scaled(image, base.allocated.unwrap_or(base.extent), up_to.unwrap_or(by))?;
    let [width, height, _] = least_part([extent[0], extent[1], 1], allocated);
    Ok(Some(Area { extent: [width, height], allocated: Some(allocated) }))
}

/// `base` times a factor, rounded down, at least 1.
///
/// # Errors
/// If the product is larger than an image may have.
fn scaled(image: &Image, base: [u32; 2], factor: f64) -> Result<[u32; 2], Diagnostic> {
    times(base, factor).map_err(|[width, height]| {
        let name = &image.name.text;
        let message = format!("image `{name}` would be {width}×{height}; {LARGEST_SIZE} texels are allowed");
        let because = image.size.because.as_ref().map_or_else(|| shown_number(factor), ToString::to_string);
        let remark = format!("{because} times {}×{}", base[0], base[1]);
        Diagnostic::new(Code::SIZE_OUTSIDE, image.size.span, message).remark(remark)
    })
}

/// `base` times a factor, rounded down, at least 1. If that is too large, an error with both numbers as messages show them.
pub(crate) fn times(base: [u32; 2], factor: f64) -> Result<[u32; 2], [String; 2]> {
    let scaled = base.map(|extent| (f64::from(extent) * factor + ROUNDING).floor().max(1.0));
    if scaled.iter().any(|extent| *extent > f64::from(LARGEST_SIZE)) {
        return Err(scaled.map(shown_number));
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 16384, as checked above")]
    Ok(scaled.map(|extent| extent as u32))
}
