//! Twin of `shaders/include/radiance.glsl`.

/// The largest finite half float.
pub const LARGEST_HALF: f64 = 65504.0;

/// Radiance made safe for a half-float store, in 0…[`LARGEST_HALF`]: negative numbers and NaN become 0, larger numbers and
/// +∞ the largest half.
#[must_use]
pub fn guard_radiance(radiance: f64) -> f64 {
    if radiance.is_nan() || radiance.is_sign_negative() { 0.0 } else { radiance.min(LARGEST_HALF) }
}

/// Alpha made safe for a store, in 0…1; NaN becomes 0.
#[must_use]
pub fn guard_alpha(alpha: f64) -> f64 {
    guard_radiance(alpha).min(1.0)
}

/// A number that may be negative, made safe for a half-float store: −[`LARGEST_HALF`]…[`LARGEST_HALF`]; NaN becomes 0.
#[must_use]
pub fn guard_signed(number: f64) -> f64 {
    if number.is_nan() { 0.0 } else { number.clamp(-LARGEST_HALF, LARGEST_HALF) }
}
