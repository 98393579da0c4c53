//! Rays and triangles.

use glam::DVec3;

/// A half line. The direction need not have length 1: distances count in its lengths.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes.
    pub direction: DVec3,
}

/// Where a ray meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// Distance along the ray, in lengths of its direction; above 0.
    pub distance: f64,
    /// Weights of the triangle's second and third corner; the first has the rest.
    pub weights: [f64; 2],
    /// Whether the corners run counter-clockwise as seen from the ray's origin.
    pub counter_clockwise: bool,
}

/// Where `ray` meets the triangle `corners`, seen from either side.
///
/// Source: T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools 2(1), 1997.
#[must_use]
pub fn meet(ray: &Ray, corners: &[DVec3; 3]) -> Option<Meeting> {
    let [first, second, third] = *corners;
    let (edge_2, edge_3) = (second - first, third - first);
    let across = ray.direction.cross(edge_3);
    let determinant = edge_2.dot(across);
    if determinant == 0.0 {
        return None;
    }
    let from_first = ray.origin - first;
    let second_weight = from_first.dot(across) / determinant;
    let around = from_first.cross(edge_2);
    let third_weight = ray.direction.dot(around) / determinant;
    let distance = edge_3.dot(around) / determinant;
    let inside = second_weight >= 0.0 && third_weight >= 0.0 && second_weight + third_weight <= 1.0;
    (inside && distance > 0.0).then_some(Meeting {
        distance,
        weights: [second_weight, third_weight],
        counter_clockwise: determinant > 0.0,
    })
}
