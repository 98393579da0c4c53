//! Levels: a run is one level above the highest that it depends on, or further up where that saves memory.
//!
//! Effects that nothing shows take no barriers, so runs with effects may share a level: they keep their order in it.

use super::accesses::{Access, Accesses};
use super::memory::Memory;
use super::runs::Runs;
use super::weighed::{Sums, Weighed, Weight};
use crate::compile::model::Adapted;
use crate::vulkan::Layout;

/// The least level of each run.
pub(super) struct Levels {
    least: Vec<u32>,
    top: u32,
}

/// The least level of each run; `None` if there is no level with more than one.
pub(super) fn levels(accesses: &Accesses, runs: &Runs) -> Option<Levels> {
    let mut upwards = Walk::new(accesses, runs);
    let mut least: Vec<u32> = Vec::with_capacity(runs.len() as usize);
    for run in 0..runs.len() {
        let level = upwards.least(run);
        runs.run(run).iter().for_each(|op| upwards.put(*op, level));
        least.push(level);
    }
    let top = least.iter().copied().max()?;
    (top + 1 != runs.len()).then_some(Levels { least, top })
}

/// The runs level by level. Decisions that sizes made go into `weighed`, if they are to be kept.
pub(super) fn by_level(
    adapted: &Adapted,
    accesses: &Accesses,
    runs: &Runs,
    Levels { least: mut keys, top }: Levels,
    memory: &Memory,
    mut weighed: Option<&mut Weighed>,
) -> Vec<u32> {
    // For each resource the first run that uses it.
    let mut begins = vec![u32::MAX; adapted.resources.len()];
    for run in 0..runs.len() {
        runs.for_each_use(adapted, run, |used| {
            let first = &mut begins[used.resource as usize];
            *first = run.min(*first);
        });
    }
    let mut downwards = Walk::new(accesses, runs);
    // For each resource one more than the level of its last use, as far as that is known.
    let mut ends = vec![0_u32; adapted.resources.len()];
    for run in (0..runs.len()).rev() {
        let (lowest, highest) = (keys[run as usize], top - downwards.least(run));
        let mut sums = Sums::default();
        runs.for_each_use(adapted, run, |used| {
            let (resource, begun) = (used.resource as usize, begins[used.resource as usize] == run);
            let (ended, held) = (ends[resource] <= lowest + 1, ends[resource] <= highest && !begun);
            let weight = Weight { resource: used.resource, begun, ended, held };
            sums.add(weight, memory);
            if let Some(weighed) = &mut weighed {
                weighed.weigh(weight);
            }
        });
        let decision = sums.decide(highest > lowest);
        if let Some(weighed) = &mut weighed {
            weighed.decided(highest > lowest, decision);
        }
        let level = if decision.rises { highest } else { lowest };
        runs.run(run).iter().rev().for_each(|op| downwards.put(*op, top - level));
        runs.for_each_use(adapted, run, |used| {
            let end = &mut ends[used.resource as usize];
            *end = (level + 1).max(*end);
        });
        // Within a level, runs that end more memory than they begin come first: the next runs then find memory free.
        let keeps_order = accesses.has_effects && runs.run(run).iter().any(|op| accesses.effect(*op).is_some());
        let place = if keeps_order { 1 } else { decision.begins as i8 + 1 };
        keys[run as usize] = 3 * level + place as u32;
    }
    counting_sort(&keys, 3 * top + 3)
}

/// The numbers of `keys`, all below `bound`, in the order of the keys; equal ones as they are.
fn counting_sort(keys: &[u32], bound: u32) -> Vec<u32> {
    let mut places = vec![0_u32; bound as usize];
    keys.iter().for_each(|key| places[*key as usize] += 1);
    let mut next = 0;
    for place in &mut places {
        next += std::mem::replace(place, next);
    }
    let mut order = vec![0; keys.len()];
    for (key, number) in keys.iter().zip(0_u32..) {
        order[places[*key as usize] as usize] = number;
        places[*key as usize] += 1;
    }
    order
}

/// A walk through all runs, from the first to the last or from the last to the first, that finds their least levels.
struct Walk<'a> {
    accesses: &'a Accesses,
    runs: &'a Runs,
    subresources: Vec<LastLevels>,
}

/// The accesses to a subresource so far: one more than their highest level, 0 if there are none. Reads in one layout don't
/// depend on each other, as in `runs`.
#[derive(Debug, Clone, Copy)]
struct LastLevels {
    before: u32,
    readers: u32,
    layout: Layout,
}

impl<'a> Walk<'a> {
    fn new(accesses: &'a Accesses, runs: &'a Runs) -> Walk<'a> {
        let state = LastLevels { before: 0, readers: 0, layout: Layout::Undefined };
        Walk { accesses, runs, subresources: vec![state; accesses.subresources] }
    }

    /// The least level of a run behind all that it depends on.
    fn least(&self, run: u32) -> u32 {
        let mut least = 0;
        for op in self.runs.run(run) {
            for access in self.accesses.op(*op) {
                let state = &self.subresources[access.subresource as usize];
                let joins = !access.writes && state.layout == access.layout;
                least = least.max(if joins { state.before } else { state.before.max(state.readers) });
            }
        }
        least
    }

    /// Notes the level of an operation.
    fn put(&mut self, op: u32, level: u32) {
        let behind = level + 1;
        for Access { subresource, writes, layout } in self.accesses.op(op).iter().copied() {
            let state = &mut self.subresources[subresource as usize];
            if writes {
                *state = LastLevels { before: behind, readers: 0, layout };
            } else if state.readers != 0 && state.layout == layout {
                state.readers = state.readers.max(behind);
            } else {
                *state = LastLevels { before: state.before.max(state.readers), readers: behind, layout };
            }
        }
        if self.accesses.has_effects
            && let Some(effect) = self.accesses.effect(op)
        {
            self.subresources[effect as usize].before = level;
        }
    }
}
