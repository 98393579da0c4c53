//! Checks all variants on several threads. The findings don't depend on the number of threads.

use super::axes;
use super::checker::{CheckedPipeline, VariantChecker, VerifiedPlan};
use super::decisions::SharedDecisions;
use super::identity::Identity;
use super::shaders::SharedShaders;
use super::space::Space;
use crate::system::counted_work::Progress;
use crate::system::interrupt;
use framewright_graph::base::{Diagnostic, Span};
use framewright_graph::plan::Totals;
use framewright_vulkan::ShaderLibrary;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Variants that a thread takes at a time, if there are many: those that differ only in their device stay together.
const LARGEST_BATCH: usize = 64;

/// Batches for each thread, if there are few variants: all threads end at about the same time.
const BATCHES: usize = 8;

/// The findings of a check.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    /// Variants that were judged.
    pub(crate) checked: usize,
    /// Judged variants that are wrong.
    pub(crate) failing: usize,
    /// Distinct Plans.
    pub(crate) plans: HashMap<Identity, DistinctPlan>,
    /// Distinct mistakes, by message and place.
    pub(crate) failures: HashMap<MistakeKey, Failure>,
}

/// Message and place of a mistake. Mistakes of several variants with the same key are one.
pub(crate) type MistakeKey = (String, Option<Span>);

/// A variant that stands for others: the one with the fewest departures from the defaults, of those the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Example {
    /// The number of axes on which the variant departs from the default.
    pub(crate) departures: usize,
    /// The number of the variant.
    pub(crate) number: usize,
}

/// A Plan that variants have in common.
#[derive(Debug)]
pub(crate) struct DistinctPlan {
    /// The number of these variants.
    pub(crate) variants: usize,
    /// One of these variants.
    pub(crate) example: Example,
    /// The Plan's sums.
    pub(crate) totals: Totals,
}

/// A mistake that variants have in common.
#[derive(Debug)]
pub(crate) struct Failure {
    /// The number of these variants.
    pub(crate) variants: usize,
    /// One of these variants.
    pub(crate) example: Example,
    /// The mistake in that one.
    pub(crate) diagnostic: Diagnostic,
    /// The devices with the mistake, by their numbers.
    pub(crate) devices: BTreeSet<usize>,
}

/// The key of a mistake.
#[must_use]
pub(crate) fn mistake_key(diagnostic: &Diagnostic) -> MistakeKey {
    (diagnostic.message.clone(), diagnostic.labels.first().map(|label| label.span))
}

/// Checks all variants of `space`, until the user asks to stop.
pub(crate) fn run(
    subject: &CheckedPipeline<'_>,
    space: &Space,
    library: &Mutex<ShaderLibrary>,
    decisions: &SharedDecisions,
    threads: usize,
    progress: &Progress,
) -> Findings {
    let batch = (space.len() / (threads * BATCHES)).clamp(1, LARGEST_BATCH);
    let next = AtomicUsize::new(0);
    let work = || {
        let mut checker = VariantChecker::new(subject, SharedShaders::new(library), decisions);
        let mut found = Findings::default();
        loop {
            let from = next.fetch_add(batch, Ordering::Relaxed);
            let to = (from + batch).min(space.len());
            if from >= to {
                return found;
            }
            for number in from..to {
                if interrupt::asked() {
                    return found;
                }
                let choice = space.choice(number);
                let departures = choice.iter().filter(|value| **value != 0).count();
                let verdict = checker.check(&choice);
                if interrupt::asked() {
                    // Its shaders may have been given up, which is no mistake of theirs.
                    return found;
                }
                found.add(Example { departures, number }, axes::device(&choice), verdict);
                progress.done_one();
            }
        }
    };
    std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads.min(space.len())).map(|_| scope.spawn(work)).collect();
        let mut found = work();
        for other in others {
            match other.join() {
                Ok(more) => found.merge(more),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        found
    })
}

impl Findings {
    fn add(&mut self, example: Example, device: usize, verdict: Result<VerifiedPlan, Vec<Diagnostic>>) {
        self.checked += 1;
        match verdict {
            Ok(VerifiedPlan { identity, totals }) => {
                let found = self.plans.entry(identity).or_insert(DistinctPlan { variants: 0, example, totals });
                found.variants += 1;
                found.example = found.example.min(example);
            }
            Err(diagnostics) => {
                self.failing += 1;
                let mut seen = HashSet::new();
                for diagnostic in diagnostics {
                    let key = mistake_key(&diagnostic);
                    if seen.insert(key.clone()) {
                        let devices = BTreeSet::from([device]);
                        self.failure(key, Failure { variants: 1, example, diagnostic, devices });
                    }
                }
            }
        }
    }

    fn failure(&mut self, key: MistakeKey, mut more: Failure) {
        match self.failures.get_mut(&key) {
            Some(found) => {
                if more.example < found.example {
                    std::mem::swap(found, &mut more);
                }
                found.variants += more.variants;
                found.devices.append(&mut more.devices);
            }
            None => {
                self.failures.insert(key, more);
            }
        }
    }

    fn merge(&mut self, other: Findings) {
        self.checked += other.checked;
        self.failing += other.failing;
        for (plan, more) in other.plans {
            let found = self.plans.entry(plan).or_insert(DistinctPlan { variants: 0, ..more });
            found.variants += more.variants;
            found.example = found.example.min(more.example);
        }
        for (key, failure) in other.failures {
            self.failure(key, failure);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::base::Code;

    #[test]
    fn what_stands_for_others_is_nearest_to_the_defaults_in_whichever_half_it_was_found() {
        let diagnostic = Diagnostic::nowhere(Code::OWN_MISTAKE, "wrong");
        let identity = Identity { plan: 7, shape: 1 };
        let fine = VerifiedPlan { identity, totals: Totals::default() };
        let numbers = [(2, 1), (1, 5), (1, 7), (3, 0)];
        for split in 0..=numbers.len() {
            for turned in 0..numbers.len() {
                let mut halves = [Findings::default(), Findings::default()];
                for at in 0..numbers.len() {
                    let (departures, number) = numbers[(at + turned) % numbers.len()];
                    let (found, example) = (&mut halves[usize::from(at < split)], Example { departures, number });
                    found.add(example, number % 2, Err(vec![diagnostic.clone(), diagnostic.clone()]));
                    found.add(example, 0, Ok(fine));
                }
                let [mut found, other] = halves;
                found.merge(other);
                assert_eq!((found.checked, found.failing), (8, 4));
                let least = Example { departures: 1, number: 5 };
                let failure = &found.failures[&mistake_key(&diagnostic)];
                assert_eq!((failure.example, failure.variants), (least, 4));
                assert_eq!(failure.devices, BTreeSet::from([0, 1]));
                assert_eq!((found.plans[&identity].example, found.plans[&identity].variants), (least, 4));
            }
        }
    }
}
