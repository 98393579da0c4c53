//! What outlives the frame: the states in which it is found and left.
//!
//! A frame leaves a persistent image in the state in which the next one finds it. Every image has one layout at the end, so
//! parts that were left in other layouts than the last are brought into that one. A state that names reads alone says that
//! whoever comes next may read at once in all these ways, so the barriers before the last reads of each part serve them all.

use super::model::{Adapted, Home, Store, StoreIndex};
use super::parts::Grids;
use super::queues;
use super::synchronise::{Cell, NEVER, Walked};
use crate::vulkan::{Accesses, Aspects, Layout, Stages, State};
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
        if !store.is_transient() && walked.queues.as_ref().is_some_and(|queues| queues.is_crossed(at)) {
            at = queues::promise(grids, adapted, walked, at, export, &mut states) + 1;
            continue;
        }
        let last = if let Home::Persistent { .. } = store.home { last_of_cycle(adapted, at) } else { at };
        if !store.is_transient() {
            let handed_in = if let Home::Imported { before } = store.home { Some(before) } else { None };
            let mut circle = Circle { grids, adapted, walked, stores: at..last + 1, handed_in, layouts: Vec::new() };
            let after = circle.leave(export);
            let from = after.iter().cycle().skip(after.len() - 1);
            for ((store, after), from) in (at..=last).zip(&after).zip(from) {
                let before = match adapted.stores[store as usize].home {
                    Home::Imported { before } => before,
                    Home::Persistent { .. } => *from,
                    // What is not kept is found as the frame before left it, without its contents.
                    Home::Output | Home::Transient => {
                        State { accesses: after.accesses.writes(), layout: Layout::Undefined, ..*after }
                    }
                };
                states[store as usize] = Some(States { before, after: *after });
            }
        }
        at = last + 1;
    }
    states
}

/// The oldest of the stores that become each other, which stand side by side, found from any of them on; a store that doesn't
/// persist stands for itself.
pub(super) fn last_of_cycle(adapted: &Adapted, first: StoreIndex) -> StoreIndex {
    let becomes_next = |store: &StoreIndex| match adapted.stores[*store as usize].home {
        Home::Persistent { becomes, .. } => becomes > *store,
        _ => false,
    };
    (first..).find(|store| !becomes_next(store)).unwrap_or(first)
}

/// The cells of a store.
pub(super) fn cells(grids: &Grids, store: &Store) -> Range<u32> {
    store.first_cell..store.first_cell + store.grid(grids).map_or(1, |grid| grid.len())
}

/// Stores of which each becomes the next in the next frame, and the last one the first; or one alone that comes and goes.
struct Circle<'a> {
    grids: &'a Grids,
    adapted: &'a Adapted,
    walked: &'a mut Walked,
    stores: Range<StoreIndex>,
    /// The state in which something imported is found.
    handed_in: Option<State>,
    /// The layout in which each is left.
    layouts: Vec<Layout>,
}

/// How one part was used last: stages and accesses since the last write or change of layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Uses {
    stages: Stages,
    accesses: Accesses,
}

impl Uses {
    fn reads_alone(self) -> bool {
        self.accesses.writes().is_empty()
    }

    fn and(self, other: Uses) -> Uses {
        Uses { stages: self.stages | other.stages, accesses: self.accesses | other.accesses }
    }

    fn covers(self, other: Uses) -> bool {
        self.and(other) == self
    }
}

impl From<State> for Uses {
    fn from(state: State) -> Uses {
        Uses { stages: state.stages, accesses: state.accesses }
    }
}

impl From<&Cell> for Uses {
    fn from(cell: &Cell) -> Uses {
        Uses { stages: cell.stages, accesses: cell.accesses }
    }
}

