//! The decisions that sizes in bytes made about an order, so that they can be tested against other sizes.

use super::memory::{Lifetimes, Memory};
use crate::compile::model::PhysicalIndex;
use std::cmp::Ordering;

/// The comparisons of bytes that led to an order, in the sequence in which they were made; none if bytes decided nothing.
///
/// Each result decides the next comparison. So if all results stay the same, so do the comparisons.
#[derive(Debug, Default)]
pub(super) struct Weighed {
    runs: Vec<Run>,
    resources: Vec<Weight>,
    peaks: Option<Peaks>,
}

/// The decision about one run.
#[derive(Debug, Clone, Copy)]
struct Run {
    /// Where its part of the list of resources ends.
    end: u32,
    may_rise: bool,
    decision: Decision,
}

/// A resource that a run uses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weight {
    pub(super) resource: PhysicalIndex,
    /// Whether the run begins it.
    pub(super) begun: bool,
    /// Whether the run ends it where it is.
    pub(super) ended: bool,
    /// Whether the run would hold it alive where it could rise to.
    pub(super) held: bool,
}

/// Bytes of the resources that a run uses.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    begun: u64,
    ended: u64,
    held: u64,
}

/// The place of a run, as far as sizes decide it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Decision {
    /// Whether it moves up to the last level that it may stand in.
    pub(super) rises: bool,
    /// Whether it begins fewer bytes than it ends, or more.
    pub(super) begins: Ordering,
}

/// The choice between the file's order and that by levels.
#[derive(Debug)]
struct Peaks {
    file: Lifetimes,
    levels: Lifetimes,
    takes_levels: bool,
}

impl Sums {
    /// Adds a resource that begins or ends here; any other adds nothing.
    #[inline]
    pub(super) fn add(&mut self, bytes: u64, begun: bool, ended: bool) {
        let of = |counts: bool| if counts { bytes } else { 0 };
        self.begun = self.begun.saturating_add(of(begun));
        self.ended = self.ended.saturating_add(of(ended));
    }

    /// Adds a resource that it would hold alive where it could rise to.
    #[inline]
    pub(super) fn hold(&mut self, bytes: u64) {
        self.held = self.held.saturating_add(bytes);
    }

    /// Whether what it would hold decides anything: whether it may rise, and begins any bytes.
    #[inline]
    pub(super) fn may_rise(&self, may_rise: bool) -> bool {
        may_rise && self.begun > 0
    }

    #[inline]
    pub(super) fn decide(self, may_rise: bool) -> Decision {
        let rises = may_rise && self.begun > self.held;
        Decision { rises, begins: self.begun.cmp(if rises { &self.held } else { &self.ended }) }
    }
}

/// Whether the order by levels is taken: if it keeps at most a fiftieth more alive than the file's.
pub(super) fn takes_levels(memory: &Memory, file: &Lifetimes, levels: &Lifetimes) -> bool {
    let peak = memory.peak(file);
    memory.peak(levels) <= peak.saturating_add(peak / 50)
}

impl Weighed {
    /// Notes a resource that the current run uses.
    pub(super) fn weigh(&mut self, weight: Weight) {
        self.resources.push(weight);
    }

    /// Notes the decision about the current run.
    pub(super) fn decided(&mut self, may_rise: bool, decision: Decision) {
        self.runs.push(Run { end: self.resources.len() as u32, may_rise, decision });
    }

    /// Notes which of both orders was taken.
    pub(super) fn took(&mut self, file: Lifetimes, levels: Lifetimes, takes_levels: bool) {
        self.peaks = Some(Peaks { file, levels, takes_levels });
    }

    /// Whether the sizes of `memory` lead to the same decisions.
    pub(super) fn decide_the_same(&self, memory: impl FnOnce() -> Memory) -> bool {
        if self.runs.is_empty() {
            return true;
        }
        let memory = &memory();
        let mut start = 0;
        let same_runs = self.runs.iter().all(|run| {
            let mut sums = Sums::default();
            for Weight { resource, begun, ended, held } in &self.resources[start..run.end as usize] {
                let bytes = memory.bytes(*resource);
                sums.add(bytes, *begun, *ended);
                if *held {
                    sums.hold(bytes);
                }
            }
            start = run.end as usize;
            sums.decide(run.may_rise) == run.decision
        });
        let same_choice = |peaks: &Peaks| takes_levels(memory, &peaks.file, &peaks.levels) == peaks.takes_levels;
        same_runs && self.peaks.as_ref().is_none_or(same_choice)
    }
}
