//! Twin of `shaders/include/overlay.glsl`.

/// Distance along the camera's axis as a share of `farthest`, at most 1, from reversed depth without a far plane.
#[must_use]
pub fn shade_of_distance(depth: f64, near: f64, farthest: f64) -> f64 {
    (near / (depth * farthest)).min(1.0)
}
