//! Values for all texels of an image or all words of a buffer, typed by the image or buffer that they fill.

use crate::base::shown_number;
use crate::language::Fill;
use crate::vulkan::{Aspects, FillValue, Format, Numeric};

/// Zero, as the format has it; `None`: a buffer.
pub(super) fn zero(format: Option<Format>) -> FillValue {
    match format {
        Some(format) if format.is_depth() => FillValue::Depth(0.0, 0),
        Some(format) if !format.is_integer() => FillValue::Color([0.0; 4]),
        _ => FillValue::Bits([0; 4]),
    }
}

/// The value as the format has it; `None`: a buffer. An error says why the value doesn't fit, and which value would.
pub(super) fn typed(fill: Fill, format: Option<Format>) -> Result<FillValue, (String, String)> {
    let Some(format) = format else {
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
        return depth(fill, format);
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
    if format.is_integer() {
        let size = u32::try_from(format.texel_bytes() * 8 / u64::from(format.components())).unwrap_or(32);
        let signed = format.numeric() == Numeric::Sint;
        let component = |number| {
            let fitting = if signed { signed_bits(number, size) } else { bits(number, size) };
            fitting.ok_or_else(|| {
                let values = 1_i64 << size.min(32);
                let (least, most) = if signed { (-values / 2, values / 2 - 1) } else { (0, values - 1) };
                let message = format!("{} is no component of {format}", shown_number(number));
                (message, format!("whole numbers from {least} to {most} are allowed"))
            })
        };
        let [r, g, b, a] = numbers;
        return Ok(FillValue::Bits([component(r)?, component(g)?, component(b)?, component(a)?]));
    }
    #[allow(clippy::cast_possible_truncation, reason = "colour is filled in single precision")]
    let single = numbers.map(|number| number as f32);
    match single.iter().zip(numbers).find(|(single, _)| !single.is_finite()) {
        Some((_, number)) => {
            let help = "32-bit floating point reaches about 3.4e38".to_owned();
            Err((format!("{} is too large for a colour", shown_number(number)), help))
        }
        None => Ok(FillValue::Color(single)),
    }
}

fn depth(fill: Fill, format: Format) -> Result<FillValue, (String, String)> {
    let (depth, stencil) = match fill {
        Fill::Number(depth) => (depth, 0.0),
        Fill::DepthStencil(depth, _) if !format.aspects().contains(Aspects::STENCIL) => {
            return Err((
                format!("{format} has no stencil plane"),
                format!("write `{}`, the depth alone", shown_number(depth)),
            ));
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

/// The bits of a signed whole number of `size` bits, with its sign before them up to 32 bits.
fn signed_bits(number: f64, size: u32) -> Option<u32> {
    let half = 2_f64.powi(size.clamp(1, 32).cast_signed() - 1);
    let fits = number.fract() == 0.0 && (-half..half).contains(&number);
    #[allow(clippy::cast_possible_truncation, reason = "whole and in range, as checked")]
    fits.then_some((number as i32).cast_unsigned())
}

/// A whole number of `bits` bits.
fn bits(number: f64, size: u32) -> Option<u32> {
    let fits = number.fract() == 0.0 && (0.0..2_f64.powi(size.min(32).cast_signed())).contains(&number);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and in range, as checked")]
    fits.then_some(number as u32)
}
