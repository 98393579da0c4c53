//! Twin of `shaders/snow_fall.comp`, `shaders/snow_gather.comp` and the includes of both.

use super::random::random;
use std::f64::consts::TAU;

const EDGE: f64 = 1.25;
const NEAREST_SIZE: f64 = 0.02;
const FARTHEST: f64 = 4.0;
const FALL: f64 = 0.9;
const SWAY: f64 = 0.25;
const SWAY_RATE: f64 = 2.5;

/// A snowflake between camera and scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flake {
    /// Its place in the picture, from −1 at its left and upper border to 1 at its right and lower.
    pub position: [f64; 2],
    /// From the camera, 1 for the nearest flakes, 4 for the farthest.
    pub distance: f64,
    /// The phase of its swaying, 0 to 2π.
    pub phase: f64,
}

/// Flakes that leave at one side enter at the other.
fn around(position: f64) -> f64 {
    if position > EDGE {
        position - 2.0 * EDGE
    } else if position < -EDGE {
        position + 2.0 * EDGE
    } else {
        position
    }
}

impl Flake {
    /// The flake number `index` in the first frame.
    #[must_use]
    pub fn born(index: u32) -> Flake {
        let random = |number| random(4 * index + number);
        Flake {
            position: [0, 1].map(|axis| EDGE * (2.0 * random(axis) - 1.0)),
            distance: 1.0 + (FARTHEST - 1.0) * random(2),
            phase: TAU * random(3),
        }
    }

    /// A frame later. `wind` in halves of the picture a second.
    #[must_use]
    pub fn later(self, seconds: f64, wind: f64) -> Flake {
        let velocity = [wind + SWAY * self.phase.sin(), FALL];
        Flake {
            position: [0, 1].map(|axis| around(self.position[axis] + seconds / self.distance * velocity[axis])),
            phase: (self.phase + seconds * SWAY_RATE) % TAU,
            ..self
        }
    }

    /// How far its nearest edge is within the picture: more than 0 if it is seen.
    #[must_use]
    pub fn within(self) -> f64 {
        let reach = self.position.map(|axis| axis.abs() - NEAREST_SIZE / self.distance);
        1.0 - reach[0].max(reach[1])
    }

    /// The larger of the distances of two positions along both axes, where the ends of the way around are one.
    #[must_use]
    pub fn apart(self, other: Flake) -> f64 {
        let along = |axis: usize| {
            let apart = (self.position[axis] - other.position[axis]).abs();
            apart.min(2.0 * EDGE - apart)
        };
        along(0).max(along(1))
    }
}
