//! Twin of `shaders/include/tone_mapping.glsl`.
//!
//! Source of both curves: E. Reinhard, M. Stark, P. Shirley, J. Ferwerda, "Photographic Tone Reproduction for Digital
//! Images", SIGGRAPH 2002, equations 3 and 4, here applied to each channel by itself.

/// `c / (1 + c)`: radiance in 0…65504 to 0…1.
#[must_use]
pub fn reinhard(radiance: f64) -> f64 {
    radiance / (1.0 + radiance)
}

/// `c · (1 + c/w²) / (1 + c)`, at most 1: radiance in 0…65504 to 0…1, where `white_point` is the radiance that becomes 1.
/// A white point below 1 counts as 1; at 1 the curve is the identity on 0…1, and as it grows it becomes [`reinhard`].
#[must_use]
pub fn modified_reinhard(radiance: f64, white_point: f64) -> f64 {
    let white = white_point.max(1.0);
    (radiance * (1.0 + radiance / white / white) / (1.0 + radiance)).min(1.0)
}
