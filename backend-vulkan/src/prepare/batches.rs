//! Which steps of a Plan are submitted together.

use framewright_graph::plan::{Plan, Queue, StepId, Wait};
use std::collections::HashSet;
use std::ops::Range;

/// Steps that follow each other on one queue and are submitted together: only the first may wait for other queues, and
/// only for the last may they wait.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Batch {
    pub(crate) queue: Queue,
    pub(crate) steps: Range<usize>,
    pub(crate) waits: Vec<Wait>,
    /// Whether the timeline of its queue must reach the value of its last step when it is done.
    pub(crate) awaited: bool,
    /// Whether it is the frame's last on its queue.
    pub(crate) last: bool,
}

/// The batches of a frame, in the order in which they are submitted. `extra_waits` are waits that the Plan doesn't have; with
/// `step_by_step` each step is a batch that is waited for.
pub(crate) fn batches(plan: &Plan, extra_waits: &[(StepId, Wait)], step_by_step: bool) -> Vec<Batch> {
    let planned = plan.steps.iter().flat_map(|step| &step.waits);
    let awaited: HashSet<StepId> =
        planned.chain(extra_waits.iter().map(|(_, wait)| wait)).map(|wait| wait.step).collect();
    let mut batches: Vec<Batch> = Vec::new();
    for ((index, id), step) in (0_usize..).zip((0..).map(StepId)).zip(&plan.steps) {
        let mut waits = step.waits.clone();
        waits.extend(extra_waits.iter().filter(|(of, _)| *of == id).map(|(_, wait)| *wait));
        match batches.last_mut() {
            Some(batch) if batch.queue == step.queue && waits.is_empty() && !batch.awaited && !step_by_step => {
                batch.steps.end = index + 1;
                batch.awaited = awaited.contains(&id);
            }
            _ => batches.push(Batch {
                queue: step.queue,
                steps: index..index + 1,
                waits,
                awaited: step_by_step || awaited.contains(&id),
                last: false,
            }),
        }
    }
    for queue in [Queue::Graphics, Queue::Compute, Queue::Transfer] {
        if let Some(batch) = batches.iter_mut().rev().find(|batch| batch.queue == queue) {
            batch.last = true;
        }
    }
    batches
}
