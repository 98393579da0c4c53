//! What the first use of each cell waits for: the state in which it is found, or whoever had its memory before.
//!
//! Where memory changes hands, the new occupant's first barrier names the *stages* of the previous occupant's last
//! accesses; their writes are named by a memory barrier (see `hand_over`). Frames follow each other, so the first occupant
//! comes after the last.

use super::hand_over::HandOver;
use super::last_uses::LastUses;
use super::model::{Adapted, StoreIndex};
use super::occupy::{Occupancy, Taken};
use super::outlive::{States, cells};
use super::parts::Grids;
use super::queues;
use super::synchronise::{Cell, NEVER, Pending, Walked};
use crate::vocabulary::{Accesses, Stages};

/// What first uses wait for, as far as their barriers don't say it.
#[derive(Debug, Default)]
pub(super) struct TakenOver {
    /// The writes that memory barriers have to name.
    pub(super) hand_overs: Vec<HandOver>,
    /// Barriers before first uses of buffers that take over memory from the frame before, on one queue, each with the last
    /// step of that frame that used the memory. Several of one barrier stand side by side.
    pub(super) from_frame_before: Vec<(u32, u32)>,
}

/// Fills in the barriers before first uses.
pub(super) fn take_over(
    grids: &Grids,
    adapted: &Adapted,
    states: &[Option<States>],
    occupancy: &Occupancy,
    walked: &mut Walked,
) -> TakenOver {
    for ((store, at), states) in adapted.stores.iter().zip(0..).zip(states) {
        let Some(states) = states else { continue };
        if walked.queues.as_ref().is_some_and(|queues| queues.is_crossed(at)) {
            queues::find(grids, adapted, walked, at, states);
            continue;
        }
        for cell in cells(grids, store) {
            let known = walked.cells[cell as usize];
            let Some(barrier) = walked.barriers.get_mut(known.first_barrier as usize) else { continue };
            find(barrier, states, known.second_barrier == NEVER);
            let is_needed = barrier.step != NEVER;
            // Without it, nothing else waits for those who read the same before.
            if let Some(next) = walked.barriers.get_mut(known.second_barrier as usize).filter(|_| !is_needed) {
                next.src_stages |= states.before.stages;
            }
        }
    }
    let mut taking = Taking { grids, adapted, walked, over: TakenOver::default() };
    occupancy.taken.iter().for_each(|taken| taking.take(taken));
    let over = taking.over;
    if walked.queues.is_some() {
        queues::finish(adapted, walked);
    }
    over
}

/// The barrier before the first use of what outlives frames, which may be the only one.
fn find(barrier: &mut Pending, States { before, after }: &States, is_last: bool) {
    let covers = before.layout == barrier.new_layout
        && before.stages.contains(barrier.dst_stages)
        && before.accesses.contains(barrier.dst_accesses);
    let reads = (barrier.dst_accesses | before.accesses).writes().is_empty();
    barrier.src_stages = before.stages;
    barrier.src_accesses = before.accesses.writes();
    barrier.in_layout = before.layout == barrier.new_layout;
    barrier.is_shown = barrier.reads_on(before.stages, before.accesses);
    if barrier.keeps {
        barrier.old_layout = before.layout;
        // Whoever comes after the frame must wait for earlier readers too, if nothing in it does.
        let waits_later = !is_last || after.stages.contains(before.stages);
        if covers && reads && waits_later {
            barrier.step = NEVER;
        }
    }
}

struct Taking<'t> {
    grids: &'t Grids,
    adapted: &'t Adapted,
    walked: &'t mut Walked,
    over: TakenOver,
}

impl Taking<'_> {
    fn take(&mut self, taken: &Taken) {
        let Taken { store, from, this_frame } = *taken;
        if self.walked.queues.is_some() {
            return queues::take(
                self.grids,
                self.adapted,
                self.walked,
                [from, store],
                this_frame,
                &mut self.over.hand_overs,
            );
        }
        let [taker, holder] = [store, from].map(|store| &self.adapted.stores[store as usize]);
        let is_image = taker.image().is_some();
        if store == from {
            return self.find_again(store);
        }
        let mut uses = LastUses::default();
        for held in cells(self.grids, holder) {
            let last = self.walked.cells[held as usize];
            if last.is_touched() {
                uses.add(held, last.stages, last.accesses, last.last);
            }
        }
        for cell in cells(self.grids, taker) {
            let known = self.walked.cells[cell as usize];
            let first = known.first_barrier;
            let Some(barrier) = self.walked.barriers.get_mut(first as usize) else { continue };
            for last in uses.iter() {
                barrier.src_stages |= last.stages;
                if this_frame {
                    barrier.after = if barrier.after == NEVER { last.last } else { barrier.after.max(last.last) };
                } else if !is_image {
                    self.over.from_frame_before.push((first, last.last));
                }
                if last.writes.is_empty() {
                    continue;
                }
                if !is_image {
                    barrier.src_accesses |= last.writes;
                } else if let Some(written) = last.apart_from(cell) {
                    self.over.hand_overs.push(HandOver {
                        stores: [from, store],
                        write: (last.stages, last.writes),
                        written,
                        this_frame,
                        barrier: first,
                    });
                }
            }
        }
    }

    /// `store` finds its own bytes again: each part what it did itself in the frame before. Barriers of one step say the
    /// same, so that they become one.
    fn find_again(&mut self, store: StoreIndex) {
        let described = &self.adapted.stores[store as usize];
        let mut by_step: Vec<(u32, Stages, Accesses)> = Vec::new();
        let of = |walked: &Walked, cell: u32| {
            let known = walked.cells[cell as usize];
            let first = walked.barriers.get(known.first_barrier as usize).filter(|_| known.is_touched());
            first.map(|first| (first.step, known))
        };
        for cell in cells(self.grids, described) {
            let Some((step, Cell { stages, accesses, .. })) = of(self.walked, cell) else { continue };
            match by_step.iter_mut().find(|same| same.0 == step) {
                Some((_, all, writes)) => (*all, *writes) = (*all | stages, *writes | accesses.writes()),
                None => by_step.push((step, stages, accesses.writes())),
            }
        }
        for cell in cells(self.grids, described) {
            let Some((step, Cell { first_barrier, last, .. })) = of(self.walked, cell) else { continue };
            let barrier = &mut self.walked.barriers[first_barrier as usize];
            if let Some((_, stages, writes)) = by_step.iter().find(|same| same.0 == step) {
                barrier.src_stages |= *stages;
                barrier.src_accesses |= *writes;
            }
            if described.image().is_none() {
                self.over.from_frame_before.push((first_barrier, last));
            }
        }
    }
}
