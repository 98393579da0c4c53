//! Sweeps: the values that settings take, and the choices that they make together.

use crate::variants::cover;
use std::collections::BTreeMap;

/// A sweep makes at most this many choices.
pub(crate) const MOST_CHOICES: usize = 10_000;
/// A range has at most this many values.
const MOST_STEPS: u32 = 1_000;

/// The values that one setting takes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sweep {
    /// The setting; or `@size`, `@scene` or `@stereo`.
    pub(crate) name: String,
    /// As the command line has them.
    pub(crate) values: Vec<String>,
}

/// How several sweeps make choices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Combined {
    /// Every value with every other.
    All,
    /// Each pair of values of any two settings occurs.
    Pairwise,
    /// One setting at a time.
    OneByOne,
}

/// Reads `NAME=A,B,C` or `NAME=LO..HI:STEPS`.
///
/// # Errors
/// The form that was expected.
pub(crate) fn sweep(text: &str) -> Result<Sweep, String> {
    const FORM: &str = "expected NAME=A,B,C or NAME=LO..HI:STEPS, such as msaa=1,4 or render_scale=0.5..2:4";
    let (name, values) = text.split_once('=').filter(|(name, _)| !name.is_empty()).ok_or(FORM)?;
    let values = match values.split_once("..") {
        Some((low, rest)) => {
            let (high, steps) = rest.split_once(':').ok_or(FORM)?;
            range(low, high, steps)?
        }
        None => values.split(',').map(str::to_owned).collect(),
    };
    if values.iter().any(String::is_empty) {
        return Err(FORM.to_owned());
    }
    match (1..values.len()).find(|at| values[..*at].contains(&values[*at])) {
        Some(twice) => Err(format!("`{}` stands there twice", crate::system::text::escape(&values[twice]))),
        None => Ok(Sweep { name: name.to_owned(), values }),
    }
}

/// So many values from the one to the other, both among them.
fn range(low: &str, high: &str, steps: &str) -> Result<Vec<String>, String> {
    let number = |text: &str| text.parse::<f64>().ok().filter(|number| number.is_finite());
    let (Some(low), Some(high)) = (number(low), number(high)) else {
        return Err("a range goes from one number to another, such as 0.5..2:4".to_owned());
    };
    let steps = steps.parse::<u32>().ok().filter(|steps| (2..=MOST_STEPS).contains(steps));
    let steps = steps.ok_or_else(|| format!("a range has 2 to {MOST_STEPS} values, such as 0.5..2:4"))?;
    if low >= high {
        return Err(format!("the range goes backwards: {low} is not below {high}"));
    }
    let value = |at: u32| low + (high - low) * f64::from(at) / f64::from(steps - 1);
    Ok((0..steps).map(|at| value(at).to_string()).collect())
}

/// The number of choices that sweeps make, even where there are too many to make.
#[must_use]
pub(crate) fn count(sweeps: &[Sweep], combined: Combined) -> u128 {
    let sizes = sweeps.iter().map(|sweep| sweep.values.len() as u128);
    match combined {
        Combined::OneByOne => sizes.sum::<u128>() + 1,
        // At most: a pair of values in each.
        Combined::Pairwise => cover::pairs(&sweeps.iter().map(|sweep| sweep.values.len()).collect::<Vec<_>>()) as u128,
        Combined::All => sizes.fold(1, u128::saturating_mul),
    }
}

/// The choices that sweeps make, each once: values by name. The last sweep varies fastest.
#[must_use]
pub(crate) fn choices(sweeps: &[Sweep], combined: Combined) -> Vec<BTreeMap<String, String>> {
    let chosen = |row: &[usize]| -> BTreeMap<String, String> {
        sweeps.iter().zip(row).map(|(sweep, at)| (sweep.name.clone(), sweep.values[*at].clone())).collect()
    };
    match combined {
        Combined::OneByOne => {
            let one = |sweep: &Sweep, value: &String| BTreeMap::from([(sweep.name.clone(), value.clone())]);
            let each = sweeps.iter().flat_map(|sweep| sweep.values.iter().map(move |value| one(sweep, value)));
            std::iter::once(BTreeMap::new()).chain(each).collect()
        }
        Combined::Pairwise if sweeps.len() > 1 => {
            let sizes: Vec<usize> = sweeps.iter().map(|sweep| sweep.values.len()).collect();
            cover::rows(&sizes).iter().map(|row| chosen(row)).collect()
        }
        Combined::All | Combined::Pairwise => {
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
    }
}

/// The part `number` of `of` parts of a list, numbered from 1. All parts together are the list.
pub(crate) fn shard<T>(list: Vec<T>, number: usize, of: usize) -> Vec<T> {
    list.into_iter().skip(number - 1).step_by(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_listed_or_a_range() {
        let values = |text: &str| sweep(text).map(|sweep| sweep.values);
        assert_eq!(values("msaa=1,4"), Ok(vec!["1".to_owned(), "4".to_owned()]));
        assert_eq!(values("s=0.5..2:4").expect("a range"), ["0.5", "1", "1.5", "2"]);
        for wrong in ["msaa", "=1", "msaa=", "msaa=1,,2", "s=1..2", "s=1..2:1", "s=2..1:3", "s=a..b:3", "s=0..1:1001"] {
            assert!(sweep(wrong).is_err(), "{wrong}");
        }
        assert_eq!(sweep("s=2..1:3"), Err("the range goes backwards: 2 is not below 1".to_owned()));
        assert_eq!(sweep("s=1,2,1"), Err("`1` stands there twice".to_owned()));
    }

    #[test]
    fn choices_are_all_products_or_enough_for_pairs_or_one_by_one() {
        let sweeps = ["a=1,2,3", "b=x,y", "c=p,q"].map(|text| sweep(text).expect("a sweep"));
        let all = choices(&sweeps, Combined::All);
        assert_eq!((all.len() as u128, count(&sweeps, Combined::All)), (12, 12));
        assert_eq!(all[1]["c"], "q");
        let pairs = choices(&sweeps, Combined::Pairwise);
        assert!(
            pairs.len() < 12
                && all
                    .iter()
                    .flat_map(|row| row.iter().zip(row.iter().skip(1)))
                    .all(|(one, other)| { pairs.iter().any(|row| row[one.0] == *one.1 && row[other.0] == *other.1) })
        );
        assert_eq!(choices(&sweeps, Combined::OneByOne).len(), 8);
        assert_eq!(choices(&sweeps[..1], Combined::Pairwise).len(), 3);
        assert_eq!(choices(&[], Combined::All), [BTreeMap::new()]);
    }

    #[test]
    fn shards_together_are_the_list() {
        let mut joined: Vec<u32> = (1..=3).flat_map(|number| shard((0..10).collect(), number, 3)).collect();
        joined.sort_unstable();
        assert_eq!(joined, (0..10).collect::<Vec<u32>>());
    }
}
