//! Shifts of a picture by parts of a texel, so that frames together see more than one of them does.

use serde::{Deserialize, Serialize};

/// The most frames that [`Jitter::halton`] shifts differently.
pub const LONGEST: u16 = 256;

/// How the picture of a view's camera is shifted from frame to frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Jitter {
    /// Width and height of the picture whose texels are meant, each at least 1.
    pub extent: [u32; 2],
    /// By how many texels to the right and down, each from −0.5 to 0.5. The first is frame 0's; after the last one comes the
    /// first again. At least one.
    pub offsets: Vec<[f64; 2]>,
}

impl Jitter {
    /// As many shifts as `length` says, at least one, spread evenly over a texel: the points of J. H. Halton, "On the
    /// efficiency of certain quasi-random sequences of points in evaluating multi-dimensional integrals", Numerische
    /// Mathematik 2, 1960, in the bases 2 and 3, from the point number 1 on, less their
    /// mean: a picture that is averaged over all of them is not shifted itself.
    #[must_use]
    pub fn halton(length: u16, extent: [u32; 2]) -> Jitter {
        let length = length.max(1);
        let axis = |base| {
            let points = (1..=length).map(move |number| radical_inverse(number.into(), base));
            let mean = points.clone().sum::<f64>() / f64::from(length);
            // At some lengths a point then lies a little beyond half a texel: all points move closer to the middle.
            let farthest = points.clone().map(|point| (point - mean).abs()).fold(0.5, f64::max);
            points.map(move |point| (point - mean) * (0.5 / farthest))
        };
        let offsets = axis(2).zip(axis(3)).map(|(right, down)| [right, down]);
        Jitter { extent, offsets: offsets.collect() }
    }

    /// The shift of a frame to the right and down, in texels.
    #[must_use]
    pub fn offset(&self, frame: u64) -> [f64; 2] {
        let at = frame.checked_rem(self.offsets.len() as u64).and_then(|at| usize::try_from(at).ok());
        at.and_then(|at| self.offsets.get(at)).copied().unwrap_or_default()
    }

    /// The same as a share of the picture's width and height.
    #[must_use]
    pub fn shift(&self, frame: u64) -> [f64; 2] {
        let [x, y] = self.offset(frame);
        let [width, height] = self.extent.map(|side| f64::from(side.max(1)));
        [x / width, y / height]
    }

    /// Whether it can be carried out: every number is in its range.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let within = |part: &f64| (-0.5..=0.5).contains(part);
        self.extent.iter().all(|side| *side > 0)
            && !self.offsets.is_empty()
            && self.offsets.iter().flatten().all(within)
    }
}

/// The digits of `number` in a base, mirrored at the point: 6 is 110 in base 2 and becomes 0.011, which is 3/8.
fn radical_inverse(mut number: u32, base: u32) -> f64 {
    let (mut value, mut place) = (0.0, 1.0);
    while number > 0 {
        place /= f64::from(base);
        value += f64::from(number % base) * place;
        number /= base;
    }
    value
}

#[cfg(test)]
mod tests {
    use super::{Jitter, LONGEST};

    #[test]
    fn the_mean_of_all_shifts_is_none_and_each_stays_within_a_texel() {
        for length in (1..200).chain([LONGEST]) {
            let jitter = Jitter::halton(length, [8, 8]);
            assert!(jitter.is_sound() && jitter.offsets.len() == usize::from(length), "{length}");
            for axis in 0..2 {
                let sum: f64 = jitter.offsets.iter().map(|offset| offset[axis]).sum();
                assert!(sum.abs() < 1e-10, "{length}: {sum}");
            }
        }
    }

    #[test]
    fn the_first_shifts_are_the_points_that_halton_lists() {
        let jitter = Jitter::halton(6, [4, 2]);
        // The mean of six points: 1/2, 1/4, 3/4, 1/8, 5/8, 3/8, and 1/3, 2/3, 1/9, 4/9, 7/9, 2/9.
        let mean = (21.0 / 48.0, 23.0 / 54.0);
        let points = [(1.0 / 2.0, 1.0 / 3.0), (1.0 / 4.0, 2.0 / 3.0), (3.0 / 4.0, 1.0 / 9.0), (1.0 / 8.0, 4.0 / 9.0)];
        for (frame, (x, y)) in (0..).zip(points) {
            let [right, down] = jitter.offset(frame);
            assert!((right - (x - mean.0)).abs() < 1e-15 && (down - (y - mean.1)).abs() < 1e-15, "{right} {down}");
            assert_eq!(jitter.shift(frame), [right / 4.0, down / 2.0]);
        }
        assert_eq!(jitter.offset(0), jitter.offset(6), "it begins again");
    }

    #[test]
    fn each_cell_of_a_texel_gets_as_many_shifts_as_every_other() {
        // Halton's points fill 2 × 3 boxes evenly, six by six.
        let jitter = Jitter::halton(36, [1, 1]);
        let mut cells = [0; 6];
        // Counted from the first point.
        let [first_x, first_y] = jitter.offsets[0];
        for [x, y] in &jitter.offsets {
            let [x, y] = [x - first_x + 1.0 / 2.0, y - first_y + 1.0 / 3.0];
            cells[(x * 2.0 + 1e-9) as usize * 3 + (y * 3.0 + 1e-9) as usize] += 1;
        }
        assert_eq!(cells, [6; 6]);
        assert!(jitter.is_sound());
    }
}
