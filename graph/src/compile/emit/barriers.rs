//! Barriers of each step: those of neighbouring subresources become one.

use super::stage_results::{StageResults, resource_id};
use crate::compile::steps::NEVER;
use crate::compile::sync::{BarrierAtStep, SubresourceBarrier};
use crate::frame::tracked_parts::join;
use crate::plan::{BufferHazard, BufferId, Hazard, ImageBarrier, ImageId, MemoryBarrier, StepId};
use crate::vulkan::{Accesses, Subresources};

/// Hands out the barriers step by step.
pub(super) struct StepBarriers<'p, 'a> {
    results: &'p StageResults<'a>,
    batched: &'p [BarrierAtStep],
    memory: usize,
}

impl<'p, 'a> StepBarriers<'p, 'a> {
    pub(super) fn new(results: &'p StageResults<'a>) -> StepBarriers<'p, 'a> {
        StepBarriers { results, batched: &results.sync.batched, memory: 0 }
    }

    /// The barriers of step number `step`; steps are asked for in order.
    pub(super) fn of(&mut self, step: u32) -> (Vec<MemoryBarrier>, Vec<ImageBarrier>) {
        let here = self.batched.iter().take_while(|it| it.at == step).count();
        let (here, rest) = self.batched.split_at(here);
        self.batched = rest;
        let mut memory = Vec::new();
        if let Some((at, scopes)) = self.results.sync.aliasing.get(self.memory)
            && *at == step
        {
            self.memory += 1;
            let resources = &self.results.adapted.resources;
            let hand_overs = scopes.resources.iter();
            memory.push(MemoryBarrier {
                src_stages: scopes.src_stages,
                src_accesses: scopes.src_accesses,
                dst_stages: scopes.dst_stages,
                dst_accesses: Accesses::empty(),
                hand_overs: hand_overs
                    .map(|pair| pair.map(|resource| resource_id(&resources[resource as usize])))
                    .collect(),
                buffers: Vec::new(),
            });
        }
        let mut images = Vec::with_capacity(here.len());
        let mut buffers: Option<MemoryBarrier> = None;
        for it in here {
            let barrier = &self.results.sync.barriers[it.barrier as usize];
            let resource = &self.results.adapted.resources[barrier.resource as usize];
            if resource.image().is_none() {
                add_buffer(&mut buffers, barrier, resource.id);
                continue;
            }
            if barrier.hazard == Hazard::Ownership {
                // It is emitted with its other half: see `ownership`.
                continue;
            }
            let range = self.results.subresources(barrier.resource, barrier.subresource);
            add(&mut images, image_barrier(barrier, resource.id, range));
        }
        memory.extend(buffers);
        (memory, images)
    }
}

fn after(barrier: &SubresourceBarrier) -> Option<StepId> {
    (barrier.after != NEVER).then_some(StepId(barrier.after))
}

/// The step that needs a barrier; `None` for one that leaves a final state.
fn needed_by(barrier: &SubresourceBarrier) -> Option<StepId> {
    (barrier.hazard != Hazard::Export).then_some(StepId(barrier.step))
}

fn image_barrier(barrier: &SubresourceBarrier, image: u32, range: Subresources) -> ImageBarrier {
    ImageBarrier {
        image: ImageId(image),
        range,
        src_stages: barrier.src_stages,
        src_accesses: barrier.src_accesses,
        dst_stages: barrier.dst_stages,
        dst_accesses: barrier.dst_accesses,
        old_layout: barrier.old_layout,
        new_layout: barrier.new_layout,
        ownership: None,
        hazard: barrier.hazard,
        after: after(barrier),
        needed_by: needed_by(barrier),
    }
}

/// Adds a barrier, joined with those before it that differ from it only in their subresources.
fn add(barriers: &mut Vec<ImageBarrier>, mut new: ImageBarrier) {
    while let Some(last) = barriers.last()
        && last.image == new.image
        && (ImageBarrier {
            range: new.range,
            after: new.after,
            needed_by: new.needed_by,
            hazard: new.hazard,
            ..last.clone()
        }) == new
        && let Some(range) = join(last.range, new.range)
    {
        let needed_by = [last.needed_by, new.needed_by].into_iter().flatten().min();
        new = ImageBarrier { range, after: last.after.max(new.after), needed_by, ..new };
        barriers.pop();
    }
    barriers.push(new);
}

/// All buffers of a step share one memory barrier.
fn add_buffer(shared: &mut Option<MemoryBarrier>, barrier: &SubresourceBarrier, buffer: u32) {
    let shared = shared.get_or_insert_with(|| MemoryBarrier {
        src_stages: barrier.src_stages,
        src_accesses: barrier.src_accesses,
        dst_stages: barrier.dst_stages,
        dst_accesses: barrier.dst_accesses,
        hand_overs: Vec::new(),
        buffers: Vec::new(),
    });
    shared.src_stages |= barrier.src_stages;
    shared.src_accesses |= barrier.src_accesses;
    shared.dst_stages |= barrier.dst_stages;
    shared.dst_accesses |= barrier.dst_accesses;
    let (buffer, after, needed_by) = (BufferId(buffer), after(barrier), needed_by(barrier));
    shared.buffers.push(BufferHazard { buffer, hazard: barrier.hazard, after, needed_by });
}
