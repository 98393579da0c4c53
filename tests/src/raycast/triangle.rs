//! Rays and triangles.

use glam::DVec3;

/// A half line. The direction need not have length 1: distances count in its lengths.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    /// Its start.
    pub origin: DVec3,
    /// Its direction.
    pub direction: DVec3,
    /// Ray differentials: the steps of the direction to the pixel to the right and to the pixel below; zero for a ray without
    /// width. (H. Igehy, "Tracing Ray Differentials", SIGGRAPH 1999.)
    pub spread: [DVec3; 2],
}

impl Ray {
    /// The rays of the pixel to the right and of the pixel below.
    #[must_use]
    pub fn neighbours(&self) -> [Ray; 2] {
        self.spread.map(|more| Ray { direction: self.direction + more, ..*self })
    }
}

/// The place at which a ray meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// Distance along the ray, in lengths of its direction; above 0.
    pub distance: f64,
    /// Weights of the triangle's second and third corner; the first has the rest.
    pub weights: [f64; 2],
    /// Whether the corners run counter-clockwise as seen from the ray's origin.
    pub counter_clockwise: bool,
}

/// The place at which `ray` meets the triangle `corners`, seen from either side.
#[must_use]
pub fn meet(ray: &Ray, corners: &[DVec3; 3]) -> Option<Meeting> {
    meet_plane(ray, corners).filter(|meeting| {
        let [second, third] = meeting.weights;
        second >= 0.0 && third >= 0.0 && second + third <= 1.0 && meeting.distance > 0.0
    })
}

/// The place at which the line of `ray` meets the plane of the triangle `corners`, inside the triangle or not, ahead or behind.
///
/// Source: T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools 2(1), 1997.
#[must_use]
pub fn meet_plane(ray: &Ray, corners: &[DVec3; 3]) -> Option<Meeting> {
    let [first, second, third] = *corners;
    let (edge_2, edge_3) = (second - first, third - first);
    let across = ray.direction.cross(edge_3);
    let determinant = edge_2.dot(across);
    if determinant == 0.0 {
        return None;
    }
    let from_first = ray.origin - first;
    let around = from_first.cross(edge_2);
    Some(Meeting {
        distance: edge_3.dot(around) / determinant,
        weights: [from_first.dot(across) / determinant, ray.direction.dot(around) / determinant],
        counter_clockwise: determinant > 0.0,
    })
}
