//! Twin of `shaders/include/distance.glsl`.

/// The reversed depth of a place, 1 at the distance `near` and 0 at `far`; `None`: there is no far plane.
#[must_use]
pub fn depth_at(distance: f64, near: f64, far: Option<f64>) -> f64 {
    far.map_or(near / distance, |far| near * (far - distance) / (distance * (far - near)))
}

/// The distance of a place from the camera, along its axis, by its depth; infinite where nothing was drawn.
#[must_use]
pub fn distance_at(depth: f64, near: f64, far: Option<f64>) -> f64 {
    match far {
        _ if depth <= 0.0 => f64::INFINITY,
        Some(far) => near * far / (near + depth * (far - near)),
        None => near / depth,
    }
}

/// The depth that a camera without a far plane gives the same place: near / distance.
#[must_use]
pub fn infinite_depth(depth: f64, near: f64, far: Option<f64>) -> f64 {
    near / distance_at(depth, near, far)
}