impl Circle<'_> {
    /// Brings each store into one state, which is returned.
    fn leave(&mut self, export: u32) -> Vec<State> {
        if self.handed_in.is_none() {
            (0..self.stores.len()).for_each(|at| self.read_on(at));
        }
        self.choose_layouts();
        (0..self.stores.len()).for_each(|at| self.bring_into_layout(at, export));
        // What is added to the reads of one part may add to those of another.
        while (0..self.stores.len()).any(|at| self.share_reads(at, export)) {}
        (0..self.stores.len())
            .map(|at| {
                let Uses { stages, accesses } = self.uses(at);
                let asked_for = self.store(at).after;
                asked_for.unwrap_or(State { stages, accesses, layout: self.layouts[at] })
            })
            .collect()
    }

    fn store(&self, at: usize) -> &Store {
        &self.adapted.stores[self.stores.start as usize + at]
    }

    /// The one that becomes number `at`.
    fn previous(&self, at: usize) -> usize {
        at.checked_sub(1).unwrap_or(self.stores.len() - 1)
    }

    fn parts(&self) -> Range<u32> {
        0..cells(self.grids, self.store(0)).len() as u32
    }

    fn cell(&self, at: usize, part: u32) -> &Cell {
        &self.walked.cells[(self.store(at).first_cell + part) as usize]
    }

    /// Where a frame begins by reading what the one before read last, in the same layout, the barrier before those reads
    /// serves these too.
    fn read_on(&mut self, at: usize) {
        let from = self.previous(at);
        for part in self.parts() {
            let (last, first) = (*self.cell(from, part), self.cell(at, part));
            let Some(begin) = self.walked.barriers.get(first.first_barrier as usize).copied() else { continue };
            let reads = begin.keeps && begin.dst_accesses.writes().is_empty();
            if reads && last.is_touched() && !last.writes() && last.layout == begin.new_layout {
                let cell = self.store(from).first_cell + part;
                self.walked.read_also(cell, begin.dst_stages, begin.dst_accesses);
            }
        }
    }

    /// Each store is left in the layout that was asked for, or that of its last use, or in which it was found.
    fn choose_layouts(&mut self) {
        let none = if self.store(0).image().is_some() { Layout::General } else { Layout::Undefined };
        let mut known = self.handed_in.map_or(none, |state| state.layout);
        // Going around twice, whoever is touched by nothing learns what the touched one before it is left in.
        for _ in 0..2 {
            self.layouts.clear();
            for at in 0..self.stores.len() {
                known = self.own_layout(at).unwrap_or(known);
                self.layouts.push(known);
            }
        }
    }

    fn own_layout(&self, at: usize) -> Option<Layout> {
        if let Some(after) = self.store(at).after {
            return Some(after.layout);
        }
        let touched = self.parts().map(|part| self.cell(at, part)).filter(|cell| cell.is_touched());
        let layout = touched.max_by_key(|cell| cell.last)?.layout;
        Some(of_all_planes(self.store(at), layout))
    }

    /// Brings all parts of a store into its layout, or into the state that was asked for.
    fn bring_into_layout(&mut self, at: usize, export: u32) {
        let (store, first) = (self.stores.start + at as u32, self.store(at).first_cell);
        let layout = self.layouts[at];
        if let Some(after) = self.store(at).after {
            // Where no stages are named a semaphore waits for everything: then only a layout takes a barrier.
            let is_there = |cell: &Cell| after.stages.is_empty() && cell.is_touched() && cell.layout == layout;
            let lacking: Vec<u32> = self.parts().filter(|part| !is_there(self.cell(at, *part))).collect();
            return lacking.into_iter().for_each(|part| self.walked.promise(store, first + part, export, after));
        }
        let found = self.handed_in.map_or(self.layouts[self.previous(at)], |state| state.layout);
        let held = |cell: &Cell| if cell.is_touched() { cell.layout } else { found };
        if self.parts().all(|part| held(self.cell(at, part)) == layout) {
            return;
        }
        let touched = self.parts().map(|part| self.cell(at, part)).filter(|cell| cell.is_touched());
        let Uses { stages, accesses } = touched.fold(Uses::default(), |all, cell| all.and(cell.into()));
        let read = State { stages, accesses: accesses.difference(Accesses::WRITES), layout };
        for part in self.parts() {
            if held(self.cell(at, part)) != layout {
                self.walked.promise(store, first + part, export, read);
            }
        }
    }

    /// Calls `visit` with each use that somebody after the frame meets in a part of store number `at`: its own last one;
    /// if it has none, or reads on without waiting, that of the frame before.
    fn each_use(&self, at: usize, part: u32, mut visit: impl FnMut(Uses, Option<(usize, u32)>)) {
        let mut reads_on = false;
        let mut now = at;
        for _ in 0..self.stores.len() {
            let (cell, before) = (self.cell(now, part), self.previous(now));
            if cell.is_touched() {
                if reads_on && cell.writes() {
                    return;
                }
                visit(cell.into(), Some((now, part)));
                let found = self.handed_in.map_or(self.layouts[before], |state| state.layout);
                if cell.writes() || cell.second_barrier != NEVER || cell.layout != found {
                    return;
                }
                reads_on = true;
            }
            now = before;
        }
        if let Some(found) = self.handed_in.map(Uses::from)
            && (found.reads_alone() || !reads_on)
        {
            visit(found, None);
        }
    }

    /// All uses that somebody after the frame meets in store number `at`.
    fn uses(&self, at: usize) -> Uses {
        let mut all = Uses::default();
        self.parts().for_each(|part| self.each_use(at, part, |uses, _| all = all.and(uses)));
        all
    }

    /// If a store is left to be read, lets all its parts be read in all ways. Returns whether that was news to any.
    fn share_reads(&mut self, at: usize, export: u32) -> bool {
        let all = self.uses(at);
        if !all.reads_alone() || self.store(at).after.is_some() {
            return false;
        }
        let mut lacking = Vec::new();
        for part in self.parts() {
            self.each_use(at, part, |uses, cell| {
                // What was handed in stays as it is, whatever reads on from there.
                let is_fixed = cell.is_none() && self.cell(at, part).is_touched();
                if !uses.covers(all) && !is_fixed {
                    lacking.push(cell.unwrap_or((at, part)));
                }
            });
        }
        for (at, part) in &lacking {
            let cell = self.store(*at).first_cell + part;
            if self.walked.cells[cell as usize].is_touched() {
                self.walked.read_also(cell, all.stages, all.accesses);
            } else {
                let state = State { stages: all.stages, accesses: all.accesses, layout: self.layouts[*at] };
                self.walked.promise(self.stores.start + *at as u32, cell, export, state);
            }
        }
        !lacking.is_empty()
    }
}

/// The layout of all of a store one of whose planes is in `layout`.
pub(super) fn of_all_planes(store: &Store, layout: Layout) -> Layout {
    let both = store.image().is_some_and(|image| image.format.aspects().contains(Aspects::STENCIL));
    match layout {
        Layout::DepthAttachmentOptimal | Layout::StencilAttachmentOptimal if both => {
            Layout::DepthStencilAttachmentOptimal
        }
        Layout::DepthReadOnlyOptimal | Layout::StencilReadOnlyOptimal if both => Layout::DepthStencilReadOnlyOptimal,
        layout => layout,
    }
}
