//! Twin of `shaders/include/tone_mapping.glsl`, where the sources of the curves are named.

use super::exposure::luminance;

/// `c / (1 + c)`: radiance in 0…65504 to 0…1.
#[must_use]
pub fn reinhard(radiance: f64) -> f64 {
    radiance / (1.0 + radiance)
}

/// `c / (1 + L)` with the luminance `L`, at most 1: red, green and blue in 0…65504 to 0…1. The ratios of the channels stay where
/// none is cut off.
#[must_use]
pub fn reinhard_luminance(radiance: [f64; 3]) -> [f64; 3] {
    radiance.map(|channel| (channel / (1.0 + luminance(radiance))).min(1.0))
}

/// `c · (1 + c/w²) / (1 + c)`, at most 1: radiance in 0…65504 to 0…1, where `white_point` is the radiance that becomes 1.
/// A white point below 1 counts as 1; at 1 the curve is the identity on 0…1, and as it grows it becomes [`reinhard`].
#[must_use]
pub fn modified_reinhard(radiance: f64, white_point: f64) -> f64 {
    let white = white_point.max(1.0);
    (radiance * (1.0 + radiance / white / white) / (1.0 + radiance)).min(1.0)
}

/// `c · (2.51c + 0.03) / (c · (2.43c + 0.59) + 0.14)`, at most 1: radiance in 0…65504 to 0…1, a fit to the film-like curve of
/// ACES (K. Narkowicz, 2016).
#[must_use]
pub fn filmic(radiance: f64) -> f64 {
    (radiance * (2.51 * radiance + 0.03) / (radiance * (2.43 * radiance + 0.59) + 0.14)).min(1.0)
}

/// Khronos PBR Neutral: red, green and blue in 0…65504 to 0…1. The variables are those of its specification.
#[must_use]
pub fn neutral(radiance: [f64; 3]) -> [f64; 3] {
    const F90: f64 = 0.04;
    const KS: f64 = 0.8 - F90;
    const KD: f64 = 0.15;
    let x = radiance.into_iter().fold(f64::INFINITY, f64::min);
    let f = if x <= 2.0 * F90 { x - x * x / (4.0 * F90) } else { F90 };
    let base = radiance.map(|channel| channel - f);
    let p = base.into_iter().fold(0.0, f64::max);
    if p <= KS {
        return base;
    }
    let pn = 1.0 - (1.0 - KS).powi(2) / (p + 1.0 - 2.0 * KS);
    let g = 1.0 / (KD * (p - pn) + 1.0);
    base.map(|channel| channel * pn / p * g + pn * (1.0 - g))
}
