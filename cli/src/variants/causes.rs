//! The cause of each mistake: the fewest departures from the defaults that bring it about.

use super::checker::VariantChecker;
use super::minimise::minimise;
use super::run::{Failure, MistakeKey, mistake_key};
use super::space::{Choice, Space};
use crate::system::interrupt;
use framewright_graph::base::Diagnostic;
use std::collections::HashMap;

/// Causes of at most this many mistakes are looked for.
pub(crate) const MOST_CAUSES: usize = 100;

/// A mistake and its cause.
#[derive(Debug)]
pub(crate) struct Cause {
    /// The mistake.
    pub(crate) diagnostic: Diagnostic,
    /// Variants that have it.
    pub(crate) variants: usize,
    /// Devices on which it was found, by their numbers.
    pub(crate) devices: Vec<usize>,
    /// A variant that has it.
    pub(crate) choice: Choice,
    /// Whether every departure from the defaults in that variant is known to be needed.
    pub(crate) least: bool,
}

/// Finds the causes of the [`MOST_CAUSES`] mistakes that most variants have.
pub(crate) fn find(
    failures: HashMap<MistakeKey, Failure>,
    space: &Space,
    checker: &mut VariantChecker<'_>,
) -> Vec<Cause> {
    let mut failures: Vec<(MistakeKey, Failure)> = failures.into_iter().collect();
    failures.sort_by(|(key, one), (other_key, other)| {
        let places = |key: &MistakeKey| key.1.map(|span| (span.file(), span.start, span.end));
        let first = other.variants.cmp(&one.variants).then(one.example.cmp(&other.example));
        first.then_with(|| places(key).cmp(&places(other_key))).then_with(|| key.0.cmp(&other_key.0))
    });
    failures.truncate(MOST_CAUSES);
    failures.into_iter().map(|(key, failure)| cause(&key, failure, space, checker)).collect()
}

fn cause(key: &MistakeKey, failure: Failure, space: &Space, checker: &mut VariantChecker<'_>) -> Cause {
    let Failure { variants, example, mut diagnostic, devices } = failure;
    let found = space.choice(example.number);
    let departures: Vec<(usize, usize)> = found.iter().copied().enumerate().filter(|(_, value)| *value != 0).collect();
    let with = |some: &[(usize, usize)]| {
        let mut choice = vec![0; found.len()];
        some.iter().for_each(|(axis, value)| choice[*axis] = *value);
        choice
    };
    let mut interrupted = interrupt::asked();
    let needed = minimise(&departures, &mut |some| {
        interrupted |= interrupt::asked();
        if interrupted {
            return false;
        }
        let found = checker.check(&with(some)).err().into_iter().flatten().find(|found| mistake_key(found) == *key);
        interrupted |= interrupt::asked();
        let fails = found.is_some();
        // The search shrinks the set: the last one that fails is the smallest.
        found.into_iter().for_each(|found| diagnostic = found);
        fails
    });
    Cause { diagnostic, variants, devices: devices.into_iter().collect(), choice: with(&needed), least: !interrupted }
}
