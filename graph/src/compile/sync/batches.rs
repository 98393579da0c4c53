//! Batches: barriers are gathered into as few calls as their places allow.
//!
//! A barrier may stand anywhere behind the last step that it waits for and before the step that needs it, on the queue of
//! the latter. Taking the latest place for the first barrier that has none, and putting every later one there that may stand
//! there, gives the fewest calls (the greedy choice for stabbing intervals).
//!
//! The barriers of buffers become one memory barrier a call. So they are gathered once more, by the same rule, into as few of
//! these calls as their own places allow.

use super::subresource::SubresourceBarrier;
use crate::compile::model::PhysicalResource;
use crate::compile::queues::{QUEUES, Queues};
use crate::compile::steps::NEVER;

/// A barrier with the step that it stands before.
#[derive(Debug, Clone, Copy)]
pub(in crate::compile) struct BarrierAtStep {
    pub(in crate::compile) at: u32,
    /// Index of the barrier.
    pub(in crate::compile) barrier: u32,
}

/// Puts barriers, in the order of the steps that need them, into calls, in the order of steps.
pub(super) fn batch(queues: &Queues, barriers: &[SubresourceBarrier]) -> Vec<BarrierAtStep> {
    let mut batched = Vec::with_capacity(barriers.len());
    let mut calls = [None; QUEUES];
    for (barrier, number) in barriers.iter().zip(0_u32..).filter(|(barrier, _)| barrier.step != NEVER) {
        let call = &mut calls[queues.queue_number(barrier.step)];
        let at = call.filter(|at| *at >= earliest(queues, number, barrier)).unwrap_or(barrier.step);
        *call = Some(at);
        batched.push(BarrierAtStep { at, barrier: number });
    }
    // The calls of one queue are in order.
    if !queues.is_one() {
        batched.sort_by_key(|it| it.at);
    }
    batched
}

/// For each step one more than the last step that its barriers wait for, as far as accesses alone make them wait.
///
/// `barriers`: those of the timeline, on one queue.
pub(in crate::compile) fn waits(barriers: &[SubresourceBarrier], steps: usize) -> Vec<u32> {
    let mut waits = vec![0; steps];
    for barrier in barriers {
        if let Some(waits) = waits.get_mut(barrier.step as usize) {
            *waits = barrier.after.wrapping_add(1).max(*waits);
        }
    }
    waits
}

/// The first step that a barrier may stand before.
fn earliest(queues: &Queues, number: u32, barrier: &SubresourceBarrier) -> u32 {
    if queues.is_held(number) { barrier.step } else { barrier.after.wrapping_add(1) }
}

/// Moves the barriers of buffers into as few of the calls as their places allow.
pub(super) fn gather_buffers(
    queues: &Queues,
    resources: &[PhysicalResource],
    barriers: &[SubresourceBarrier],
    batched: &mut [BarrierAtStep],
) {
    let of_buffer = |it: &BarrierAtStep| resources[barriers[it.barrier as usize].resource as usize].image().is_none();
    if !batched.iter().any(of_buffer) {
        return;
    }
    let mut calls: [Vec<u32>; QUEUES] = Default::default();
    batched.iter().for_each(|it| calls[queues.queue_number(it.at)].push(it.at));
    let mut gathered: [Option<u32>; QUEUES] = [None; QUEUES];
    for it in batched.iter_mut().filter(|it| of_buffer(it)) {
        let barrier = &barriers[it.barrier as usize];
        let queue = queues.queue_number(it.at);
        let (calls, gathered) = (&calls[queue], &mut gathered[queue]);
        if gathered.is_none_or(|at| at < earliest(queues, it.barrier, barrier)) {
            let last = calls.partition_point(|at| *at <= barrier.step).saturating_sub(1);
            *gathered = calls.get(last).copied();
        }
        it.at = gathered.unwrap_or(it.at);
    }
    batched.sort_by_key(|it| it.at);
}
