//! What the first use of each cell waits for: the state in which it is found, or whoever had its memory before.
//!
//! Where memory changes hands, the new occupant's first barrier names the *stages* of the previous occupant's last
//! accesses; their writes are named by a memory barrier (see `hand_over`). Frames follow each other, so the first occupant
//! comes after the last.

use super::hand_over::HandOver;
use super::last_uses::LastUses;
use super::model::{Adapted, StoreIndex};
use super::outlive::{States, cells};
use super::parts::Grids;
use super::place::Placed;
use super::queues;
use super::synchronise::{NEVER, Pending, Walked};

/// Fills in the barriers before first uses; returns the writes that memory barriers have to name.
pub(super) fn take_over(
    grids: &Grids,
    adapted: &Adapted,
    states: &[Option<States>],
    placed: &Placed,
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
    for heap in 0..placed.heaps.len() as u32 {
        taking.heap(placed, heap);
    }
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
    /// Follows who holds which bytes of a heap, through the frame and into the next.
    fn heap(&mut self, placed: &Placed, heap: u32) {
        let mut members: Vec<(u32, StoreIndex)> = Vec::new();
        let mut cuts: Vec<u64> = Vec::new();
        for (placement, store) in placed.placements.iter().zip(0_u32..) {
            if let Some(placement) = placement.as_ref().filter(|placement| placement.heap == heap) {
                members.push((self.walked.lifetimes[store as usize][0], store));
                cuts.push(placement.offset);
                cuts.push(placement.offset + placement.bytes);
            }
        }
        if !members.is_sorted() {
            members.sort_unstable();
        }
        cuts.sort_unstable();
        cuts.dedup();
        let mut holders = vec![NEVER; cuts.len()];
        let mut from_frame_before: Vec<(StoreIndex, u32)> = Vec::new();
        let mut known: Vec<StoreIndex> = Vec::new();
        for (_, store) in &members {
            let Some(placement) = &placed.placements[*store as usize] else { continue };
            let first = cuts.partition_point(|cut| *cut < placement.offset);
            let end = placement.offset + placement.bytes;
            known.clear();
            for piece in first..cuts.len() {
                if cuts[piece] >= end {
                    break;
                }
                let holder = std::mem::replace(&mut holders[piece], *store);
                if holder == NEVER {
                    from_frame_before.push((*store, piece as u32));
                } else if !known.contains(&holder) {
                    known.push(holder);
                    self.take(*store, holder, true);
                }
            }
        }
        let mut taker = NEVER;
        for (store, piece) in from_frame_before {
            if std::mem::replace(&mut taker, store) != store {
                known.clear();
            }
            let holder = holders[piece as usize];
            if !known.contains(&holder) {
                known.push(holder);
                self.take(store, holder, false);
            }
        }
    }

    /// `store` takes bytes of `from`.
    fn take(&mut self, store: StoreIndex, from: StoreIndex, this_frame: bool) {
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
        let described = |store: StoreIndex| &self.adapted.stores[store as usize];
        let (taker, holder) = (described(store), described(from));
        let is_image = taker.image().is_some();
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
            // A buffer's barrier covers all memory; an image's covers what the same image wrote there.
            if store == from && known.is_touched() {
                barrier.src_accesses |= known.accesses.writes();
            }
            for last in uses.iter() {
                barrier.src_stages |= last.stages;
                if this_frame {
                    barrier.after = if barrier.after == NEVER { last.last } else { barrier.after.max(last.last) };
                }
                if last.writes.is_empty() {
                    continue;
                }
                if !is_image {
                    barrier.src_accesses |= last.writes;
                } else if let Some(written) = last.apart_from(cell) {
                    self.hand_overs.push(HandOver {
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
}
