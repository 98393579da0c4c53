//! Levels: a run is one level above the highest that it depends on, or further up where that saves memory.
//!
//! Effects that nothing shows take no barriers, so runs with effects may share a level: they keep their order in it.

use super::accesses::Access;
use super::memory::{Lifetimes, Memory};
use super::runs::Runs;
use crate::compile::access_chain::AccessChain;
use std::cmp::Ordering;

/// The least level of each run.
pub(super) struct Levels {
    least: Vec<u32>,
    top: u32,
    /// The lifetimes in the order of runs.
    lifetimes: Lifetimes,
}

/// The least level of each run; `None` if there is no level with more than one.
pub(super) fn levels(runs: &Runs) -> Option<Levels> {
    let mut upwards = Walk::new(runs);
    let mut lifetimes = Lifetimes::unused(runs.resources(), runs.len());
    let mut least: Vec<u32> = Vec::with_capacity(runs.len() as usize);
    let mut top = 0;
    for run in 0..runs.len() {
        let accesses = runs.accesses(run);
        let level = upwards.least(accesses);
        for access in accesses {
            upwards.put(access, level);
            lifetimes.use_at(access.resource, run);
        }
        top = level.max(top);
        least.push(level);
    }
    (top + 1 < runs.len()).then_some(Levels { least, top, lifetimes })
}

/// The runs level by level, and the lifetimes in the order of runs.
pub(super) fn by_level(runs: &Runs, levels: Levels, memory: &Memory) -> (Vec<u32>, Lifetimes) {
    // Each run's least level makes way for the key by which it is sorted.
    let Levels { least: mut keys, top, lifetimes } = levels;
    let mut downwards = Walk::new(runs);
    let known = |resource| ResourceLevels { bytes: memory.bytes(resource), first: lifetimes.first(resource), end: 0 };
    let mut known: Vec<ResourceLevels> = (0..runs.resources() as u32).map(known).collect();
    for (run, key) in (0..runs.len()).zip(&mut keys).rev() {
        let lowest = *key;
        let accesses = runs.accesses(run);
        // The bytes that the run begins and ends, if it stands in its lowest level.
        let (mut begun, mut ended) = (0_u64, 0_u64);
        let mut least = 0;
        for access in accesses {
            least = least.max(downwards.behind(access));
            let ResourceLevels { bytes, first, end } = known[access.resource as usize];
            begun = begun.saturating_add(if first == run { bytes } else { 0 });
            ended = ended.saturating_add(if end <= lowest + 1 { bytes } else { 0 });
        }
        let highest = top - least;
        // The bytes that the run would keep alive, if it stood in its highest level.
        let held = || {
            let used = accesses.iter().map(|access| &known[access.resource as usize]);
            let held = used.filter(|it| it.first != run && it.end <= highest);
            held.fold(0_u64, |sum, it| sum.saturating_add(it.bytes))
        };
        let rises = highest > lowest && begun > 0 && begun > held();
        let level = if rises { highest } else { lowest };
        runs.for_each_backwards(run, |access| {
            downwards.put(access, top - level);
            let end = &mut known[access.resource as usize].end;
            *end = (level + 1).max(*end);
        });
        // Within a level, runs that end more memory than they begin come first: the next runs then find memory free.
        // Effects keep their order.
        let keeps_place = runs.has_effects() && accesses.iter().any(|access| access.is_effect);
        let place = match begun.cmp(&ended) {
            _ if keeps_place => 1,
            _ if rises => 2,
            Ordering::Less => 0,
            Ordering::Equal => 1,
            Ordering::Greater => 2,
        };
        *key = 3 * level + place;
    }
    (counting_sort(&keys, 3 * top + 3), lifetimes)
}

/// A resource while the runs are walked from the last to the first.
#[derive(Debug, Clone, Copy)]
struct ResourceLevels {
    bytes: u64,
    /// The first run that uses it.
    first: u32,
    /// One more than the level of its last use, as far as that is known.
    end: u32,
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
struct Walk {
    /// For each subresource its accesses so far: one more than their highest level.
    chains: Vec<AccessChain<u32>>,
}

impl Walk {
    fn new(runs: &Runs) -> Walk {
        Walk { chains: vec![AccessChain::new(); runs.subresources()] }
    }

    /// The least level of a run with these accesses, behind all that it depends on.
    #[inline]
    fn least(&self, accesses: &[Access]) -> u32 {
        accesses.iter().fold(0, |least, access| least.max(self.behind(access)))
    }

    /// The least level that an access may have.
    #[inline]
    fn behind(&self, access: &Access) -> u32 {
        self.chains[access.subresource as usize].highest_behind(access.writes, access.layout)
    }

    /// Notes the level of an access.
    #[inline]
    fn put(&mut self, access: &Access, level: u32) {
        let Access { subresource, writes, layout, is_effect, .. } = *access;
        // Another effect may share the level of an effect.
        let behind = level + u32::from(!is_effect);
        self.chains[subresource as usize].add_number(writes, layout, behind);
    }
}
