//! Boxes around things.

use glam::{DMat4, DVec3};

/// An axis-aligned box, borders included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates, metres.
    pub min: DVec3,
    /// Largest coordinates, metres; nowhere less than `min`.
    pub max: DVec3,
}

impl Bounds {
    /// The smallest box that holds every point; `None` without points.
    #[must_use]
    pub fn of(points: &[[f32; 3]]) -> Option<Bounds> {
        let points = points.iter().map(|point| DVec3::from(point.map(f64::from)));
        points.map(|point| Bounds { min: point, max: point }).reduce(Bounds::union)
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn union(self, other: Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The smallest box that holds this one moved by an affine transform.
    #[must_use]
    pub fn transformed(self, transform: DMat4) -> Bounds {
        Bounds::around(self.corners().map(|corner| transform.transform_point3(corner)))
    }

    /// The smallest box that holds the eight corners of another one after a transform.
    pub(crate) fn around(corners: [DVec3; 8]) -> Bounds {
        let none = Bounds { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
        corners.into_iter().fold(none, |all, at| all.union(Bounds { min: at, max: at }))
    }

    pub(crate) fn corners(self) -> [DVec3; 8] {
        std::array::from_fn(|corner| {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] };
            DVec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// Whether every coordinate is a number and no further than `limit` from 0.
    #[must_use]
    pub fn within(self, limit: f64) -> bool {
        let fits = |corner: DVec3| corner.to_array().iter().all(|at| at.abs() <= limit);
        fits(self.min) && fits(self.max)
    }

    /// The middle.
    #[must_use]
    pub fn center(self) -> DVec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Half the length of the diagonal: the radius of the sphere around the box, metres.
    #[must_use]
    pub fn radius(self) -> f64 {
        (self.max - self.min).length() * 0.5
    }
}
