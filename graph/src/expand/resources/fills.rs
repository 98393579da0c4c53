//! Values for all texels of an image or all words of a buffer, typed by the image or buffer that they fill.

use crate::base::shown_number;
use crate::language::Fill;
use crate::vulkan::{Aspects, FillValue, Format, Numeric};

/// Zero, as the format has it; `None`: a buffer.
pub(in crate::expand) fn zero(format: Option<Format>) -> FillValue {
    match format {
        Some(format) if format.is_depth() => FillValue::Depth(0.0, 0),
        Some(format) if !format.is_integer() => FillValue::Color([0.0; 4]),
        _ => FillValue::Bits([0; 4]),
    }
}

/// What is filled: a format and the planes of it; `None`: a buffer.
pub(super) type FillSubject = Option<(Format, Aspects)>;

/// The value as the format has it. An error says why the value doesn't fit, and which value would.
pub(in crate::expand) fn typed(fill: Fill, filled: FillSubject) -> Result<FillValue, (String, String)> {
    let Some((format, planes)) = filled else {
        let Fill::Number(number) = fill else {
            return Err((
                "a buffer is filled with one number".to_owned(),
                "write a whole number of 32 bits: `0`".to_owned(),
            ));
        };
        let word = bits(number, 32).ok_or_else(|| {
            (format!("{} is no 32-bit word", shown_number(number)), format!("0 to {} are allowed", u32::MAX))
        })?;
        return Ok(FillValue::Bits([word, 0, 0, 0]));
    };
    if format.is_depth() {
        return depth(fill, format, planes);
    }
    let numbers = match fill {
        Fill::Number(number) => [number; 4],
        Fill::Color(numbers) => numbers,
        Fill::DepthStencil(..) => {
            let what = if format.is_integer() { "integers" } else { "colour" };
            let message = format!("depth and stencil can't fill an image that holds {what} ({format})");
            return Err((message, "write `(red, green, blue, alpha)`".to_owned()));
        }
    };
    held(numbers, format).map_err(|(_, message, help)| (message, help))?;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the format holds them")]
    Ok(match format.numeric() {
        Numeric::Uint => FillValue::Bits(numbers.map(|number| number as u32)),
        Numeric::Sint => FillValue::Bits(numbers.map(|number| (number as i32).cast_unsigned())),
        _ => FillValue::Color(numbers.map(|number| number as f32)),
    })
}

/// That a format of colours or integers holds these numbers. An error says which doesn't fit, why not, and what would.
pub(in crate::expand) fn held(numbers: [f64; 4], format: Format) -> Result<(), (usize, String, String)> {
    let Some(at) = format.lacks(numbers) else { return Ok(()) };
    let [least, most] = format.component_range(at).map(shown_number);
    let number = shown_number(numbers[at]);
    let (message, help) = match format.numeric() {
        Numeric::Uint | Numeric::Sint => (
            format!("{number} is no component of {format}"),
            format!("whole numbers from {least} to {most} are allowed"),
        ),
        Numeric::Sfloat if format.component_bits() == 32 => {
            (format!("{number} is too large for a colour"), "32-bit floating point reaches about 3.4e38".to_owned())
        }
        _ => (format!("{number} lies outside of {format}"), format!("numbers from {least} to {most} are allowed")),
    };
    Err((at, message, help))
}

fn depth(fill: Fill, format: Format, planes: Aspects) -> Result<FillValue, (String, String)> {
    let alone = |plane| planes == plane && format.aspects() != plane;
    let (depth, stencil) = match fill {
        Fill::Number(stencil) if planes == Aspects::STENCIL => (0.0, stencil),
        Fill::Number(depth) => (depth, 0.0),
        Fill::DepthStencil(depth, _) if !format.aspects().contains(Aspects::STENCIL) => {
            return Err((
                format!("{format} has no stencil plane"),
                format!("write `{}`, the depth alone", shown_number(depth)),
            ));
        }
        Fill::DepthStencil(depth, stencil) if alone(Aspects::STENCIL) && depth != 0.0 => {
            let message = format!("stencil is filled alone, and not with the depth {}", shown_number(depth));
            return Err((message, format!("write `{}`, the stencil alone", shown_number(stencil))));
        }
        Fill::DepthStencil(depth, stencil) if alone(Aspects::DEPTH) && stencil != 0.0 => {
            let message = format!("depth is filled alone, and not with the stencil {}", shown_number(stencil));
            return Err((message, format!("write `{}`, the depth alone", shown_number(depth))));
        }
        Fill::DepthStencil(depth, stencil) => (depth, stencil),
        Fill::Color(_) => {
            let stencil = format.aspects().contains(Aspects::STENCIL);
            let help = if stencil { "write a depth and a stencil value: `(0.0, 0)`" } else { "write a depth: `0.0`" };
            return Err((format!("a colour can't fill an image that holds depth ({format})"), help.to_owned()));
        }
    };
    if !(0.0..=1.0).contains(&depth) {
        let help = "write a depth from 0 to 1: 0 is infinitely far, 1 is nearest".to_owned();
        return Err((format!("depth lies from 0 to 1, found {}", shown_number(depth)), help));
    }
    let Some(stencil) = bits(stencil, 8).and_then(|stencil| u8::try_from(stencil).ok()) else {
        return Err((
            format!("{} is no stencil value", shown_number(stencil)),
            "a stencil value has 8 bits: the largest is 255".to_owned(),
        ));
    };
    #[allow(clippy::cast_possible_truncation, reason = "depth is stored in single precision")]
    Ok(FillValue::Depth(depth as f32, stencil))
}

/// A whole number of `bits` bits.
fn bits(number: f64, size: u32) -> Option<u32> {
    let fits = number.fract() == 0.0 && (0.0..2_f64.powi(size.min(32).cast_signed())).contains(&number);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and in range, as checked")]
    fits.then_some(number as u32)
}
