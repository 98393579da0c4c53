//! `synchronise`: barriers before first uses that wait for reads of earlier frames, and for nothing that the barriers in
//! between don't wait for already.
//!
//! What persists may be written again several frames after it was read. The barriers of the frames in between then may form
//! an execution dependency chain from those reads to that write. The write before those reads must be visible to the new one
//! too: by the memory barrier that showed it to them, which serves all buffers of its call. An image barrier shows a write to
//! nothing but its own destination, so barriers of images stay.

use super::batch::Batched;
use super::hand_over::{and_earlier, and_later};
use super::model::{Adapted, Home, StoreIndex};
use super::outlive::last_of_cycle;
use super::synchronise::{NEVER, Pending, Walked};
use crate::plan::Hazard;
use crate::vulkan::{Accesses, Stages};

/// Reads of an earlier frame.
struct Reads {
    /// The barrier between the write before them and them, if that was in the same frame.
    behind_write: Option<u32>,
    stages: Stages,
    /// The last step that reads.
    step: u32,
    frames_ago: u32,
}

/// Takes out the barriers that the others make redundant.
pub(super) fn take_out(adapted: &Adapted, walked: &mut Walked, batched: &mut Vec<Batched>) {
    let mut at = 0;
    while let Some(it) = batched.get(at).copied() {
        let barrier = walked.barriers[it.barrier as usize];
        let of_buffer = adapted.stores[barrier.store as usize].image().is_none();
        if of_buffer
            && waits_for_reads(&barrier)
            && !is_crossed(walked, barrier.store)
            && is_redundant(adapted, walked, batched, it)
        {
            walked.barriers[it.barrier as usize].step = NEVER;
            batched.remove(at);
        } else {
            at += 1;
        }
    }
}

/// Whether all that it waits for are reads of earlier frames, in the layout of the use that needs it.
fn waits_for_reads(barrier: &Pending) -> bool {
    barrier.hazard == Hazard::FirstUse
        && barrier.after == NEVER
        && barrier.src_accesses.is_empty()
        && !barrier.src_stages.is_empty()
        && barrier.old_layout == barrier.new_layout
}

fn is_crossed(walked: &Walked, store: StoreIndex) -> bool {
    walked.queues.as_ref().is_some_and(|queues| queues.is_crossed(store))
}

fn is_redundant(adapted: &Adapted, walked: &Walked, batched: &[Batched], it: Batched) -> bool {
    let barrier = &walked.barriers[it.barrier as usize];
    let reads = earlier_reads(adapted, walked, barrier);
    let known = reads.iter().fold(Stages::empty(), |all, reads| all | reads.stages);
    let behind_write = reads.last().and_then(|reads| reads.behind_write);
    known == barrier.src_stages
        && behind_write.is_some_and(|shows| is_shown(adapted, walked, batched, shows, barrier))
        && reads.iter().all(|reads| reads.stages.iter().all(|stage| is_followed(walked, batched, it, reads, stage)))
}

/// The reads of one part since it was written last, some frames ago: by what becomes it.
fn earlier_reads(adapted: &Adapted, Walked { cells, barriers, .. }: &Walked, barrier: &Pending) -> Vec<Reads> {
    let store = barrier.store;
    let Home::Persistent { .. } = adapted.stores[store as usize].home else { return Vec::new() };
    let part = barrier.cell - adapted.stores[store as usize].first_cell;
    let last = last_of_cycle(adapted, store);
    let first = (0..=store).rev().take_while(|first| last_of_cycle(adapted, *first) == last).last().unwrap_or(store);
    let mut reads = Vec::new();
    let mut from = store;
    for frames_ago in 1..=last - first + 1 {
        from = if from == first { last } else { from - 1 };
        let cell = &cells[(adapted.stores[from as usize].first_cell + part) as usize];
        if !cell.is_touched() {
            continue;
        }
        if !cell.writes() {
            let shows = barriers.get(cell.second_barrier as usize);
            let behind_write = shows.filter(|it| it.hazard == Hazard::ReadAfterWrite).map(|_| cell.second_barrier);
            reads.push(Reads { behind_write, stages: cell.stages, step: cell.last, frames_ago });
        }
        if cell.writes() || cell.second_barrier != NEVER {
            break;
        }
    }
    reads
}

/// Whether the memory barrier that `shows` is part of shows to the use behind `barrier` as well what it shows to others.
fn is_shown(adapted: &Adapted, walked: &Walked, batched: &[Batched], shows: u32, barrier: &Pending) -> bool {
    let Some(call) = batched.iter().find(|it| it.barrier == shows).map(|it| it.at) else { return false };
    let of_buffers = batched.iter().filter(|it| it.at == call).map(|it| &walked.barriers[it.barrier as usize]);
    let of_buffers = of_buffers.filter(|it| adapted.stores[it.store as usize].image().is_none());
    let (stages, accesses) = of_buffers.fold((Stages::empty(), Accesses::empty()), |(stages, accesses), it| {
        (stages | it.dst_stages, accesses | it.dst_accesses)
    });
    stages.contains(barrier.dst_stages) && accesses.contains(barrier.dst_accesses)
}

/// Whether barriers lead from reads in `stage` to the stages for which the barrier `it` is there.
fn is_followed(walked: &Walked, batched: &[Batched], it: Batched, reads: &Reads, stage: Stages) -> bool {
    let queue = |step| walked.queues.as_ref().map_or(0, |queues| queues.at(step));
    let mut reach = Stages::empty();
    for frames_ago in (0..=reads.frames_ago).rev() {
        let comes_between = |other: &&Batched| {
            other.barrier != it.barrier
                && queue(other.at) == queue(it.at)
                && (frames_ago < reads.frames_ago || other.at > reads.step)
                && (frames_ago > 0 || other.at < it.at)
        };
        for call in batched.chunk_by(|one, other| one.at == other.at) {
            let waits = |other: &&Batched| {
                let from = and_earlier(walked.barriers[other.barrier as usize].src_stages);
                from.contains(stage) || from.intersects(reach)
            };
            let leads = call.iter().filter(comes_between).filter(waits);
            reach =
                leads.fold(reach, |reach, other| reach | and_later(walked.barriers[other.barrier as usize].dst_stages));
        }
    }
    reach.contains(walked.barriers[it.barrier as usize].dst_stages)
}
