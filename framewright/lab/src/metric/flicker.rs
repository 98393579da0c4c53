//! Flicker: how much the error of a picture changes from one frame to the next.
//!
//! The error of a frame is the difference of what a display shows: the tested frame minus the reference of the same moment, in the
//! curve of sRGB. Movement that the reference shows too is no part of it, nor is an error that stays as it is. At each pixel flicker is
//! the root of the mean square of the error's changes, over all pairs of consecutive frames and over red, green and blue:
//! `sqrt(Σ (e(f) − e(f − 1))² / (3 · (N − 1)))`.

use super::plane::Plane;
use super::{PooledFigures, is_finite, shown};
use crate::picture::Light;
use serde::{Deserialize, Serialize};

/// Flicker over some frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flicker {
    /// Frames that were drawn.
    pub frames: u32,
    /// The mean over all pixels, from 0 to 2.
    pub mean: f64,
    /// At most this at 95 of 100 pixels.
    pub percentile_95: f64,
    /// At the worst pixel.
    pub worst: f64,
    /// Pixels that aren't finite in a frame, or in its reference. They are no part of the figures.
    pub non_finite: usize,
    #[serde(skip)]
    map: Plane,
}

/// Errors of consecutive frames as they come.
#[derive(Debug, Default)]
pub struct Changes {
    frames: u32,
    extent: [usize; 2],
    /// The last frame's errors.
    last: Vec<[f64; 3]>,
    /// Sums of the squares of changes.
    squares: Vec<f64>,
    /// Whether a pixel was finite in all frames.
    finite: Vec<bool>,
}

impl Changes {
    /// Adds the next frame and its reference, which are of one size, that of all frames.
    pub fn add(&mut self, reference: &Light, test: &Light) {
        let pairs = || reference.texels.iter().zip(&test.texels);
        let errors = pairs().map(|(reference, test)| {
            let (reference, test) = (shown(reference.map(f64::from)), shown(test.map(f64::from)));
            [0, 1, 2].map(|at| test[at] - reference[at])
        });
        let errors: Vec<[f64; 3]> = errors.collect();
        if self.frames == 0 {
            self.extent = reference.extent;
            self.squares = vec![0.0; errors.len()];
            self.finite = vec![true; errors.len()];
        } else {
            for ((sum, before), now) in self.squares.iter_mut().zip(&self.last).zip(&errors) {
                *sum += before.iter().zip(now).map(|(before, now)| (now - before).powi(2)).sum::<f64>();
            }
        }
        for (finite, (reference, test)) in self.finite.iter_mut().zip(pairs()) {
            *finite &= is_finite(reference) && is_finite(test);
        }
        self.last = errors;
        self.frames += 1;
    }

    /// The flicker of all frames so far.
    pub fn flicker(&self) -> Flicker {
        let changes = 3.0 * f64::from(self.frames.saturating_sub(1).max(1));
        let of = |(sum, finite): (&f64, &bool)| if *finite { (sum / changes).sqrt() } else { 0.0 };
        let values: Vec<f64> = self.squares.iter().zip(&self.finite).map(of).collect();
        let counted = values.iter().zip(&self.finite).filter(|(_, finite)| **finite).map(|(value, _)| *value);
        let PooledFigures { mean, percentile_95, worst } = PooledFigures::of(counted);
        let non_finite = self.finite.iter().filter(|finite| !**finite).count();
        let map = Plane { extent: self.extent, values };
        Flicker { frames: self.frames, mean, percentile_95, worst, non_finite, map }
    }
}

impl Flicker {
    /// Flicker of each pixel, in rows from the top.
    #[must_use]
    pub fn map(&self) -> &[f64] {
        &self.map.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_passes::srgb;

    /// A picture whose pixels a display shows as these greys.
    fn greys(values: [f64; 3]) -> Light {
        #[allow(clippy::cast_possible_truncation, reason = "light is kept with as many bits as shaders have")]
        let texels = values.map(|value| [srgb::decode(value) as f32; 3]);
        Light { extent: [3, 1], texels: texels.into(), is_light: false, left_out: Vec::new() }
    }

    fn flicker(frames: &[[[f64; 3]; 2]]) -> Flicker {
        let mut changes = Changes::default();
        for [reference, test] in frames {
            changes.add(&greys(*reference), &greys(*test));
        }
        changes.flicker()
    }

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-6
    }

    #[test]
    fn flicker_is_the_root_mean_square_of_the_changes_of_the_error() {
        // The first pixel is right. The second is wrong by 0.25, always. The third is right, then wrong by 0.5, then by -0.25.
        let of = flicker(&[
            [[0.1, 0.5, 0.25], [0.1, 0.75, 0.25]],
            [[0.9, 0.25, 0.25], [0.9, 0.5, 0.75]],
            [[0.3, 0.5, 0.5], [0.3, 0.75, 0.25]],
        ]);
        // Its changes are 0.5 and -0.75: the root of (0.25 + 0.5625) / 2.
        let worst = 0.406_25_f64.sqrt();
        assert!(near(of.worst, worst) && near(of.percentile_95, worst) && near(of.mean, worst / 3.0), "{of:?}");
        assert!(near(of.map()[0], 0.0) && near(of.map()[1], 0.0) && near(of.map()[2], worst), "{of:?}");
        assert_eq!((of.frames, of.non_finite), (3, 0));
    }

    #[test]
    fn a_picture_that_is_wrong_in_the_same_way_does_not_flicker() {
        assert_eq!(flicker(&[[[0.2; 3], [0.8; 3]], [[0.2; 3], [0.8; 3]]]).worst, 0.0);
        assert_eq!(flicker(&[[[0.2; 3], [0.8; 3]]]).worst, 0.0);
        assert_eq!(Changes::default().flicker().mean, 0.0);
    }

    #[test]
    fn pixels_that_are_not_finite_are_counted_and_are_no_part_of_it() {
        let mut changes = Changes::default();
        let mut wrong = greys([0.2, 0.4, 0.6]);
        changes.add(&greys([0.2, 0.4, 0.6]), &wrong);
        wrong.texels[1] = [f32::NAN; 3];
        changes.add(&greys([0.2, 0.4, 0.6]), &wrong);
        changes.add(&greys([0.2, 0.4, 0.6]), &greys([0.2, 0.4, 0.6]));
        let of = changes.flicker();
        assert_eq!((of.non_finite, of.worst), (1, 0.0));
    }
}
