//! Whether an access or a barrier comes after what it conflicts with, and with what memory dependency.
//!
//! - A read needs the last write made visible to its own stage and access.
//! - A write needs the same of the last write: Vulkan asks for a memory dependency between two writes, and its second
//!   scope must name the second write. Reads since then must have been waited for; that takes no memory dependency.
//! - A layout change is a write. It needs the last write available, and reads waited for; it is then available itself and
//!   visible to the second scope of its barrier.
//!
//! Execution dependencies are global, whichever barrier makes them. Memory dependencies of an image barrier cover the
//! barrier's own range, those of a memory barrier everything.

use super::cells::{Cell, Write};
use super::clocks::{Clock, Clocks, Time};
use super::scopes::{PairSet, StageSet, stage_of, stage_word, words};
use super::violation::{Rule, Touched};

/// What is missing between an earlier access and a later one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gap {
    /// When the earlier one happened.
    pub(super) time: Time,
    pub(super) earlier: Touched,
    pub(super) later: Touched,
    pub(super) missing: Missing,
}

/// The part of a dependency that is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Missing {
    Execution,
    Availability,
    Visibility,
}

impl Gap {
    pub(super) fn rule(self) -> Rule {
        let Gap { earlier, later, .. } = self;
        match self.missing {
            Missing::Execution => Rule::Execution { earlier, later },
            Missing::Availability => Rule::Availability { earlier, later },
            Missing::Visibility => Rule::Visibility { earlier, later },
        }
    }
}

/// What is missing before an access in `stages` by `pairs`.
pub(super) fn before_access(cell: &Cell, clocks: &Clocks, stages: StageSet, pairs: PairSet) -> Option<Gap> {
    let writes = cell.writes.iter().find_map(|write| {
        let gap = |later, missing| Some(Gap { time: write.time, earlier: touched(write), later, missing });
        if let Some(stage) = stages.iter().find(|stage| !is_after_write(clocks, *stage, write)) {
            let pair = pairs.iter().find(|pair| stage_of(*pair) == stage);
            return gap(pair.map_or(Touched::Wait(stage_word(stage)), by), Missing::Execution);
        }
        let hidden = pairs.iter().find(|pair| !is_visible(clocks, *pair, write))?;
        let available = stages.iter().all(|stage| is_available(clocks, stage, write));
        gap(by(hidden), if available { Missing::Visibility } else { Missing::Availability })
    });
    writes.or_else(|| {
        let mut conflicts = pairs.writes().iter().flat_map(|pair| cell.reads.iter().map(move |read| (pair, read)));
        let (pair, (stage, time)) =
            conflicts.find(|(pair, (stage, time))| !clocks.is_after(stage_of(*pair), *stage, *time))?;
        Some(Gap { time, earlier: Touched::Read(stage_word(stage)), later: by(pair), missing: Missing::Execution })
    })
}

/// What is missing before a layout change, or before the memory is given away, by a barrier that comes after `before` and
/// makes the writes `source` available itself.
pub(super) fn before_layout_change(cell: &Cell, before: &Clock, source: PairSet) -> Option<Gap> {
    let gap = |time, earlier, missing| Gap { time, earlier, later: Touched::LayoutChange, missing };
    let read = cell.reads.iter().find(|(stage, time)| !before.is_after(*stage, *time));
    if let Some((stage, time)) = read {
        return Some(gap(time, Touched::Read(stage_word(stage)), Missing::Execution));
    }
    let write = cell.writes.iter().find(|write| !makes_available(write, before, source))?;
    let waited = write.pair().is_some_and(|pair| before.is_after(stage_of(pair), write.time));
    Some(gap(write.time, touched(write), if waited { Missing::Availability } else { Missing::Execution }))
}

/// Whether `write` is available once a barrier with the source `before` and `source` is over.
pub(super) fn makes_available(write: &Write, before: &Clock, source: PairSet) -> bool {
    let by_image_barrier = || write.barriers().iter().any(|barrier| before.is_after_barrier(*barrier));
    match write.pair() {
        None => by_image_barrier(),
        Some(pair) => {
            before.is_after(stage_of(pair), write.time)
                && (source.contains(pair) || before.has_available(pair, write.time) || by_image_barrier())
        }
    }
}

fn is_after_write(clocks: &Clocks, stage: usize, write: &Write) -> bool {
    match write.pair() {
        Some(pair) => clocks.is_after(stage, stage_of(pair), write.time),
        None => write.barriers().iter().any(|barrier| clocks.is_after_barrier(stage, *barrier)),
    }
}

fn is_visible(clocks: &Clocks, pair: usize, write: &Write) -> bool {
    write.visible.contains(pair)
        || write.pair().is_some_and(|earlier| clocks.is_visible(pair, earlier, write.time))
        || write.barriers().iter().any(|barrier| clocks.is_visible_through(pair, *barrier))
}

fn is_available(clocks: &Clocks, stage: usize, write: &Write) -> bool {
    write.pair().is_some_and(|pair| clocks.has_available(stage, pair, write.time))
        || write.barriers().iter().any(|barrier| clocks.is_after_barrier(stage, *barrier))
}

fn touched(write: &Write) -> Touched {
    write.pair().map_or(Touched::LayoutChange, by)
}

/// A pair in Vulkan's words.
pub(super) fn by(pair: usize) -> Touched {
    let (stages, accesses) = words(pair);
    Touched::By(stages, accesses)
}
