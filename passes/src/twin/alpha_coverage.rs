//! Twin of `shaders/include/alpha_coverage.glsl`.

/// Smaller changes of alpha from pixel to pixel count as none.
const LEAST_WIDTH: f64 = 1e-4;

/// How much of a pixel of a masked material is covered, 0 to 1: one half where alpha is the cutoff, and from nothing to all
/// within one pixel. `width`: by how much alpha changes from pixel to pixel.
#[must_use]
pub fn covered_by(alpha: f64, cutoff: f64, width: f64) -> f64 {
    ((alpha - cutoff) / width.max(LEAST_WIDTH) + 0.5).clamp(0.0, 1.0)
}
