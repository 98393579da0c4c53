//! The arguments of the formulas that `formulas.frag` draws.

use super::formulas::SIDE;
use framewright_passes::twin::random::{hash, random};
use framewright_passes::twin::stereo::Part;
use glam::DVec3;

/// The arguments of a texel, as in `formulas.frag`.
pub(super) struct Arguments {
    pub(super) at: u32,
}

impl Arguments {
    pub(super) fn bits(&self, which: u32) -> u32 {
        hash(self.at * 64 + which)
    }

    pub(super) fn even(&self, which: u32) -> f64 {
        random(self.at * 64 + which)
    }

    pub(super) fn wide(&self, which: u32, least: i32, beyond: i32) -> f64 {
        let exponent = least + (self.bits(which + 32) % (beyond - least) as u32) as i32;
        (1.0 + self.even(which)) * 2_f64.powi(exponent)
    }

    pub(super) fn light(&self, which: u32) -> [f64; 3] {
        [0, 1, 2].map(|more| self.wide(which + more, -24, 16))
    }

    pub(super) fn even3(&self, which: u32) -> [f64; 3] {
        [0, 1, 2].map(|more| self.even(which + more))
    }

    pub(super) fn unit(&self, which: u32) -> DVec3 {
        (2.0 * DVec3::from(self.even3(which)) - 1.0).normalize_or_zero()
    }

    /// A part of an image.
    pub(super) fn part(&self, which: u32) -> Part {
        let side = |more| 0.0625 + 0.875 * self.even(which + more);
        let whole = [self.at % 8 < 2, self.at.is_multiple_of(8)];
        let scale = [0, 1].map(|axis| if whole[axis] { 1.0 } else { side(axis as u32) });
        // Rounded as a shader's own are.
        let offset =
            [0, 1].map(|axis| f64::from((1.0 - scale[axis] as f32) * self.even(which + 2 + axis as u32) as f32));
        Part { scale: scale.map(|it| f64::from(it as f32)), offset }
    }

    pub(super) fn float(&self, which: u32) -> f64 {
        f64::from(f32::from_bits(self.bits(which)))
    }

    pub(super) fn texel(&self) -> [u32; 2] {
        [self.at % SIDE, self.at / SIDE]
    }
}
