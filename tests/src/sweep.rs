//! Sweeps over more cases than a person waits for. With `FRAMEWRIGHT_LONG` set, as `./test --long` does, every case is tested.
//! Otherwise a sample is, chosen by the number in `FRAMEWRIGHT_SEED`, or by 1, and by the name of the sweep: sweeps of equally
//! many cases test different places of their lists.

use std::ffi::OsStr;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;

/// Whether every case is to be tested.
#[must_use]
pub fn is_long() -> bool {
    asks(std::env::var_os("FRAMEWRIGHT_LONG").as_deref())
}

/// Whether a variable asks for something: one that is set, and not empty, as in the script `test`.
fn asks(variable: Option<&OsStr>) -> bool {
    variable.is_some_and(|value| !value.is_empty())
}

/// All of these cases, or `few` of them in their order. `name` tells this sweep from others.
#[must_use]
pub fn of<T>(name: &str, cases: Vec<T>, few: usize) -> Vec<T> {
    let count = cases.len();
    if is_long() || few >= count {
        return cases;
    }
    let chosen = sample(count, few, seed(name, few as u64, count as u64));
    cases.into_iter().enumerate().filter(|(at, _)| chosen.binary_search(at).is_ok()).map(|(_, case)| case).collect()
}

/// All of these numbers, or `few` of them that follow each other. `name` tells this sweep from others.
#[must_use]
pub fn row(name: &str, all: Range<u64>, few: u64) -> Range<u64> {
    let count = all.end - all.start;
    if is_long() || few >= count {
        return all;
    }
    part(all, few, seed(name, few, count))
}

/// The number that chooses the cases of a sweep. Tests that fail show what is printed here: how to test the same cases again.
fn seed(name: &str, few: u64, count: u64) -> u64 {
    let seed = std::env::var("FRAMEWRIGHT_SEED").ok().filter(|seed| !seed.is_empty());
    let seed = seed.map_or(1, |seed| seed.parse().expect("FRAMEWRIGHT_SEED is a whole number"));
    println!(
        "{few} of {count} cases of {name}: set FRAMEWRIGHT_SEED={seed} to test them again, FRAMEWRIGHT_LONG=1 to test all"
    );
    of_name(seed, name)
}

/// The seed of one sweep.
fn of_name(seed: u64, name: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    (seed, name).hash(&mut hasher);
    hasher.finish()
}

/// `few` of the numbers below `count`, in rising order: those whose places a seed mixes to the least values.
fn sample(count: usize, few: usize, seed: u64) -> Vec<usize> {
    let mut places: Vec<usize> = (0..count).collect();
    places.sort_by_key(|at| mixed(mixed(seed) ^ *at as u64));
    places.truncate(few);
    places.sort_unstable();
    places
}

/// `few` numbers of a longer row, from a place that a seed chooses.
const fn part(all: Range<u64>, few: u64, seed: u64) -> Range<u64> {
    let first = all.start + mixed(seed) % (all.end - all.start - few + 1);
    first..first + few
}

/// SplitMix64's mixing of a number.
const fn mixed(number: u64) -> u64 {
    let number = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let number = (number ^ (number >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let number = (number ^ (number >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    number ^ (number >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_seed_always_chooses_the_same_cases_and_another_one_others() {
        let samples: BTreeSet<_> = (0..50).map(|seed| sample(1000, 10, seed)).collect();
        assert_eq!(samples.len(), 50);
        assert_eq!(sample(1000, 10, 7), sample(1000, 10, 7));
    }

    #[test]
    fn sweeps_of_equally_many_cases_test_different_ones() {
        let names = ["scales", "eyes", "profiles", "settings"];
        let samples: BTreeSet<_> = names.iter().map(|name| sample(1000, 10, of_name(1, name))).collect();
        assert_eq!(samples.len(), names.len());
        let rows: BTreeSet<_> = names.iter().map(|name| part(0..1000, 10, of_name(1, name)).start).collect();
        assert_eq!(rows.len(), names.len());
        assert_ne!(of_name(1, "eyes"), of_name(2, "eyes"));
    }

    #[test]
    fn an_empty_variable_asks_for_nothing() {
        assert_eq!([None, Some(""), Some("1")].map(|value| asks(value.map(OsStr::new))), [false, false, true]);
    }

    #[test]
    fn samples_hold_as_many_cases_as_were_asked_for_each_once_in_order() {
        for (count, few) in [(1000, 10), (10, 10), (3, 1), (5, 0), (0, 0)] {
            let sample = sample(count, few, 3);
            assert_eq!(sample.len(), few);
            assert!(sample.is_sorted_by(|a, b| a < b) && sample.iter().all(|at| *at < count), "{sample:?}");
        }
    }

    #[test]
    fn every_case_is_chosen_by_some_seed() {
        let all: BTreeSet<usize> = (0..200).flat_map(|seed| sample(40, 4, seed)).collect();
        assert_eq!(all, (0..40).collect());
    }

    #[test]
    fn every_number_of_a_row_is_in_the_part_that_some_seed_chooses_and_no_other() {
        let all: BTreeSet<u64> = (0..200).flat_map(|seed| part(10..30, 4, seed)).collect();
        assert_eq!(all, (10..30).collect());
        assert_eq!(part(10..30, 4, 7).count(), 4);
        assert_eq!(part(10..30, 4, 7), part(10..30, 4, 7));
    }
}
