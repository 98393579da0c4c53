//! Defaults of a scene: a clear day.

use super::model::{Sky, Sun};

/// From the front left, high above, warm.
pub(crate) const SUN: Sun =
    Sun { direction: [2.0 / 7.0, -6.0 / 7.0, -3.0 / 7.0], color: [1.05, 1.0, 0.9], shadows: false };

/// Bluish.
pub(crate) const AMBIENT: [f32; 3] = [0.24, 0.26, 0.3];

/// Pale at the horizon.
pub(crate) const SKY: Sky = Sky { zenith: [0.13, 0.28, 0.56], horizon: [0.58, 0.68, 0.78], ground: [0.22, 0.21, 0.2] };
