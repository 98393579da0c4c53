//! `synchronise`, last part: barriers are gathered into as few calls as their places allow.
//!
//! A barrier may stand anywhere behind the last step that it waits for and before the step that needs it. Taking the latest
//! place for the first one that has none yet, and putting every later one there that may stand there, gives the fewest calls
//! (the greedy choice for stabbing intervals).

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
pub(super) fn batch(pending: &[Pending]) -> Vec<Batched> {
    let mut batched = Vec::with_capacity(pending.len());
    let mut call = 0;
    let mut first = true;
    for (barrier, number) in pending.iter().zip(0_u32..) {
        if barrier.step == NEVER {
            continue;
        }
        let earliest = barrier.after.wrapping_add(1);
        if first || earliest > call {
            call = barrier.step;
            first = false;
        }
        batched.push(Batched { at: call, barrier: number });
    }
    batched
}

/// The same on several queues: a barrier stands before a step of its own queue, and behind the wait that it comes after.
pub(super) fn batch_on(queues: &Queues, pending: &[Pending]) -> Vec<Batched> {
    let mut batched = Vec::with_capacity(pending.len());
    let mut calls = [None; QUEUES];
    for (barrier, number) in pending.iter().zip(0_u32..).filter(|(barrier, _)| barrier.step != NEVER) {
        let earliest = if queues.is_held(number) { barrier.step } else { barrier.after.wrapping_add(1) };
        let call = &mut calls[queues.at(barrier.step)];
        let at = call.filter(|at| *at >= earliest).unwrap_or(barrier.step);
        *call = Some(at);
        batched.push(Batched { at, barrier: number });
    }
    batched.sort_by_key(|it| it.at);
    batched
}
