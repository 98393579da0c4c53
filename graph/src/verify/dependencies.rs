//! Whether an access or a barrier comes after the accesses that it conflicts with, and with which memory dependency.
//!
//! - A read needs the last write made visible to its own stage and access.
//! - A write needs the last write made visible, too: Vulkan asks for a memory dependency between two writes, and its second
//!   scope must name the second write. Reads since then must have been waited for; that takes no memory dependency.
//! - A layout change is a write. It needs the last write available, and reads waited for; it is then available itself and
//!   visible to the second scope of its barrier.
//!
//! Execution dependencies are global, for every kind of barrier and for semaphores. Memory dependencies of an image barrier
//! cover the barrier's own range, those of memory barriers and semaphores everything.

use super::clocks::{Clock, Clocks, Time};
use super::scopes::{PairSet, StageSet, stage_of, stage_word, words};
use super::subresources::{SubresourceState, Write};
use super::violation::{Accessed, Rule};

/// A dependency that is missing between an earlier access and a later one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gap {
    /// When the earlier one happened.
    pub(super) time: Time,
    pub(super) earlier: Accessed,
    pub(super) later: Accessed,
    pub(super) missing: MissingPart,
}

/// The part of a dependency that is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MissingPart {
    Execution,
    Availability,
    Visibility,
}

impl Gap {
    pub(super) fn rule(self) -> Rule {
        let Gap { earlier, later, .. } = self;
        match self.missing {
            MissingPart::Execution => Rule::Execution { earlier, later },
            MissingPart::Availability => Rule::Availability { earlier, later },
            MissingPart::Visibility => Rule::Visibility { earlier, later },
        }
    }
}

/// The dependency that is missing before an access in `stages` of `queue` by `pairs`.
#[inline]
pub(super) fn before_access<const Q: usize>(
    state: &SubresourceState<Q>,
    clocks: &Clocks<Q>,
    queue: u8,
    stages: StageSet,
    pairs: PairSet,
) -> Option<Gap> {
    if state.write.exists()
        && !state.write.is_layout_change_for(queue, stages, pairs)
        && let Some(gap) = after_write(&state.write, clocks, queue, stages, pairs)
    {
        return Some(gap);
    }
    if pairs.writes().is_empty() || state.reads.is_empty() { None } else { after_reads(state, clocks, queue, pairs) }
}

fn after_reads<const Q: usize>(
    state: &SubresourceState<Q>,
    clocks: &Clocks<Q>,
    queue: u8,
    pairs: PairSet,
) -> Option<Gap> {
    let writes = pairs.writes();
    state.reads.iter().find_map(|read| {
        let early = |pair: &usize| !clocks.of(queue, stage_of(*pair)).is_after(read.queue, read.stage, read.time);
        let later = by(writes.iter().find(early)?);
        Some(Gap {
            time: read.time,
            earlier: Accessed::Read(stage_word(read.stage)),
            later,
            missing: MissingPart::Execution,
        })
    })
}

#[inline(never)]
fn after_write<const Q: usize>(
    write: &Write,
    clocks: &Clocks<Q>,
    queue: u8,
    stages: StageSet,
    pairs: PairSet,
) -> Option<Gap> {
    if let Some(stage) = stages.iter().find(|stage| !is_after_write(clocks, queue, *stage, write)) {
        let pair = pairs.iter().find(|pair| stage_of(*pair) == stage);
        let missed =
            write.pairs.iter().find(|pair| !clocks.of(queue, stage).is_after(write.queue, stage_of(*pair), write.time));
        let later = pair.map_or(Accessed::Wait(stage_word(stage)), by);
        let earlier = missed.map_or(Accessed::LayoutChange, by);
        return Some(Gap { time: write.time, earlier, later, missing: MissingPart::Execution });
    }
    if write.is_shown(queue, pairs) {
        return None;
    }
    let hidden = pairs.iter().find(|pair| !is_visible(clocks, queue, *pair, write))?;
    let available = stages.iter().all(|stage| is_available(clocks, queue, stage, write));
    let missing = if available { MissingPart::Visibility } else { MissingPart::Availability };
    let dark = write.pairs.iter().find(|pair| !clocks.is_visible(queue, hidden, write.queue, *pair, write.time));
    Some(Gap { time: write.time, earlier: dark.map_or(Accessed::LayoutChange, by), later: by(hidden), missing })
}

