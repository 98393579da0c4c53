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
use super::synchronise::{NEVER, Pending, Walked};

/// Fills in the barriers before first uses; returns the writes that memory barriers have to name.
pub(super) fn take_over(
    grids: &Grids,
    adapted: &Adapted,
    states: &[Option<States>],
    occupancy: &Occupancy,
    walked: &mut Walked,
) -> Vec<HandOver> {
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
    let mut taking = Taking { grids, adapted, walked, hand_overs: Vec::new() };
    occupancy.taken.iter().for_each(|taken| taking.take(taken));
    let hand_overs = taking.hand_overs;
    if walked.queues.is_some() {
        queues::finish(adapted, walked);
    }
    hand_overs
}

/// The barrier before the first use of what outlives frames, which may be the only one.
fn find(barrier: &mut Pending, States { before, after }: &States, is_last: bool) {
    let covers = before.layout == barrier.new_layout
        && before.stages.contains(barrier.dst_stages)
        && before.accesses.contains(barrier.dst_accesses);
    let reads = (barrier.dst_accesses | before.accesses).writes().is_empty();
    barrier.src_stages = before.stages;
    barrier.src_accesses = before.accesses.writes();
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
    hand_overs: Vec<HandOver>,
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
                &mut self.hand_overs,
            );
        }
        let [taker, holder] = [store, from].map(|store| &self.adapted.stores[store as usize]);
        if store == from {
            return self.take_again(store);
        }
        let is_image = taker.image().is_some();
        let mut uses = LastUses::default();
        for held in cells(self.grids, holder) {
            let last = self.walked.cells[held as usize];
            if last.is_touched() {
                uses.add(last.stages, last.accesses, last.last);
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
                }
                if last.writes.is_empty() {
                    continue;
                }
                // A buffer's barrier covers all memory, an image's its own image alone.
                if !is_image {
                    barrier.src_accesses |= last.writes;
                    continue;
                }
                self.hand_overs.push(HandOver {
                    stores: [from, store],
                    write: (last.stages, last.writes),
                    written: last.last,
                    this_frame,
                    barrier: first,
                });
            }
        }
    }

    /// Nothing else had the memory since the frame before: each part waits for what was done to itself.
    fn take_again(&mut self, store: StoreIndex) {
        for cell in cells(self.grids, &self.adapted.stores[store as usize]) {
            let known = self.walked.cells[cell as usize];
            if let Some(barrier) = self.walked.barriers.get_mut(known.first_barrier as usize) {
                barrier.src_stages |= known.stages;
                barrier.src_accesses |= known.accesses.writes();
            }
        }
    }
}
