//! One number for each pixel, and separable filters over it.

/// One number for each pixel of an image, in rows from the top.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Plane {
    pub(super) extent: [usize; 2],
    pub(super) values: Vec<f64>,
}

/// The numbers beyond the edge of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Edge {
    /// The number at the edge is repeated.
    Repeated,
    /// The image is mirrored; the number at the edge stands on both sides.
    Mirrored,
}

impl Edge {
    /// The position within `0..size` whose number stands at `at`.
    fn position(self, at: isize, size: usize) -> usize {
        let last = size as isize - 1;
        let position = match self {
            Edge::Repeated => at.clamp(0, last),
            Edge::Mirrored => {
                let within = at.rem_euclid(2 * (last + 1));
                within.min(2 * last + 1 - within)
            }
        };
        position.unsigned_abs()
    }
}

impl Plane {
    /// A plane whose numbers are made of the colours of an image.
    pub(super) fn of(extent: [usize; 2], texels: &[[f64; 3]], number: impl Fn([f64; 3]) -> f64) -> Plane {
        Plane { extent, values: texels.iter().map(|texel| number(*texel)).collect() }
    }

    /// The plane, weighted by `weights` along rows and by `columns` along columns. Each list has an odd number of weights; the
    /// middle one is that of the pixel itself.
    pub(super) fn filtered(&self, rows: &[f64], columns: &[f64], edge: Edge) -> Plane {
        let [width, height] = self.extent;
        let mut across = vec![0.0; self.values.len()];
        let half = rows.len() / 2;
        let mut padded = vec![0.0; width + 2 * half];
        for (from, to) in self.values.chunks_exact(width).zip(across.chunks_exact_mut(width)) {
            for (number, at) in padded.iter_mut().zip(-(half as isize)..) {
                *number = from[edge.position(at, width)];
            }
            for (weight, shifted) in rows.iter().zip(padded.windows(width)) {
                to.iter_mut().zip(shifted).for_each(|(sum, number)| *sum += weight * number);
            }
        }
        let mut values = vec![0.0; self.values.len()];
        let half = columns.len() / 2;
        for (to, row) in values.chunks_exact_mut(width).zip(0_isize..) {
            for (weight, at) in columns.iter().zip(row - half as isize..) {
                let from = edge.position(at, height) * width;
                to.iter_mut().zip(&across[from..from + width]).for_each(|(sum, number)| *sum += weight * number);
            }
        }
        Plane { extent: self.extent, values }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beyond_the_edge_numbers_are_repeated_or_mirrored() {
        let row = |edge: Edge| (-4..7).map(|at| edge.position(at, 3)).collect::<Vec<_>>();
        assert_eq!(row(Edge::Repeated), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]);
        assert_eq!(row(Edge::Mirrored), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
        assert_eq!(Edge::Mirrored.position(-7, 1), 0);
    }

    #[test]
    fn rows_and_columns_are_weighted_each_by_its_own_list() {
        let plane = Plane { extent: [3, 2], values: vec![1.0, 2.0, 4.0, 8.0, 16.0, 32.0] };
        let right = plane.filtered(&[0.0, 0.0, 1.0], &[1.0], Edge::Repeated);
        assert_eq!(right.values, [2.0, 4.0, 4.0, 16.0, 32.0, 32.0]);
        let above = plane.filtered(&[1.0], &[1.0, 0.0, 0.0], Edge::Repeated);
        assert_eq!(above.values, [1.0, 2.0, 4.0, 1.0, 2.0, 4.0]);
    }
}
