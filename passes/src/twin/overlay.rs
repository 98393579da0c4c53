//! Twin of `shaders/include/overlay.glsl`.

/// Distance along the camera's axis as a share of `farthest`, at most 1, from reversed depth without a far plane.
#[must_use]
pub fn shade_of_distance(depth: f64, near: f64, farthest: f64) -> f64 {
    (near / (depth * farthest)).min(1.0)
}

/// A value of either sign, times `gain`: 0 as 0.5, −1 as 0 and 1 as 1; NaN as 0.5.
#[must_use]
pub fn shade_of_signed(value: f64, gain: f64) -> f64 {
    let scaled = value * gain;
    if scaled.is_nan() { 0.5 } else { (0.5 * scaled + 0.5).clamp(0.0, 1.0) }
}
