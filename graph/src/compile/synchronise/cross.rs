//! The walk where several queues are used.
//!
//! A wait holds up the whole step, and shows all that was written before; so what one queue did and another one comes after
//! takes no barrier, unless a layout changes, or the owner of an image that isn't for several queues at once. Whatever a
//! queue did itself takes one as ever, if it doesn't know by now, from a queue that waited for it, that it is done.

use super::{Cell, NEVER, Need, Pending, Walked, apply};
use crate::compile::queues::{HandOff, QUEUES, Queues, Seen, Shared, Steps, Track};
use crate::plan::Hazard;
use crate::vulkan::{Accesses, Layout, Stages};

/// Puts waits and barriers before what one step needs. `lasts`: it is one of the frame's own, not what is promised.
pub(super) fn step(walked: &mut Walked, needs: &[Need], step: u32, lasts: bool) {
    let Some(mut queues) = walked.queues.take() else { return };
    let queue = queues.at(step);
    let mut required = Steps::default();
    for need in needs {
        if let Some(shared @ (Shared::Buffer | Shared::Image | Shared::InTurns)) = queues.shared(need.store) {
            let cell = &walked.cells[need.cell as usize];
            comes_after(cell, queues.track(need.cell), need, queue, shared, &mut required);
        }
    }
    queues.require(step, required);
    for need in needs {
        match queues.shared(need.store) {
            None => apply(walked, need, step, lasts),
            Some(Shared::Constant) => reads_on(walked, need, step),
            Some(shared) => Crossing { walked, queues: &mut queues, need, shared, step, queue, lasts }.cross(),
        }
    }
    walked.queues = Some(queues);
}

/// Whether a need is one more read beside the last ones.
fn joins(cell: &Cell, track: &Track, need: &Need, queue: usize, shared: Shared) -> bool {
    let reads = need.accesses.writes().is_empty() && cell.is_touched();
    // What nobody hands over is read by all behind its write.
    let behind_reads = !cell.writes() || shared != Shared::InTurns;
    reads && behind_reads && cell.layout == need.layout && (shared != Shared::InTurns || track.begun.0 == queue)
}

/// Adds the steps of other queues that a need comes after.
fn comes_after(cell: &Cell, track: &Track, need: &Need, queue: usize, shared: Shared, required: &mut Steps) {
    if joins(cell, track, need, queue, shared) {
        if track.by[queue].until == 0 {
            let (of, step) = track.begun;
            required[of] = required[of].max(step + 1);
        }
        return;
    }
    for (other, seen) in track.by.iter().enumerate().filter(|(other, _)| *other != queue) {
        required[other] = required[other].max(seen.until);
    }
}

/// A read of what nothing ever writes: the state before the first frame serves it.
fn reads_on(walked: &mut Walked, need: &Need, step: u32) {
    let cell = &mut walked.cells[need.cell as usize];
    cell.usage |= need.usage;
    cell.stages |= need.stages;
    cell.accesses |= need.accesses;
    (cell.layout, cell.last) = (need.layout, step);
    lives(&mut walked.lifetimes[need.store as usize], step);
}

fn lives(lifetime: &mut [u32; 2], step: u32) {
    *lifetime = [lifetime[0].min(step), step];
}

/// One need of a cell that several queues use.
struct Crossing<'c> {
    walked: &'c mut Walked,
    queues: &'c mut Queues,
    need: &'c Need,
    shared: Shared,
    step: u32,
    queue: usize,
    lasts: bool,
}

