//! What outlives the frame: the states in which it is found and left.
//!
//! A frame leaves a persistent image in the state in which the next one finds it. Every image has one layout at the end, so
//! parts that were left in other layouts than the last are brought into that one.

use super::model::{Adapted, Home, Store, StoreIndex};
use super::parts::Grids;
use super::synchronise::Walked;
use crate::vocabulary::{Accesses, Layout, Stages, State};
use std::ops::Range;

/// States of a store that outlives the frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct States {
    pub(super) before: State,
    pub(super) after: State,
}

/// Adds the barriers that promises take, before step number `export` which comes after all others, and finds the states of
/// every store; `None` for those that live within the frame.
pub(super) fn promise(grids: &Grids, adapted: &Adapted, walked: &mut Walked, export: u32) -> Vec<Option<States>> {
    let mut states: Vec<Option<States>> = vec![None; adapted.stores.len()];
    if adapted.stores.iter().all(Store::is_transient) {
        return states;
    }
    let mut at = 0;
    while let Some(store) = adapted.stores.get(at as usize) {
        let cycle = match store.home {
            Home::Transient => at..at + 1,
            Home::Output | Home::Imported { .. } => {
                let before = if let Home::Imported { before } = store.home { Some(before) } else { None };
                let after = leave(grids, adapted, walked, at, before, export);
                let before =
                    before.unwrap_or(State { accesses: after.accesses.writes(), layout: Layout::Undefined, ..after });
                states[at as usize] = Some(States { before, after });
                at..at + 1
            }
            Home::Persistent { .. } => {
                let cycle = at..last_of_cycle(adapted, at) + 1;
                persist(grids, adapted, walked, cycle.clone(), export, &mut states);
                cycle
            }
        };
        at = cycle.end;
    }
    states
}

/// The oldest of the stores that become each other, which stand side by side from `first`, the newest, on.
fn last_of_cycle(adapted: &Adapted, first: StoreIndex) -> StoreIndex {
    let becomes = |store: StoreIndex| match adapted.stores[store as usize].home {
        Home::Persistent { becomes, .. } => becomes,
        _ => first,
    };
    (first..).find(|store| becomes(*store) == first).unwrap_or(first)
}

/// The states of stores that become each other.
fn persist(
    grids: &Grids,
    adapted: &Adapted,
    walked: &mut Walked,
    cycle: Range<StoreIndex>,
    export: u32,
    states: &mut [Option<States>],
) {
    for store in cycle.clone() {
        read_on(grids, adapted, walked, previous(&cycle, store), store);
    }
    // Going around twice, whoever is touched by nothing learns what the touched one before it is left in.
    let mut picks = vec![None; cycle.len()];
    let mut known = None;
    let mut all = State { layout: Layout::Undefined, ..NOWHERE };
    for at in (0..cycle.len()).chain(0..cycle.len()) {
        let own = picked(grids, adapted, walked, cycle.start + at as u32);
        if let Some(own) = own {
            (all.stages, all.accesses) = (all.stages | own.stages, all.accesses | own.accesses);
        }
        known = own.or(known);
        picks[at] = known;
    }
    for (store, at) in cycle.clone().zip(0..) {
        let before = picks[(at + cycle.len() - 1) % cycle.len()].unwrap_or(NOWHERE);
        // Parts that nothing touches were used by earlier frames, as any of the others.
        let before = State { layout: before.layout, ..all };
        let after = leave(grids, adapted, walked, store, Some(before), export);
        states[store as usize] = Some(States { before, after });
    }
    for store in cycle.clone() {
        let before = states[previous(&cycle, store) as usize].map_or(NOWHERE, |states| states.after);
        if let Some(states) = &mut states[store as usize] {
            states.before = before;
        }
    }
}

/// The state of what nothing touches.
const NOWHERE: State = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::General };

fn previous(cycle: &Range<StoreIndex>, store: StoreIndex) -> StoreIndex {
    if store == cycle.start { cycle.end - 1 } else { store - 1 }
}

/// The cells of a store.
pub(super) fn cells(grids: &Grids, store: &Store) -> Range<u32> {
    store.first_cell..store.first_cell + store.grid(grids).map_or(1, |grid| grid.len())
}

/// The state in which the steps leave a store, by its last use.
fn picked(grids: &Grids, adapted: &Adapted, walked: &Walked, store: StoreIndex) -> Option<State> {
    let touched = cells(grids, &adapted.stores[store as usize]).map(|cell| &walked.cells[cell as usize]);
    let touched = touched.filter(|cell| cell.is_touched());
    let layout = touched.clone().max_by_key(|cell| cell.last)?.layout;
    let stages = touched.clone().fold(Stages::empty(), |stages, cell| stages | cell.stages);
    let accesses = touched.fold(Accesses::empty(), |accesses, cell| accesses | cell.accesses);
    Some(State { stages, accesses, layout })
}

/// Where a frame begins by reading what the one before read last, in the same layout, the barrier before those reads serves
/// these too.
fn read_on(grids: &Grids, adapted: &Adapted, walked: &mut Walked, from: StoreIndex, to: StoreIndex) {
    let [from, to] = [from, to].map(|store| cells(grids, &adapted.stores[store as usize]));
    for (from, to) in from.zip(to) {
        let (last, first) = (walked.cells[from as usize], walked.cells[to as usize]);
        let Some(begin) = walked.barriers.get(first.first_barrier as usize).copied() else { continue };
        let reads = begin.keeps && begin.dst_accesses.writes().is_empty();
        if reads && last.is_touched() && !last.writes() && last.layout == begin.new_layout {
            walked.read_also(from, begin.dst_stages, begin.dst_accesses);
        }
    }
}

/// Brings all parts of a store into one layout, or into the state that was asked for.
fn leave(
    grids: &Grids,
    adapted: &Adapted,
    walked: &mut Walked,
    store: StoreIndex,
    before: Option<State>,
    export: u32,
) -> State {
    let described = &adapted.stores[store as usize];
    let parts = cells(grids, described);
    let Some(last) = picked(grids, adapted, walked, store).or(before) else { return NOWHERE };
    if let Some(after) = described.after {
        for cell in parts {
            walked.promise(store, cell, export, after);
        }
        return after;
    }
    let mut last = last;
    if let Some(before) = before.filter(|_| parts.clone().any(|cell| !walked.cells[cell as usize].is_touched())) {
        last = State { stages: last.stages | before.stages, accesses: last.accesses | before.accesses, ..last };
    }
    let read = State { accesses: last.accesses.difference(Accesses::WRITES), ..last };
    for cell in parts {
        let known = &walked.cells[cell as usize];
        let layout = if known.is_touched() { Some(known.layout) } else { before.map(|before| before.layout) };
        if layout != Some(last.layout) {
            walked.promise(store, cell, export, read);
        }
    }
    last
}
