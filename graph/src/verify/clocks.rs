//! The order of steps as clocks: constant work for each barrier, constant work for each question.
//!
//! A *time* numbers a step in the walk. For each stage `q` of a queue the clock row says how far back work in `q` that
//! starts now is ordered: everything in stage `s` of some queue at times below its lane. A barrier from stages S
//! to stages D joins the rows of S (its source scope, and all that an execution dependency chain through S brings along),
//! sets its own stages to now, and raises the rows of D to that. Chains need no search: they are what joining rows means.
//! A semaphore is a barrier from everything on one queue to everything on another.
//!
//! Availability and visibility by *memory barriers* and semaphores, which cover everything, are clocks of the same kind.
//! Those by image barriers, which cover one image, are kept with that image: see [`super::subresources`].
//!
//! `Q` is the number of queues: a Plan on one queue pays for one.

use super::scopes::{PAIRS, PairSet, STAGES, StageSet, WRITE_PAIRS};

/// Number of a step in the walk; 0 is before everything.
pub(super) type Time = u32;

/// A time for each stage, and then for each pair that writes: whole vector instructions join two rows.
const LANES: usize = (STAGES + WRITE_PAIRS).next_multiple_of(4);

/// How far back something is ordered: everything in a stage at times below its lane, and of each pair that writes everything
/// made available below its lane; for each queue.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clock<const Q: usize> {
    times: [[Time; LANES]; Q],
}

/// The event that made a write available: an image barrier, or a layout change, which makes itself available.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Availability {
    /// The time of the event.
    pub(super) time: Time,
    /// Stages that wait for the event.
    pub(super) stages: StageSet,
    /// The queue that the event ran on.
    pub(super) queue: u8,
}

impl<const Q: usize> Clock<Q> {
    pub(super) const START: Clock<Q> = Clock { times: [[0; LANES]; Q] };

    pub(super) fn join(&mut self, other: &Clock<Q>) {
        for (times, others) in self.times.iter_mut().zip(&other.times) {
            for (time, other) in times.iter_mut().zip(others) {
                *time = (*time).max(*other);
            }
        }
    }

    /// Whether work in `stage` of `queue` at `time` comes before.
    pub(super) fn is_after(&self, queue: u8, stage: usize, time: Time) -> bool {
        self.times[usize::from(queue)][stage] > time
    }

    /// Whether the write `pair` of `queue` at `time` was made available, by more than an image barrier, before.
    pub(super) fn has_available(&self, queue: u8, pair: usize, time: Time) -> bool {
        self.times[usize::from(queue)][STAGES + pair] > time
    }

    /// Whether an image barrier comes before.
    pub(super) fn is_after_barrier(&self, barrier: &Availability) -> bool {
        let times = &self.times[usize::from(barrier.queue)];
        barrier.stages.iter().any(|stage| times[stage] > barrier.time)
    }

    /// A memory barrier on `queue` with this as its source makes the writes `pairs` available.
    pub(super) fn make_available(&mut self, queue: u8, pairs: PairSet, now: Time) {
        let times = &mut self.times[usize::from(queue)][STAGES..];
        pairs.writes().iter().for_each(|pair| times[pair] = now);
    }
}

/// The clocks of all stages, and of all that memory barriers and semaphores have made visible.
#[derive(Debug)]
pub(super) struct Clocks<const Q: usize> {
    stages: [[Clock<Q>; STAGES]; Q],
    /// For each pair of each queue: all that comes before the barriers that made writes visible to it, so which image
    /// barriers do, and which writes they found available.
    shown: [[Clock<Q>; PAIRS]; Q],
}

impl<const Q: usize> Clocks<Q> {
    pub(super) fn new() -> Clocks<Q> {
        Clocks { stages: [[Clock::START; STAGES]; Q], shown: [[Clock::START; PAIRS]; Q] }
    }

    /// The clock of all that comes before a barrier on `queue` at `now` with the source stages `source`, earlier ones included.
    pub(super) fn before(&self, queue: u8, source: StageSet, now: Time) -> Clock<Q> {
        let queue = usize::from(queue);
        let mut stages = source.iter();
        let mut joined = stages.next().map_or(Clock::START, |first| self.stages[queue][first]);
        stages.for_each(|stage| joined.join(&self.stages[queue][stage]));
        source.iter().for_each(|stage| joined.times[queue][stage] = now);
        joined
    }

    /// The clock of a wait for all that `queue` was given before `now`: all of it, made available.
    pub(super) fn signal(&self, queue: u8, now: Time) -> Clock<Q> {
        let mut joined = self.before(queue, StageSet::ALL, now);
        joined.times[usize::from(queue)][STAGES..].fill(now);
        joined
    }

    /// The clock of all that comes before the end of `stages`, on every queue.
    pub(super) fn after_all_queues(&self, stages: StageSet, now: Time) -> Clock<Q> {
        let mut joined = Clock::START;
        for queue in 0..Q as u8 {
            joined.join(&self.before(queue, stages, now));
        }
        joined
    }

    /// Work in `stages` of `queue`, later ones included, waits for `before` from now on.
    pub(super) fn hold_up(&mut self, queue: u8, stages: StageSet, before: &Clock<Q>) {
        stages.iter().for_each(|stage| self.stages[usize::from(queue)][stage].join(before));
    }

    /// Makes the writes that are available in `before` visible to `pairs` of `queue`.
    pub(super) fn show(&mut self, queue: u8, pairs: PairSet, before: &Clock<Q>) {
        pairs.iter().for_each(|pair| self.shown[usize::from(queue)][pair].join(before));
    }

    /// The clock of work in `stage` of `queue` that starts now.
    pub(super) fn of(&self, queue: u8, stage: usize) -> &Clock<Q> {
        &self.stages[usize::from(queue)][stage]
    }

    /// Whether work in `stage` of `queue` now comes after an image barrier.
    pub(super) fn is_after_barrier(&self, queue: u8, stage: usize, barrier: &Availability) -> bool {
        barrier.queue == queue && barrier.stages.contains(stage) || self.of(queue, stage).is_after_barrier(barrier)
    }

    /// Whether the write `write` of the queue `by` at `time` is visible to `pair` of `queue` without an image barrier.
    pub(super) fn is_visible(&self, queue: u8, pair: usize, by: u8, write: usize, time: Time) -> bool {
        self.shown[usize::from(queue)][pair].has_available(by, write, time)
    }

    /// Whether writes that this image barrier made available were made visible to `pair` of `queue` after it.
    pub(super) fn is_visible_through(&self, queue: u8, pair: usize, barrier: &Availability) -> bool {
        self.shown[usize::from(queue)][pair].is_after_barrier(barrier)
    }
}
