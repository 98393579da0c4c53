//! `barriers`: all barriers of the Plan, in calls.

use super::aliasing_barriers::{self, AliasingBarrier};
use super::batches::{self, BarrierAtStep};
use super::subresource::SubresourceBarrier;
use super::timeline::AccessTimeline;
use super::{initial_barriers, redundant};
use crate::compile::memory::AliasEdge;
use crate::compile::model::{AdaptedFrame, MemorySource};
use crate::compile::queues::Queues;

/// All barriers and waits.
#[derive(Debug)]
pub(in crate::compile) struct Barriers {
    pub(in crate::compile) barriers: Vec<SubresourceBarrier>,
    /// Where they stand, in the order of steps.
    pub(in crate::compile) batched: Vec<BarrierAtStep>,
    /// The memory barriers between owners of memory, each with its step, in the order of steps.
    pub(in crate::compile) aliasing: Vec<(u32, AliasingBarrier)>,
    /// The queues, with all waits.
    pub(in crate::compile) queues: Queues,
    /// The number of steps, with the one behind all others if barriers or waits stand before it.
    pub(in crate::compile) steps: u32,
}

/// Completes `barriers`, which are those of the timeline, and puts them into calls. `steps`: the frame's own. `poison`: images are poisoned.
pub(in crate::compile) fn barriers(
    adapted: &AdaptedFrame,
    timeline: &AccessTimeline,
    barriers: Vec<SubresourceBarrier>,
    edges: &[AliasEdge],
    steps: u32,
    poison: bool,
) -> Barriers {
    let mut initial = initial_barriers::complete(adapted, timeline, barriers, edges);
    let mut batched = batches::batch(&initial.queues, &initial.barriers);
    if adapted.buffers > 0 {
        batches::gather_buffers(&initial.queues, &adapted.resources, &initial.barriers, &mut batched);
    }
    if adapted.buffers > 0 || adapted.resources.iter().any(|it| matches!(it.memory, MemorySource::Persistent { .. })) {
        redundant::take_out(adapted, timeline, poison, &mut initial, &mut batched);
    }
    let initial_barriers::CompleteBarriers { barriers, queues, aliased } = initial;
    let has_final_states =
        batched.last().is_some_and(|last| last.at == steps) || steps == 0 || !queues.waits(steps).is_empty();
    let steps = steps + u32::from(has_final_states);
    let aliasing = aliasing_barriers::memory_barriers(&queues, &aliased, &barriers, &batched, steps as usize);
    Barriers { barriers, batched, aliasing, queues, steps }
}
