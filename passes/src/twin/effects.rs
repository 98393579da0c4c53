//! Twins of the shaders of small effects: depth stripes, the over-bright view, film grain, vignette.

use super::random::{hash, random};
use std::f64::consts::PI;

/// The share of light that a stripe lets through, `sin²(π · distance / period)`, from reversed depth without a far plane;
/// `near` and `period` in metres. All of it where nothing was drawn and beyond 65,536 periods.
#[must_use]
pub fn stripe(depth: f64, near: f64, period: f64) -> f64 {
    let periods = near / (depth * period);
    if periods < 65536.0 { (PI * periods.fract()).sin().powi(2) } else { 1.0 }
}

/// The part of radiance in 0…65504 that is brighter than white.
#[must_use]
pub fn over_bright(radiance: f64) -> f64 {
    (radiance - 1.0).max(0.0)
}

/// The grain of a pixel in a frame, −1 to 1, mostly near 0.
#[must_use]
pub fn grain(pixel: [u32; 2], frame: u32) -> f64 {
    let first = hash(pixel[0].wrapping_add(hash(pixel[1].wrapping_add(hash(frame)))));
    random(first) + random(first ^ 0x9e37_79b9) - 1.0
}

/// The share of light that a lens lets through at a place of the picture, 0 to 1 across and down: cos⁴ of the angle of incidence.
/// `strength` is the tangent of that angle in the corners, `aspect` the width of the picture over its height.
#[must_use]
pub fn vignette(uv: [f64; 2], strength: f64, aspect: f64) -> f64 {
    let from_middle = (aspect * (uv[0] - 0.5)).hypot(uv[1] - 0.5) / (aspect * 0.5).hypot(0.5);
    (strength * from_middle).atan().cos().powi(4)
}
