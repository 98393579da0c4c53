//! The variants that are checked: all combinations of the axes' values, or enough for every pair of values.

use crate::error::Error;
use framewright_lab::sweep::cover;
use std::collections::HashSet;

/// If there are more combinations, pairs of values are checked. This many take two minutes, at two thousand variants a second.
pub(crate) const MOST_VARIANTS: usize = 250_000;

/// One value of each axis, by its number.
pub(crate) type Choice = Vec<usize>;

/// Numbered variants.
#[derive(Debug)]
pub(crate) enum Space {
    /// Every combination; the last axis changes fastest.
    All {
        /// Numbers of values.
        sizes: Vec<usize>,
        /// Further variants.
        more: Vec<Choice>,
    },
    /// Some of them.
    Rows(Vec<Choice>),
}

impl Space {
    /// Every combination of values, of which there are few enough, then those of `more` that aren't among them.
    pub(crate) fn all(sizes: Vec<usize>, mut more: Vec<Choice>) -> Space {
        more.retain(|choice| choice.iter().zip(&sizes).any(|(value, size)| value >= size));
        each_once(&mut more);
        Space::All { sizes, more }
    }

    /// Every combination of values, or where these are more than [`MOST_VARIANTS`] rows in which each pair occurs; then those of `more`
    /// that aren't among them. With rows comes the number of combinations.
    ///
    /// # Errors
    /// If even the pairs are too many.
    pub(crate) fn all_or_pairwise(sizes: Vec<usize>, more: Vec<Choice>) -> Result<(Space, Option<u128>), Error> {
        let all = sizes.iter().fold(1_u128, |all, size| all.saturating_mul(*size as u128));
        match all > MOST_VARIANTS as u128 {
            true => Ok((Space::pairwise(&sizes, more)?, Some(all))),
            false => Ok((Space::all(sizes, more), None)),
        }
    }

    /// Whether it is every combination.
    #[must_use]
    pub(crate) fn is_all(&self) -> bool {
        matches!(self, Space::All { .. })
    }

    /// Rows in which each pair of values of any two axes occurs, then those of `more` that aren't among them.
    ///
    /// # Errors
    /// If there are too many pairs.
    pub(crate) fn pairwise(sizes: &[usize], mut more: Vec<Choice>) -> Result<Space, Error> {
        let pairs = cover::pairs(sizes);
        if pairs > cover::MOST_PAIRS {
            return Err(Error::TooManyPairs { pairs, most: cover::MOST_PAIRS });
        }
        let mut rows = cover::rows(sizes);
        // Rows that differ only on the last axes come together; the first row, all 0, stays the first.
        rows.sort_unstable();
        more.retain(|choice| rows.binary_search(choice).is_err());
        each_once(&mut more);
        rows.append(&mut more);
        Ok(Space::Rows(rows))
    }

    /// Number of variants.
    #[must_use]
    pub(crate) fn len(&self) -> usize {
        match self {
            Space::All { sizes, more } => combinations(sizes) + more.len(),
            Space::Rows(rows) => rows.len(),
        }
    }

    /// The variant of that number, below [`Space::len`].
    #[must_use]
    pub(crate) fn choice(&self, number: usize) -> Choice {
        match self {
            Space::All { sizes, more } => {
                if let Some(one) = number.checked_sub(combinations(sizes)).and_then(|at| more.get(at)) {
                    return one.clone();
                }
                let mut left = number;
                let mut choice: Choice = sizes
                    .iter()
                    .rev()
                    .map(|size| {
                        let value = left % size;
                        left /= size;
                        value
                    })
                    .collect();
                choice.reverse();
                choice
            }
            Space::Rows(rows) => rows[number].clone(),
        }
    }
}

fn combinations(sizes: &[usize]) -> usize {
    sizes.iter().product()
}

/// Removes duplicates.
fn each_once(choices: &mut Vec<Choice>) {
    let mut seen = HashSet::new();
    choices.retain(|choice| seen.insert(choice.clone()));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_combination_stands_once_in_its_order() {
        let space = Space::all(vec![2, 3], Vec::new());
        let all: Vec<Choice> = (0..space.len()).map(|number| space.choice(number)).collect();
        assert_eq!(all, [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2]]);
    }

    #[test]
    fn what_else_is_asked_for_comes_last_and_nothing_comes_twice() {
        let more = || vec![vec![1, 2], vec![2, 0], vec![0, 4], vec![2, 0]];
        let all = |space: Space| (0..space.len()).map(|number| space.choice(number)).collect::<Vec<Choice>>();
        let every = all(Space::all(vec![2, 3], more()));
        assert_eq!((every.len(), &every[5..]), (8, &[vec![1, 2], vec![2, 0], vec![0, 4]][..]));
        let pairs = all(Space::pairwise(&[2, 3], more()).expect("few"));
        assert_eq!((pairs.len(), &pairs[6..]), (8, &[vec![2, 0], vec![0, 4]][..]));
    }

    #[test]
    fn of_too_many_combinations_pairs_are_taken_and_too_many_pairs_are_refused() {
        let (space, beyond) = Space::all_or_pairwise(vec![500, 500], Vec::new()).expect("few");
        assert_eq!((space.len(), space.is_all(), beyond), (MOST_VARIANTS, true, None));
        let (space, beyond) = Space::all_or_pairwise(vec![2; 18], Vec::new()).expect("few pairs");
        assert_eq!((space.is_all(), beyond), (false, Some(1 << 18)));
        assert!(space.len() < 20, "{}", space.len());
        let (space, beyond) = Space::all_or_pairwise(vec![2; 200], Vec::new()).expect("few pairs");
        assert!(space.len() < 40 && beyond == Some(u128::MAX), "{}", space.len());
        assert!(matches!(Space::all_or_pairwise(vec![usize::MAX; 9], Vec::new()), Err(Error::TooManyPairs { .. })));
    }
}
