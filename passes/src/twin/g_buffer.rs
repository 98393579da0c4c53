//! Twin of `shaders/include/g_buffer.glsl`. The source of the mapping stands there.

use glam::{DVec2, DVec3};

/// A unit vector as a point of a square from −1 to 1.
#[must_use]
pub fn octahedral(unit: DVec3) -> DVec2 {
    let on_octahedron = unit / (unit.x.abs() + unit.y.abs() + unit.z.abs());
    let point = on_octahedron.truncate();
    if on_octahedron.z < 0.0 { mirrored(point) } else { point }
}

/// The unit vector of such a point.
#[must_use]
pub fn from_octahedral(point: DVec2) -> DVec3 {
    let z = 1.0 - point.x.abs() - point.y.abs();
    let folded = if z < 0.0 { mirrored(point) } else { point };
    folded.extend(z).normalize()
}

/// Mirrors about the diamond's edges: the lower half is turned out over the square's corners, and back.
fn mirrored(point: DVec2) -> DVec2 {
    DVec2::new((1.0 - point.y.abs()).copysign(point.x), (1.0 - point.x.abs()).copysign(point.y))
}
