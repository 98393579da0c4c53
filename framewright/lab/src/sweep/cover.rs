//! Covering arrays: few rows in which every pair of values of any two axes occurs.
//!
//! Axis by axis, as in Lei and Tai, "In-Parameter-Order: A Test Generation Strategy for Pairwise Testing" (1998): the rows
//! for the axes so far are widened by the value that covers most pairs, then rows are added for pairs that are left. Nothing
//! is left to chance: the same sizes give the same rows.

/// Pairs of values of two axes that are kept track of: as many as take seconds.
pub const MOST_PAIRS: usize = 20_000_000;

/// A cell that any value may take.
const FREE: usize = usize::MAX;

/// The number of pairs of values of any two axes. `sizes` are the axes' numbers of values.
#[must_use]
pub fn pairs(sizes: &[usize]) -> usize {
    let mut before = 0_usize;
    sizes.iter().fold(0_usize, |pairs, size| {
        let pairs = pairs.saturating_add(before.saturating_mul(*size));
        before = before.saturating_add(*size);
        pairs
    })
}

/// Rows with one value, from 0, for each axis, whose numbers of values are `sizes`. The first row is all 0, and cells that no pair needs
/// are 0. There are none if an axis has no value.
#[must_use]
pub fn rows(sizes: &[usize]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|axis| std::cmp::Reverse(sizes[*axis]));
    if sizes.contains(&0) {
        return Vec::new();
    }
    let Some((first, others)) = order.split_first() else { return vec![Vec::new()] };
    let mut rows: Vec<Vec<usize>> = (0..sizes[*first])
        .map(|value| {
            let mut row = vec![FREE; sizes.len()];
            row[*first] = value;
            row
        })
        .collect();
    for (done, axis) in (1..).zip(others) {
        let mut open = OpenPairs::new(sizes, &order[..done], *axis);
        widen(&mut rows, &mut open);
        add_what_is_left(&mut rows, &mut open, sizes.len());
    }
    rows.iter_mut().flatten().filter(|cell| **cell == FREE).for_each(|cell| *cell = 0);
    rows
}

/// Pairs of a new axis' values with those of the axes before it that occur in no row yet.
struct OpenPairs<'a> {
    before: &'a [usize],
    axis: usize,
    values: usize,
    /// By axis before: by its value, then by the new axis' value.
    pairs: Vec<Vec<bool>>,
}

impl OpenPairs<'_> {
    fn new<'a>(sizes: &[usize], before: &'a [usize], axis: usize) -> OpenPairs<'a> {
        let values = sizes[axis];
        let pairs = before.iter().map(|other| vec![true; sizes[*other] * values]).collect();
        OpenPairs { before, axis, values, pairs }
    }

    /// How many pairs `row` would cover with `value` on the new axis.
    fn gain(&self, row: &[usize], value: usize) -> usize {
        let covered = |(pairs, other): (&Vec<bool>, &usize)| {
            let beside = row[*other];
            beside != FREE && pairs[beside * self.values + value]
        };
        self.pairs.iter().zip(self.before).map(|pair| usize::from(covered(pair))).sum()
    }

    fn cover(&mut self, row: &[usize]) {
        let value = row[self.axis];
        for (pairs, other) in self.pairs.iter_mut().zip(self.before) {
            if row[*other] != FREE {
                pairs[row[*other] * self.values + value] = false;
            }
        }
    }
}

/// Gives each row the new axis' value that covers most; of equal ones that which was taken least.
fn widen(rows: &mut [Vec<usize>], open: &mut OpenPairs<'_>) {
    let mut taken = vec![0_usize; open.values];
    for row in rows {
        let rank =
            |value: &usize| (open.gain(row, *value), std::cmp::Reverse(taken[*value]), std::cmp::Reverse(*value));
        let Some(best) = (0..open.values).max_by_key(rank).filter(|value| open.gain(row, *value) > 0) else { continue };
        row[open.axis] = best;
        taken[best] += 1;
        open.cover(row);
    }
}

/// Puts the pairs that no row covers into free cells, or else into rows of their own.
fn add_what_is_left(rows: &mut Vec<Vec<usize>>, open: &mut OpenPairs<'_>, axes: usize) {
    for (at, other) in open.before.iter().enumerate() {
        for pair in 0..open.pairs[at].len() {
            if !open.pairs[at][pair] {
                continue;
            }
            let (beside, value) = (pair / open.values, pair % open.values);
            let free_or = |cell: usize, value: usize| cell == FREE || cell == value;
            let fitting = rows.iter().position(|row| free_or(row[*other], beside) && free_or(row[open.axis], value));
            let row = fitting.unwrap_or_else(|| {
                rows.push(vec![FREE; axes]);
                rows.len() - 1
            });
            rows[row][*other] = beside;
            rows[row][open.axis] = value;
            open.cover(&rows[row]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts pairs anew, with nothing of the above.
    fn every_pair_occurs(sizes: &[usize], rows: &[Vec<usize>]) -> bool {
        (0..sizes.len()).all(|a| {
            (a + 1..sizes.len()).all(|b| {
                let seen: std::collections::BTreeSet<_> = rows.iter().map(|row| (row[a], row[b])).collect();
                seen.len() == sizes[a] * sizes[b]
            })
        }) && rows.iter().all(|row| row.iter().zip(sizes).all(|(value, size)| value < size))
    }

    #[test]
    fn every_pair_occurs_whatever_the_axes() {
        let mut state = 1_u64;
        for count in 0..60 {
            let sizes: Vec<usize> = (0..count % 12)
                .map(|_| {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    1 + (state >> 60) as usize % 9
                })
                .collect();
            let rows = rows(&sizes);
            assert!(every_pair_occurs(&sizes, &rows), "{sizes:?}: {rows:?}");
            assert!(rows[0].iter().all(|value| *value == 0), "{rows:?}");
        }
    }

    #[test]
    fn there_are_hardly_more_rows_than_the_least_that_are_known() {
        // The least known are 6, 15, 6 and 8 rows, 24 and 100.
        for (axes, values, most) in [(10, 2, 10), (13, 3, 22), (4, 2, 6), (12, 2, 10), (10, 4, 30), (4, 10, 130)] {
            let sizes = vec![values; axes];
            let rows = rows(&sizes);
            assert!(rows.len() <= most, "{axes} axes of {values}: {} rows", rows.len());
            assert!(every_pair_occurs(&sizes, &rows));
        }
    }

    #[test]
    fn one_axis_gives_each_value_once_and_none_gives_one_row_and_no_value_none() {
        assert_eq!(rows(&[3]), [[0], [1], [2]]);
        assert_eq!(rows(&[]), [[0_usize; 0]]);
        assert!(rows(&[0]).is_empty() && rows(&[2, 0, 3]).is_empty());
    }

    #[test]
    fn pairs_are_counted_and_so_many_never_overflow() {
        assert_eq!(pairs(&[]), 0);
        assert_eq!(pairs(&[7]), 0);
        assert_eq!(pairs(&[2, 3, 4]), 6 + 8 + 12);
        assert_eq!(pairs(&[usize::MAX, usize::MAX, 2]), usize::MAX);
    }
}
