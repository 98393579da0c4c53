//! `synchronise`, last part: barriers are gathered into as few calls as their places allow.
//!
//! A barrier may stand anywhere behind the last step that it waits for and before the step that needs it. Taking the latest
//! place for the first one that has none yet, and putting every later one there that may stand there, gives the fewest calls
//! (the greedy choice for stabbing intervals).
//!
//! Those of buffers become one memory barrier a call. So among the calls that there are they are gathered once more, by the
//! same rule, into as few as their own places allow.

use super::model::Store;
use super::queues::{QUEUES, Queues};
use super::synchronise::{NEVER, Pending};

/// A barrier with the step that it stands before.
#[derive(Debug, Clone, Copy)]
pub(super) struct Batched {
    pub(super) at: u32,
    /// Into the barriers that were pending.
    pub(super) barrier: u32,
}

/// Puts pending barriers, which come in the order of the steps that need them, into calls; those come in the order of steps.
pub(super) fn batch(stores: &[Store], pending: &[Pending]) -> Vec<Batched> {
    let mut batched = Vec::with_capacity(pending.len());
    let mut call = 0;
    let mut first = true;
    for (barrier, number) in pending.iter().zip(0_u32..) {
        if barrier.step == NEVER {
            continue;
        }
        if first || earliest(barrier) > call {
            call = barrier.step;
            first = false;
        }
        batched.push(Batched { at: call, barrier: number });
    }
    gather_buffers(stores, pending, &mut batched, |_| 0, |_, barrier| earliest(barrier));
    batched
}

/// The same on several queues: a barrier stands before a step of its own queue, and behind the wait that it comes after.
pub(super) fn batch_on(queues: &Queues, stores: &[Store], pending: &[Pending]) -> Vec<Batched> {
    let earliest = |number, barrier: &Pending| match queues.is_held(number) {
        true => barrier.step,
        false => earliest(barrier),
    };
    let mut batched = Vec::with_capacity(pending.len());
    let mut calls = [None; QUEUES];
    for (barrier, number) in pending.iter().zip(0_u32..).filter(|(barrier, _)| barrier.step != NEVER) {
        let call = &mut calls[queues.at(barrier.step)];
        let at = call.filter(|at| *at >= earliest(number, barrier)).unwrap_or(barrier.step);
        *call = Some(at);
        batched.push(Batched { at, barrier: number });
    }
    batched.sort_by_key(|it| it.at);
    gather_buffers(stores, pending, &mut batched, |step| queues.at(step), earliest);
    batched
}

/// The first step that a barrier may stand before.
fn earliest(barrier: &Pending) -> u32 {
    barrier.after.wrapping_add(1)
}

/// Moves the barriers of buffers into as few of the calls as their places allow. They come in the order of the steps that
/// need them; `queue_of` tells the queue of a step.
fn gather_buffers(
    stores: &[Store],
    pending: &[Pending],
    batched: &mut [Batched],
    queue_of: impl Fn(u32) -> usize,
    earliest: impl Fn(u32, &Pending) -> u32,
) {
    let of_buffer = |it: &Batched| stores[pending[it.barrier as usize].store as usize].image().is_none();
    if !batched.iter().any(of_buffer) {
        return;
    }
    let mut calls: [Vec<u32>; QUEUES] = Default::default();
    batched.iter().for_each(|it| calls[queue_of(it.at)].push(it.at));
    let mut gathered: [Option<u32>; QUEUES] = [None; QUEUES];
    for it in batched.iter_mut().filter(|it| of_buffer(it)) {
        let barrier = &pending[it.barrier as usize];
        let queue = queue_of(it.at);
        let (calls, gathered) = (&calls[queue], &mut gathered[queue]);
        if gathered.is_none_or(|at| at < earliest(it.barrier, barrier)) {
            let last = calls.partition_point(|at| *at <= barrier.step).saturating_sub(1);
            *gathered = calls.get(last).copied();
        }
        it.at = gathered.unwrap_or(it.at);
    }
    batched.sort_by_key(|it| it.at);
}
