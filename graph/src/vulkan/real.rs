//! Finite numbers that Vulkan's states hold.

use serde::{Deserialize, Serialize};

/// A finite number of 32 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(try_from = "f32", into = "f32")]
pub struct Real(u32);

impl Real {
    /// 0.
    pub const ZERO: Real = Real(0.0f32.to_bits());
    /// 1.
    pub const ONE: Real = Real(1.0f32.to_bits());

    /// Whether it is 0.
    #[must_use]
    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde hands a field over so")]
    pub fn is_zero(&self) -> bool {
        *self == Real::ZERO
    }
}

impl TryFrom<f32> for Real {
    type Error = &'static str;

    fn try_from(number: f32) -> Result<Real, &'static str> {
        // A zero loses its sign.
        if number.is_finite() { Ok(Real((number + 0.0).to_bits())) } else { Err("no finite number") }
    }
}

impl From<Real> for f32 {
    fn from(number: Real) -> f32 {
        f32::from_bits(number.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_finite_numbers_are_taken_and_zero_has_one_sign() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert!(Real::try_from(bad).is_err(), "{bad}");
        }
        assert_eq!(Real::try_from(-0.0), Ok(Real::ZERO));
    }
}
