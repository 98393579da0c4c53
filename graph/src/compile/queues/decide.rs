//! `decide`: which queue each step runs on.
//!
//! A dispatch, copy or fill leaves the graphics queue if that gains ([`cost`](super::cost)). What can run beside it stands in
//! its window: graphics steps that it doesn't depend on and that don't depend on it. Each step that stays makes other windows
//! smaller and changes what other steps wait for, so all of them are weighed again until nothing changes. Steps that
//! wouldn't gain even if none of the others held them back stay first. That is a rule of thumb: a run could still become one with the next.

use super::cost::{Balance, Work};
use super::eligible_queues::{EligibleQueues, GraphicsOnly};
use super::notes::{self, QueueReason};
use super::number::QUEUES;
use super::step_uses::uses;
use super::windows::Steps;
use crate::compile::model::{AdaptedFrame, MemorySource, PhysicalIndex};
use crate::compile::options::Options;
use crate::compile::scope::Step;
use crate::device::Profile;
use crate::frame::Frame;
use crate::plan::{Note, Queue};

/// How often all steps are weighed. Frames that people write take a few rounds.
const MOST_ROUNDS: u32 = 32;

/// The queues that can run each step beside graphics, or why none can.
pub(super) type Bound = [Result<[bool; QUEUES], GraphicsOnly>];

/// The queue of each step.
#[derive(Debug)]
pub(super) struct Decision {
    /// Empty if all are on graphics, because the device has nothing else or nothing else is to be used.
    pub(super) queues: Vec<Queue>,
    /// Why each pass that isn't drawn runs on its queue.
    pub(super) notes: Vec<Note>,
}

/// Decides which queue each step runs on. Steps that do nothing make no difference.
pub(super) fn decide(
    frame: &Frame,
    adapted: &AdaptedFrame,
    steps: &[Step],
    device: &Profile,
    options: &Options,
) -> Decision {
    if !options.queues || !(device.queues.compute || device.queues.transfer) {
        return Decision { queues: Vec::new(), notes: Vec::new() };
    }
    let eligible = EligibleQueues { frame, adapted, device, options };
    let bound: Vec<Result<[bool; QUEUES], GraphicsOnly>> = steps.iter().map(|step| eligible.of(step)).collect();
    let mut queues = wanted(frame, adapted, steps, &bound);
    let mut why: Vec<Option<QueueReason>> =
        bound.iter().map(|bound| bound.err().map(QueueReason::GraphicsOnly)).collect();
    // Where all steps are drawn, there is nothing to weigh.
    // Steps that don't run in every frame have nothing beside them in the others.
    let runs_always = |step: &Step| step.ops().iter().all(|op| adapted.cadence(*op).is_always());
    let beside = |step: u32| bound[step as usize].is_err() && runs_always(&steps[step as usize]);
    let work = || Work::new(adapted, steps, beside, device.queues.wait_bytes);
    let work = bound.iter().any(Result::is_ok).then(work);
    for round in 0.. {
        let Some(work) = work.as_ref().filter(|_| queues.iter().any(|queue| *queue != Queue::Graphics)) else { break };
        let windows = Steps { adapted, steps, queues: &queues, sharing: device.queues.sharing }.beside();
        let balances = work.balances(&queues, &windows);
        let hopeless = balances.iter().flatten().any(Balance::is_hopeless);
        let mut stays = vec![false; steps.len()];
        for (at, balance) in balances.iter().enumerate() {
            if let Some(balance) = balance {
                why[at] =
                    Some(if round == MOST_ROUNDS { QueueReason::Undecided } else { QueueReason::Balance(*balance) });
                stays[at] = round == MOST_ROUNDS || if hopeless { balance.is_hopeless() } else { !balance.gains() };
            }
        }
        for at in split_users(adapted, steps, &queues, &stays) {
            (stays[at], why[at]) = (true, Some(QueueReason::Split));
        }
        if !stays.contains(&true) {
            break;
        }
        for (queue, _) in queues.iter_mut().zip(&stays).filter(|(_, stays)| **stays) {
            *queue = Queue::Graphics;
        }
    }
    let notes = notes::notes(frame, adapted, steps, &queues, &why);
    Decision { queues, notes }
}

/// The queue that each step would leave graphics for. A transfer of what dispatches use goes to the compute queue: that
/// saves waits.
fn wanted(frame: &Frame, adapted: &AdaptedFrame, steps: &[Step], bound: &Bound) -> Vec<Queue> {
    let [compute, transfer] = [Queue::Compute, Queue::Transfer].map(|queue| queue as usize);
    let mut dispatched = vec![false; adapted.resources.len()];
    for (step, able) in steps.iter().zip(bound) {
        if able.is_ok_and(|able| able[compute]) && is_dispatch(frame, adapted, step) {
            uses(adapted, step).for_each(|(resource, ..)| dispatched[resource as usize] = true);
        }
    }
    let choose = |(step, able): (&Step, &Result<[bool; QUEUES], GraphicsOnly>)| match able {
        Err(_) => Queue::Graphics,
        Ok(able) if able[transfer] => {
            let beside = able[compute] && uses(adapted, step).any(|(resource, ..)| dispatched[resource as usize]);
            if beside { Queue::Compute } else { Queue::Transfer }
        }
        Ok(_) => Queue::Compute,
    };
    steps.iter().zip(bound).map(choose).collect()
}

fn is_dispatch(frame: &Frame, adapted: &AdaptedFrame, step: &Step) -> bool {
    let pass = step.ops().first().and_then(|op| adapted.ops[*op as usize].kind.pass());
    pass.is_some_and(|pass| frame.passes[pass as usize].work.groups().is_some())
}

/// Imported images and buffers are used on one queue, or on graphics: the state before the frame names the stages of one queue.
/// The steps that stay for that.
fn split_users(adapted: &AdaptedFrame, steps: &[Step], queues: &[Queue], stays: &[bool]) -> Vec<usize> {
    let is_imported =
        |resource: PhysicalIndex| matches!(adapted.resources[resource as usize].memory, MemorySource::Imported { .. });
    let mut user: Vec<Option<Queue>> = vec![None; adapted.resources.len()];
    let mut split = vec![false; adapted.resources.len()];
    for (at, step) in steps.iter().enumerate() {
        let queue = if stays[at] { Queue::Graphics } else { queues[at] };
        for (resource, ..) in uses(adapted, step).filter(|(resource, ..)| is_imported(*resource)) {
            split[resource as usize] |= user[resource as usize].replace(queue).is_some_and(|other| other != queue);
        }
    }
    let moves = (0..steps.len()).filter(|at| queues[*at] != Queue::Graphics && !stays[*at]);
    moves.filter(|at| uses(adapted, &steps[*at]).any(|(resource, ..)| split[resource as usize])).collect()
}
