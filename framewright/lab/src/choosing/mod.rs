//! The best settings under a budget, of those that were measured.

mod candidates;
mod front;
mod limits;

pub use candidates::{Candidate, Candidates, Reason};
pub use front::front;
pub use limits::{Limit, Quantity};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// The answer.
#[derive(Debug)]
pub enum SettingsAnswer<'a> {
    /// Settings hold all limits.
    Best {
        /// The best of those.
        best: &'a Candidate,
        /// The limits that bind, alone or together.
        binding: Vec<Binding<'a>>,
        /// The better settings that miss the limits by least.
        next: Option<&'a Candidate>,
    },
    /// None does; these miss by least.
    Nearest(Option<&'a Candidate>),
}

/// Limits that together exclude better settings, which hold all other limits. No part of these limits does.
#[derive(Debug)]
pub struct Binding<'a> {
    /// Their numbers.
    pub limits: Vec<usize>,
    /// The settings that would be chosen without them.
    pub without: &'a Candidate,
}

impl Candidates {
    /// Chooses: with a limit of cost the least error, of equal ones the fastest, then the smallest; with limits of error alone
    /// the fastest, of equally fast ones the one of least error, then the smallest.
    #[must_use]
    pub fn choose(&self, limits: &[Limit]) -> SettingsAnswer<'_> {
        let by_error = limits.iter().any(|limit| limit.quantity.is_cost());
        let order = |a: &&Candidate, b: &&Candidate| a.compare(b, by_error);
        let holds_all = |candidate: &&Candidate| missed(candidate, limits).is_empty();
        // Settings of equal figures keep the order of their values.
        let Some(best) = self.all.iter().filter(holds_all).min_by(order) else {
            return SettingsAnswer::Nearest(nearest(self.all.iter(), limits, by_error));
        };
        let better: Vec<&Candidate> = self.all.iter().filter(|one| one.compare(best, by_error).is_lt()).collect();
        let next = nearest(better.iter().copied(), limits, by_error);
        SettingsAnswer::Best { best, binding: binding(&better, limits, order), next }
    }
}

/// The numbers of the limits that settings don't hold.
fn missed(candidate: &Candidate, limits: &[Limit]) -> Vec<usize> {
    let holds = |limit: &Limit| limit.overshoot(candidate) <= 0.0;
    limits.iter().enumerate().filter(|(_, limit)| !holds(limit)).map(|(at, _)| at).collect()
}

/// The smallest sets of limits that exclude better settings. Sets without other limits come first.
fn binding<'a>(
    better: &[&'a Candidate],
    limits: &[Limit],
    order: impl Fn(&&'a Candidate, &&'a Candidate) -> Ordering,
) -> Vec<Binding<'a>> {
    let mut by_missed: BTreeMap<(usize, Vec<usize>), Vec<&'a Candidate>> = BTreeMap::new();
    for candidate in better {
        let missed = missed(candidate, limits);
        by_missed.entry((missed.len(), missed)).or_default().push(candidate);
    }
    let mut found: Vec<Binding<'a>> = Vec::new();
    for ((_, limits), candidates) in by_missed {
        // Smaller sets came before.
        let is_least = !found.iter().any(|smaller| smaller.limits.iter().all(|limit| limits.contains(limit)));
        if let (true, Some(without)) = (is_least, candidates.into_iter().min_by(&order)) {
            found.push(Binding { limits, without });
        }
    }
    found
}

/// The candidate whose largest overshoot is least, of equal ones the best.
fn nearest<'a>(among: impl Iterator<Item = &'a Candidate>, limits: &[Limit], by_error: bool) -> Option<&'a Candidate> {
    let largest =
        |candidate: &Candidate| limits.iter().map(|limit| limit.overshoot(candidate)).fold(f64::NEG_INFINITY, f64::max);
    among.min_by(|a, b| {
        let overshoots = largest(a).partial_cmp(&largest(b)).unwrap_or(Ordering::Equal);
        overshoots.then_with(|| a.compare(b, by_error))
    })
}