/// The dependency that is missing before a layout change, or before the memory is given away, by a barrier that comes
/// after `before` and makes the writes `source` available itself.
pub(super) fn before_layout_change<const Q: usize>(
    state: &SubresourceState<Q>,
    before: &Clock<Q>,
    source: PairSet,
) -> Option<Gap> {
    let gap = |time, earlier, missing| Gap { time, earlier, later: Accessed::LayoutChange, missing };
    if let Some(read) = state.reads.iter().find(|read| !before.is_after(read.queue, read.stage, read.time)) {
        return Some(gap(read.time, Accessed::Read(stage_word(read.stage)), MissingPart::Execution));
    }
    let write = &state.write;
    if !write.exists() || makes_available(write, before, source) {
        return None;
    }
    let late = |pair: &usize| !before.is_after(write.queue, stage_of(*pair), write.time);
    if let Some(pair) = write.pairs.iter().find(late) {
        return Some(gap(write.time, by(pair), MissingPart::Execution));
    }
    let left = |pair: &usize| !source.contains(*pair) && !before.has_available(write.queue, *pair, write.time);
    let (earlier, missing) = match write.pairs.iter().find(left) {
        Some(pair) => (by(pair), MissingPart::Availability),
        None => (Accessed::LayoutChange, MissingPart::Execution),
    };
    Some(gap(write.time, earlier, missing))
}

/// Whether `write` is available once a barrier with the source `before` and `source` is over.
pub(super) fn makes_available<const Q: usize>(write: &Write, before: &Clock<Q>, source: PairSet) -> bool {
    let by_image_barrier = || write.barriers().iter().any(|barrier| before.is_after_barrier(barrier));
    if write.pairs.is_empty() {
        return by_image_barrier();
    }
    let waited = write.stages.iter().all(|stage| before.is_after(write.queue, stage, write.time));
    let left = || write.pairs.without(source).iter().any(|pair| !before.has_available(write.queue, pair, write.time));
    waited && (!left() || by_image_barrier())
}

fn is_after_write<const Q: usize>(clocks: &Clocks<Q>, queue: u8, stage: usize, write: &Write) -> bool {
    if write.pairs.is_empty() {
        return write.barriers().iter().any(|barrier| clocks.is_after_barrier(queue, stage, barrier));
    }
    let clock = clocks.of(queue, stage);
    write.stages.iter().all(|earlier| clock.is_after(write.queue, earlier, write.time))
}

fn is_visible<const Q: usize>(clocks: &Clocks<Q>, queue: u8, pair: usize, write: &Write) -> bool {
    let by_memory_barriers = || {
        let mut pairs = write.pairs.iter();
        !write.pairs.is_empty() && pairs.all(|earlier| clocks.is_visible(queue, pair, write.queue, earlier, write.time))
    };
    write.is_shown(queue, PairSet::only(pair))
        || by_memory_barriers()
        || write.barriers().iter().any(|barrier| clocks.is_visible_through(queue, pair, barrier))
}

fn is_available<const Q: usize>(clocks: &Clocks<Q>, queue: u8, stage: usize, write: &Write) -> bool {
    let clock = clocks.of(queue, stage);
    let by_memory_barriers = || write.pairs.iter().all(|pair| clock.has_available(write.queue, pair, write.time));
    !write.pairs.is_empty() && by_memory_barriers()
        || write.barriers().iter().any(|barrier| clocks.is_after_barrier(queue, stage, barrier))
}

/// A pair in Vulkan's words.
pub(super) fn by(pair: usize) -> Accessed {
    let (stages, accesses) = words(pair);
    Accessed::By(stages, accesses)
}
