//! Where cascades of the sun's shadows cut what a camera sees, and how many of them a scene needs.

use framewright_graph::frame::{Cascade, Share};

/// Slices begin at this share of the reach, or at the near plane where that is further off.
const NEAREST: f64 = 1.0 / 256.0;
/// A reach through the whole scene is at most this many times the diameter of the box around all objects and cameras: the sum of
/// two distances in the box is at most 2/√3 of its diameter, and it is rounded up to a power of √2.
const ROUNDED: f64 = 2.0;

/// Rounds a distance up to ten near distances times a power of √2, so that it stays the same while the camera moves a little. The near
/// distance is what a camera in a scene of another unit has in that unit.
pub(crate) fn through(distance: f64, near: f32) -> f64 {
    let step = f64::from(near * 10.0);
    step * (((distance / step).max(f64::MIN_POSITIVE).log2() * 2.0).ceil() * 0.5).exp2()
}

/// How a distance is cut into slices.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Splits {
    /// The distance of the near plane, metres.
    pub(crate) near: f64,
    /// The distance at which the last slice ends, metres.
    pub(crate) reach: f64,
    /// How many slices there are.
    pub(crate) of: u8,
    /// The share of logarithmic splits; the rest is uniform splits.
    pub(crate) logarithmic: Share,
}

impl Splits {
    /// How far from the camera the slice number `border` begins, metres.
    pub(crate) fn border(&self, border: u8) -> f64 {
        if border == 0 {
            return 0.0;
        }
        let nearest = self.near.max(self.reach * NEAREST).min(self.reach);
        let share = f64::from(border) / f64::from(self.of.max(1));
        let logarithmic = nearest * (self.reach / nearest).powf(share);
        let even = nearest + (self.reach - nearest) * share;
        let share = f64::from(f32::from(self.logarithmic));
        share * logarithmic + (1.0 - share) * even
    }

    /// The most that the far end of a slice is further off than what is seen first in it. The size of its texels in the picture
    /// is in proportion to that.
    fn coarsest(&self) -> f64 {
        let seen_from = |slice| self.border(slice).max(self.near);
        (0..self.of).map(|slice| self.border(slice + 1) / seen_from(slice)).fold(0.0, f64::max)
    }
}

/// The fewest cascades, 1, 2 or the most, whose texels cover no more of the picture than those of the most cascades do in a scene
/// of any depth, where slices begin. `depth_range` is as in [`Facts`](framewright_graph::language::Facts). Splits are as
/// logarithmic as where a pipeline says nothing.
pub(super) fn needed(depth_range: f64) -> u8 {
    let logarithmic = Share::OF_CASCADES;
    let endless = Splits { near: 0.0, reach: 1.0, of: Cascade::MOST, logarithmic };
    let allowed = endless.border(1) / NEAREST;
    let cut = |of| Splits { near: 1.0, reach: depth_range * ROUNDED, of, logarithmic };
    [1, 2].into_iter().find(|of| cut(*of).coarsest() <= allowed).unwrap_or(Cascade::MOST)
}
