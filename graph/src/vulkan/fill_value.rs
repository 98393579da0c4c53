//! Values that fill images and buffers.

use super::Format;
use serde::{Deserialize, Serialize};

/// The value that every texel of an image, or every 32-bit word of a buffer, is set to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FillValue {
    /// Red, green, blue and alpha (linear) of an image whose components are not integers.
    Color([f32; 4]),
    /// Red, green, blue and alpha of an image of integers, negative ones as 32 bits with their sign; of a buffer, the word in
    /// the first.
    Bits([u32; 4]),
    /// Depth, and stencil where there is any.
    Depth(f32, u8),
}

impl FillValue {
    /// Why it can't fill an image of a format, or a buffer (`None`), in words; `None`: it can.
    #[must_use]
    pub fn problem(&self, format: Option<Format>) -> Option<&'static str> {
        let outside = "a value that its format doesn't hold";
        match (self, format) {
            (FillValue::Color(color), _) if color.iter().any(|value| !value.is_finite()) => {
                Some("what is not a finite number")
            }
            (FillValue::Depth(depth, _), _) if !(0.0..=1.0).contains(depth) => Some("a depth outside of 0 to 1"),
            (FillValue::Bits(_), None) => None,
            (FillValue::Color(color), Some(format)) if !format.is_integer() && !format.is_depth() => {
                format.lacks(color.map(f64::from)).map(|_| outside)
            }
            (FillValue::Bits(bits), Some(format)) if format.is_integer() => {
                format.lacks(format.integers(*bits)).map(|_| outside)
            }
            (FillValue::Depth(..), Some(format)) if format.is_depth() => None,
            _ => Some("a value of another kind"),
        }
    }
}
