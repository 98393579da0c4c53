//! Sweeps: the values that settings take, and the choices that they make together.

pub mod cover;
mod values;

use crate::error::Error;
use std::collections::BTreeMap;
pub use values::{text, values};

/// Sweeps of things that are no settings: the size of the output.
pub const SIZE: &str = "@size";
/// The scene.
pub const SCENE: &str = "@scene";
/// The way of drawing for two eyes.
pub const STEREO: &str = "@stereo";

/// The values that one setting takes.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// The setting; or [`SIZE`], [`SCENE`] or [`STEREO`].
    pub name: String,
    /// As texts.
    pub values: Vec<String>,
}

/// Sweeps make at most this many choices: see [`choices`].
pub const MOST_CHOICES: usize = 10_000;

/// How several sweeps make choices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Combination {
    /// Every value with every other.
    All,
    /// Each pair of values of any two settings occurs.
    Pairwise,
    /// One setting at a time.
    OneByOne,
}

/// The number of choices that sweeps make, even where there are too many to make.
#[must_use]
pub fn count(sweeps: &[Sweep], combined: Combination) -> u128 {
    let sizes = sweeps.iter().map(|sweep| sweep.values.len() as u128);
    match combined {
        Combination::OneByOne => sizes.sum::<u128>() + 1,
        // At most: a pair of values in each.
        Combination::Pairwise if sweeps.len() > 1 => {
            cover::pairs(&sweeps.iter().map(|sweep| sweep.values.len()).collect::<Vec<_>>()) as u128
        }
        Combination::All | Combination::Pairwise => sizes.fold(1, u128::saturating_mul),
    }
}

/// The choices that sweeps make, each once: values by name. The last sweep varies fastest. A sweep without values leaves none, unless
/// they vary one by one.
///
/// # Errors
/// [`Error::Sweep`] if their [`count`] is above [`MOST_CHOICES`].
pub fn choices(sweeps: &[Sweep], combined: Combination) -> Result<Vec<BTreeMap<String, String>>, Error> {
    let fits = |combined| count(sweeps, combined) <= MOST_CHOICES as u128;
    if !fits(combined) {
        let or_pairs = if fits(Combination::Pairwise) { ", or combine them pairwise" } else { "" };
        let count = count(sweeps, combined);
        return Err(Error::Sweep {
            what: format!(
                "the sweep has {count} choices, and at most {MOST_CHOICES} are measured: sweep fewer values{or_pairs}"
            ),
        });
    }
    let chosen = |row: &[usize]| -> BTreeMap<String, String> {
        sweeps.iter().zip(row).map(|(sweep, at)| (sweep.name.clone(), sweep.values[*at].clone())).collect()
    };
    Ok(match combined {
        Combination::OneByOne => {
            let one = |sweep: &Sweep, value: &String| BTreeMap::from([(sweep.name.clone(), value.clone())]);
            let each = sweeps.iter().flat_map(|sweep| sweep.values.iter().map(move |value| one(sweep, value)));
            std::iter::once(BTreeMap::new()).chain(each).collect()
        }
        Combination::Pairwise if sweeps.len() > 1 => {
            let sizes: Vec<usize> = sweeps.iter().map(|sweep| sweep.values.len()).collect();
            cover::rows(&sizes).iter().map(|row| chosen(row)).collect()
        }
        Combination::All | Combination::Pairwise => {
            let mut rows = vec![Vec::new()];
            for sweep in sweeps {
                let longer = |row: &Vec<usize>| {
                    let row = row.clone();
                    (0..sweep.values.len()).map(move |at| row.iter().copied().chain([at]).collect::<Vec<usize>>())
                };
                rows = rows.iter().flat_map(longer).collect();
            }
            rows.iter().map(|row| chosen(row)).collect()
        }
    })
}

/// The name of a size, as results have it.
#[must_use]
pub fn size_name([width, height]: [u32; 2]) -> String {
    format!("{width}x{height}")
}

/// The part `number` of `of` parts of a list, numbered from 1; empty if there is no such part. All parts together are the list.
#[must_use]
pub fn shard<T>(list: Vec<T>, number: usize, of: usize) -> Vec<T> {
    match (1..=of).contains(&number) {
        true => list.into_iter().skip(number - 1).step_by(of).collect(),
        false => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_all_products_or_enough_for_pairs_or_one_by_one() {
        let sweep = |name: &str, values: &[&str]| Sweep {
            name: name.to_owned(),
            values: values.iter().map(|value| (*value).to_owned()).collect(),
        };
        let sweeps = [sweep("a", &["1", "2", "3"]), sweep("b", &["x", "y"]), sweep("c", &["p", "q"])];
        let choices = |sweeps: &[Sweep], combined| choices(sweeps, combined).expect("few");
        let all = choices(&sweeps, Combination::All);
        assert_eq!((all.len() as u128, count(&sweeps, Combination::All)), (12, 12));
        assert_eq!(all[1]["c"], "q");
        let pairs = choices(&sweeps, Combination::Pairwise);
        assert!(
            pairs.len() < 12
                && all
                    .iter()
                    .flat_map(|row| row.iter().zip(row.iter().skip(1)))
                    .all(|(one, other)| { pairs.iter().any(|row| row[one.0] == *one.1 && row[other.0] == *other.1) })
        );
        assert_eq!(choices(&sweeps, Combination::OneByOne).len(), 8);
        assert_eq!(choices(&sweeps[..1], Combination::Pairwise).len(), 3);
        assert_eq!(choices(&[], Combination::All), [BTreeMap::new()]);
        for combined in [Combination::All, Combination::Pairwise] {
            assert!(choices(&[sweep("a", &["1", "2"]), sweep("b", &[])], combined).is_empty());
        }
    }

    #[test]
    fn too_many_choices_are_refused_before_they_are_made() {
        let sweep = |name: &str, values: u32| Sweep {
            name: name.to_owned(),
            values: (0..values).map(|value| value.to_string()).collect(),
        };
        let refused = |sweeps: &[Sweep], combined| choices(sweeps, combined).expect_err("too many").to_string();
        let [many, some] = [sweep("a", 10_001), sweep("b", 30)];
        for combined in [Combination::All, Combination::Pairwise, Combination::OneByOne] {
            let refused = refused(std::slice::from_ref(&many), combined);
            assert!(refused.contains("at most 10000 are measured: sweep fewer values"), "{refused}");
        }
        let cube = [some.clone(), some.clone(), some];
        let refused = refused(&cube, Combination::All);
        assert!(refused.contains("has 27000 choices") && refused.ends_with(", or combine them pairwise"), "{refused}");
        assert!(choices(&cube, Combination::Pairwise).is_ok_and(|rows| rows.len() >= 900));
    }

    #[test]
    fn shards_together_are_the_list() {
        let mut joined: Vec<u32> = (1..=3).flat_map(|number| shard((0..10).collect(), number, 3)).collect();
        joined.sort_unstable();
        assert_eq!(joined, (0..10).collect::<Vec<u32>>());
        for (number, of) in [(0, 3), (4, 3), (1, 0)] {
            assert!(shard(vec![1, 2], number, of).is_empty(), "{number}/{of}");
        }
    }
}