impl Crossing<'_> {
    fn cross(self) {
        let Crossing { walked, queues, need, shared, step, queue, lasts } = self;
        let known = queues.known(step)[queue];
        let cell = &mut walked.cells[need.cell as usize];
        let track = *queues.track(need.cell);
        cell.usage |= need.usage;
        if lasts {
            lives(&mut walked.lifetimes[need.store as usize], step);
        }
        if joins(cell, &track, need, queue, shared) {
            cell.stages |= need.stages;
            cell.accesses |= need.accesses;
            cell.last = step;
            return join(walked, queues, need, step, queue, lasts);
        }
        let first = !cell.is_touched();
        // What the queue itself did, unless that came back to it through another queue's wait.
        let own = Some(track.by[queue]).filter(|seen| seen.until > known);
        let changes_hands = shared == Shared::InTurns && !first && track.begun.0 != queue;
        let changes = shared != Shared::Buffer && (need.layout != cell.layout || changes_hands);
        let barrier = (first || own.is_some() || changes).then_some(walked.barriers.len() as u32);
        if let Some(number) = barrier {
            let (src_stages, src_accesses) =
                own.map_or((Stages::empty(), Accesses::empty()), |own| (own.stages, own.accesses.writes()));
            let elsewhere = (0..QUEUES).filter(|other| *other != queue).any(|other| track.by[other].until > 0);
            // What is promised is waited for as a step of its own in the next frame.
            if !lasts || !first && (elsewhere || own.is_none()) {
                queues.hold(number);
            }
            let hands_over = changes_hands && need.keeps;
            if hands_over {
                let Seen { stages, accesses, until, .. } = track.by[track.begun.0];
                let from = until.saturating_sub(1);
                queues.hand_off(HandOff { barrier: number, from, stages, accesses: accesses.writes() });
            }
            let writes = !need.accesses.writes().is_empty();
            walked.barriers.push(Pending {
                cell: need.cell,
                store: need.store,
                step,
                after: if first { NEVER } else { cell.last },
                src_stages,
                src_accesses,
                dst_stages: need.stages,
                dst_accesses: need.accesses,
                old_layout: if need.keeps { cell.layout } else { Layout::Undefined },
                new_layout: need.layout,
                hazard: hazard(cell, first, writes, hands_over),
                keeps: need.keeps,
            });
            if first {
                cell.first_barrier = number;
            }
        }
        (cell.stages, cell.accesses, cell.layout, cell.last) = (need.stages, need.accesses, need.layout, step);
        let mut by = [Seen::default(); QUEUES];
        by[queue] = Seen { stages: need.stages, accesses: need.accesses, until: step + 1, barrier };
        let unread = !need.accesses.writes().is_empty();
        *queues.track_mut(need.cell) = Track { by, begun: (queue, step), unread };
    }
}

/// One more read beside the last ones, or behind a write: the barrier before those on its queue serves it, or the queue's
/// wait.
fn join(walked: &mut Walked, queues: &mut Queues, need: &Need, step: u32, queue: usize, lasts: bool) {
    let known = queues.known(step)[queue];
    let track = queues.track_mut(need.cell);
    let behind_write = track.unread && track.begun.0 == queue;
    let seen = &mut track.by[queue];
    if behind_write {
        let barrier = (seen.until > known).then_some(walked.barriers.len() as u32);
        if barrier.is_some() {
            walked.barriers.push(Pending {
                cell: need.cell,
                store: need.store,
                step,
                after: seen.until - 1,
                src_stages: seen.stages,
                src_accesses: seen.accesses.writes(),
                dst_stages: need.stages,
                dst_accesses: need.accesses,
                old_layout: need.layout,
                new_layout: need.layout,
                hazard: Hazard::ReadAfterWrite,
                keeps: true,
            });
        }
        *seen = Seen { stages: need.stages, accesses: need.accesses, until: step + 1, barrier };
        track.unread = false;
        return;
    }
    let first = seen.until == 0;
    if let Some(barrier) = seen.barrier.and_then(|barrier| walked.barriers.get_mut(barrier as usize)) {
        barrier.dst_stages |= need.stages;
        barrier.dst_accesses |= need.accesses;
    }
    seen.stages |= need.stages;
    seen.accesses |= need.accesses;
    // The step behind all others is there only for barriers and waits.
    if lasts || first {
        seen.until = step + 1;
    }
}

fn hazard(cell: &Cell, first: bool, writes: bool, hands_over: bool) -> Hazard {
    match (cell.writes(), writes) {
        _ if hands_over => Hazard::Ownership,
        _ if first => Hazard::FirstUse,
        (true, false) => Hazard::ReadAfterWrite,
        (true, true) => Hazard::WriteAfterWrite,
        (false, true) => Hazard::WriteAfterRead,
        (false, false) => Hazard::LayoutChange,
    }
}
