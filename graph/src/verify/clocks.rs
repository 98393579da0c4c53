//! What is ordered after what, as clocks: constant work a barrier, constant work a question.
//!
//! A *time* numbers a step in the walk. For each stage `q` the clock row says how far back work in `q` that starts now
//! is ordered: everything in stage `s` at times below `ordered[s]`. A barrier from stages S to stages D joins the rows of S
//! (its source scope, and all that an execution dependency chain through S brings along), sets its own stages to now, and
//! raises the rows of D to that. Chains need no search: they are what joining rows means.
//!
//! Availability and visibility by *memory barriers*, which cover everything, are clocks of the same kind. Those by image
//! barriers, which cover one image, are kept with that image: see [`super::cells`].

use super::scopes::{PAIRS, PairSet, STAGES, StageSet, WRITE_PAIRS};

/// Number of a step in the walk; 0 is before everything.
pub(super) type Time = u32;

/// Rounded up, so that rows are joined by whole vector instructions.
const LANES: usize = 16;
const _: () = assert!(STAGES <= LANES && WRITE_PAIRS <= LANES);

/// How far back something is ordered.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Clock {
    ordered: [Time; LANES],
    available: [Time; LANES],
}

/// What a write became available by: an image barrier, or a layout change, which makes itself available.
#[derive(Debug, Clone, Copy)]
pub(super) struct Availability {
    /// When.
    pub(super) time: Time,
    /// Stages that wait for it.
    pub(super) stages: StageSet,
}

impl Clock {
    fn join(&mut self, other: &Clock) {
        raise(&mut self.ordered, &other.ordered);
        raise(&mut self.available, &other.available);
    }

    /// Whether work in `stage` at `time` comes before.
    pub(super) fn is_after(&self, stage: usize, time: Time) -> bool {
        self.ordered[stage] > time
    }

    /// Whether the write `pair` at `time` was made available by a memory barrier that comes before.
    pub(super) fn has_available(&self, pair: usize, time: Time) -> bool {
        self.available[pair] > time
    }

    /// Whether an image barrier comes before.
    pub(super) fn is_after_barrier(&self, barrier: Availability) -> bool {
        barrier.stages.iter().any(|stage| self.ordered[stage] > barrier.time)
    }

    /// A memory barrier with this as its source makes the writes `pairs` available.
    pub(super) fn make_available(&mut self, pairs: PairSet, now: Time) {
        pairs.writes().iter().for_each(|pair| self.available[pair] = now);
    }
}

/// The clocks of all stages, and of all that memory barriers have made visible.
#[derive(Debug, Default)]
pub(super) struct Clocks {
    stages: [Clock; STAGES],
    /// For each pair: which writes memory barriers have made visible to it.
    visible: [[Time; LANES]; PAIRS],
    /// For each pair: which image barriers come before a memory barrier that made things visible to it.
    through: [[Time; LANES]; PAIRS],
}

impl Clocks {
    /// What comes before a barrier at `now` whose source stages, earlier ones included, are `source`.
    pub(super) fn before(&self, source: StageSet, now: Time) -> Clock {
        let mut joined = Clock::default();
        for stage in source.iter() {
            joined.join(&self.stages[stage]);
        }
        source.iter().for_each(|stage| joined.ordered[stage] = now);
        joined
    }

    /// Work in `stages`, later ones included, waits for `before` from now on.
    pub(super) fn hold_up(&mut self, stages: StageSet, before: &Clock) {
        stages.iter().for_each(|stage| self.stages[stage].join(before));
    }

    /// A memory barrier with `before` as its source makes what is available visible to `pairs`.
    pub(super) fn show(&mut self, pairs: PairSet, before: &Clock) {
        for pair in pairs.iter() {
            raise(&mut self.visible[pair], &before.available);
            raise(&mut self.through[pair], &before.ordered);
        }
    }

    /// Whether work in `stage` now comes after work in `earlier` at `time`.
    pub(super) fn is_after(&self, stage: usize, earlier: usize, time: Time) -> bool {
        self.stages[stage].is_after(earlier, time)
    }

    /// Whether work in `stage` now comes after an image barrier.
    pub(super) fn is_after_barrier(&self, stage: usize, barrier: Availability) -> bool {
        barrier.stages.contains(stage) || self.stages[stage].is_after_barrier(barrier)
    }

    /// Whether a memory barrier that work in `stage` now comes after made the write `write` at `time` available.
    pub(super) fn has_available(&self, stage: usize, write: usize, time: Time) -> bool {
        self.stages[stage].has_available(write, time)
    }

    /// Whether memory barriers alone have made the write `write` at `time` visible to `pair`.
    pub(super) fn is_visible(&self, pair: usize, write: usize, time: Time) -> bool {
        self.visible[pair][write] > time
    }

    /// Whether a memory barrier after this image barrier has made what it made available visible to `pair`.
    pub(super) fn is_visible_through(&self, pair: usize, barrier: Availability) -> bool {
        barrier.stages.iter().any(|stage| self.through[pair][stage] > barrier.time)
    }
}

fn raise(times: &mut [Time; LANES], to: &[Time; LANES]) {
    for (time, other) in times.iter_mut().zip(to) {
        *time = (*time).max(*other);
    }
}
