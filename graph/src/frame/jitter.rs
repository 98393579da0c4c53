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
    /// Mathematik 2, 1960, in the bases 2 and 3, from the point number 1 on, less one half.
    #[must_use]
    pub fn halton(length: u16, extent: [u32; 2]) -> Jitter {
        let offset = |number: u16| [2, 3].map(|base| radical_inverse(number.into(), base) - 0.5);
        Jitter { extent, offsets: (1..=length.max(1)).map(offset).collect() }
    }

    /// The same shifts around their own middle: what is averaged over all of them is not shifted itself.
    #[must_use]
    pub fn centred(self) -> Jitter {
        let count = self.offsets.len().max(1) as f64;
        let [x, y] = [0, 1].map(|axis| self.offsets.iter().map(|offset| offset[axis]).sum::<f64>() / count);
        Jitter { offsets: self.offsets.iter().map(|offset| [offset[0] - x, offset[1] - y]).collect(), ..self }
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
    use super::Jitter;

    #[test]
    fn centred_shifts_have_no_shift_on_average_and_the_same_distances() {
        for length in [1, 2, 16, 100] {
            let (plain, centred) = (Jitter::halton(length, [8, 8]), Jitter::halton(length, [8, 8]).centred());
            for axis in 0..2 {
                let sum: f64 = centred.offsets.iter().map(|offset| offset[axis]).sum();
                assert!(sum.abs() < 1e-12, "{length}: {sum}");
                let first = plain.offsets[0][axis] - centred.offsets[0][axis];
                let moved = plain.offsets.iter().zip(&centred.offsets).map(|(a, b)| a[axis] - b[axis]);
                assert!(moved.into_iter().all(|it| (it - first).abs() < 1e-12), "{length}");
            }
            assert!(centred.is_sound(), "{length}");
        }
    }

    #[test]
    fn the_first_shifts_are_the_points_that_halton_lists() {
        let jitter = Jitter::halton(6, [4, 2]);
        let points = [(1.0 / 2.0, 1.0 / 3.0), (1.0 / 4.0, 2.0 / 3.0), (3.0 / 4.0, 1.0 / 9.0), (1.0 / 8.0, 4.0 / 9.0)];
        for (frame, (x, y)) in (0..).zip(points) {
            let [right, down] = jitter.offset(frame);
            assert!((right - (x - 0.5)).abs() < 1e-15 && (down - (y - 0.5)).abs() < 1e-15, "{right} {down}");
            assert_eq!(jitter.shift(frame), [right / 4.0, down / 2.0]);
        }
        assert_eq!(jitter.offset(0), jitter.offset(6), "it begins again");
    }

    #[test]
    fn each_cell_of_a_texel_gets_as_many_shifts_as_every_other() {
        // Halton's points fill 2 × 3 boxes evenly, six by six.
        let jitter = Jitter::halton(36, [1, 1]);
        let mut cells = [0; 6];
        for [x, y] in &jitter.offsets {
            cells[((x + 0.5) * 2.0) as usize * 3 + ((y + 0.5) * 3.0) as usize] += 1;
        }
        assert_eq!(cells, [6; 6]);
        assert!(jitter.is_sound());
    }
}
