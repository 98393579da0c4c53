//! Imports: external images and buffers belong to the embedding program, which brings each to the state that the Plan relies
//! on. For those that the executor made itself, it does so: before each frame, from the state that the last frame left.

use super::ownership::Ownership;
use crate::base::convert;
use crate::commands::{barriers, memory_change, state_change};
use crate::prepare::{Frame, PhysicalResources, ResourceUses};
use ash::vk::{self, Handle};
use framewright_graph::plan::{OutsideTransfer, OutsideWay, Plan, Resource, Role, StepId, Wait};
use framewright_graph::vulkan::{Layout, OutsideOwner, Sharing, Stages, State, Subresources};

/// One external image or buffer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Import {
    pub(super) resource: Resource,
    pub(super) before: State,
    pub(super) after: State,
    /// The first step that touches it.
    pub(crate) first: StepId,
    /// The last step that touches it.
    pub(crate) last: StepId,
    /// Who has it between frames: the Plan says it, and what frames before did with each that stands for it.
    pub(super) ownership: Ownership,
    /// Where another queue than the first one's used it last, in the frame before: what is to be waited for.
    pub(crate) wait: Option<Wait>,
}

impl Import {
    /// Everything external that `plan` touches.
    pub(crate) fn all(plan: &Plan, uses: &ResourceUses) -> Vec<Import> {
        let images = plan.images.iter().map(|it| (Resource::Image(it.id), &it.role));
        let buffers = plan.buffers.iter().map(|it| (Resource::Buffer(it.id), &it.role));
        let import = |(resource, role): (Resource, &Role)| {
            let Role::External { before, after, owner } = role else { return None };
            let span = uses.of(resource)?;
            let queue = |step: StepId| plan.steps[step.0 as usize].queue;
            let stages = Stages::ALL_COMMANDS;
            let other = queue(span.first) != queue(span.last);
            let wait = other.then_some(Wait { step: span.last, frames_ago: 1, stages });
            let (before, after) = (*before, *after);
            let (first, last, ownership) = (span.first, span.last, Ownership::of(*owner));
            Some(Import { resource, before, after, first, last, ownership, wait })
        };
        images.chain(buffers).filter_map(import).collect()
    }

    /// Whether the executor made it itself.
    pub(super) fn is_own(&self, physical: &PhysicalResources) -> bool {
        match self.resource {
            Resource::Image(image) => !physical.image(image, 0).is_foreign(),
            Resource::Buffer(buffer) => !physical.buffer(buffer, 0).is_foreign(),
        }
    }

    /// Who outside of the device has what stands for it in a frame.
    pub(super) fn holder(&self, physical: &PhysicalResources, frame: u64) -> Option<OutsideOwner> {
        if self.is_own(physical) {
            return None;
        }
        self.ownership.holder(raw(physical, self.resource, frame))
    }

    /// Notes that a frame, of this number among the executor's own, is on its way. The program was told the number `told`.
    pub(super) fn drawn(&mut self, physical: &PhysicalResources, frame: u64, told: u64) {
        let is_given = matches!(self.resource, Resource::Buffer(_)) || self.after.layout != Layout::Undefined;
        if is_given && !self.is_own(physical) {
            self.ownership.drawn(raw(physical, self.resource, frame), told);
        }
    }

    /// Records what takes it over from an outside owner, ahead of the first step that accesses the resource, and the barrier from
    /// `after` to `before`. There is no such barrier in the first frame, for resources that the program imports itself, and if
    /// `before` equals `after`: then the Plan's own barrier waits for all accesses of the frame before.
    pub(crate) fn record(&self, frame: &Frame<'_>, commands: vk::CommandBuffer) {
        self.record_taking(frame, commands);
        let Import { before, after, .. } = *self;
        if frame.number == 0 || !self.is_own(frame.physical) || before == after {
            return;
        }
        match self.resource {
            Resource::Image(id) if before.layout != Layout::Undefined => {
                let image = frame.plan.image(id);
                let whole = Subresources::all(image.format, image.mips, image.made_layers());
                let raw = frame.image(id).raw;
                barriers(frame.gpu, commands, &[], &[state_change(raw, whole, after, before)]);
            }
            _ if before.stages.contains(after.stages) && after.accesses.writes().is_empty() => {}
            _ => {
                let next = if before.stages.is_empty() { Stages::ALL_COMMANDS } else { before.stages };
                let next = State { stages: next, ..before };
                barriers(frame.gpu, commands, &[memory_change(after, next)], &[]);
            }
        }
    }
}

impl Import {
    /// Records what takes it over before its first step, as the Plan says. What a frame gave to another owner than the Plan's is taken from
    /// that one, and what a frame kept isn't taken.
    fn record_taking(&self, frame: &Frame<'_>, commands: vk::CommandBuffer) {
        let Some(holder) = self.holder(frame.physical, frame.number) else { return };
        let planned = self.transfer(frame, self.first, OutsideWay::Acquire);
        let left = || OutsideTransfer::acquire(self.resource, holder, frame.plan.role(self.resource));
        if let Some(transfer) = planned.or_else(left) {
            self.change_owner(frame, commands, &OutsideTransfer { owner: holder, ..transfer });
        }
    }

    /// Records what gives it back after its last step, as the Plan says.
    pub(crate) fn record_giving(&self, frame: &Frame<'_>, commands: vk::CommandBuffer) {
        if self.is_own(frame.physical) {
            return;
        }
        if let Some(transfer) = self.transfer(frame, self.last, OutsideWay::Release) {
            self.change_owner(frame, commands, &transfer);
        }
    }

    /// The transfer of the Plan that a step makes.
    fn transfer(&self, frame: &Frame<'_>, step: StepId, way: OutsideWay) -> Option<OutsideTransfer> {
        let transfers = &frame.plan.steps[step.0 as usize].outside;
        transfers.iter().find(|it| it.resource == self.resource && it.way == way).copied()
    }

    fn change_owner(&self, frame: &Frame<'_>, commands: vk::CommandBuffer, transfer: &OutsideTransfer) {
        let OutsideTransfer { owner, way, state, .. } = *transfer;
        let step = match way {
            OutsideWay::Acquire => self.first,
            OutsideWay::Release => self.last,
        };
        let (own, outside) = (self.own_family(frame, step), convert::outside_family(owner));
        let (from, to) = match way {
            OutsideWay::Acquire => (outside, own),
            OutsideWay::Release => (own, outside),
        };
        let [src, dst] = ends(state, way);
        match self.resource {
            Resource::Image(id) => {
                let image = frame.plan.image(id);
                let whole = Subresources::all(image.format, image.mips, image.made_layers());
                let layout = convert::layout(state.layout);
                let barrier = [vk::ImageMemoryBarrier2::default()
                    .src_stage_mask(src.0)
                    .src_access_mask(src.1)
                    .dst_stage_mask(dst.0)
                    .dst_access_mask(dst.1)
                    .old_layout(layout)
                    .new_layout(layout)
                    .src_queue_family_index(from)
                    .dst_queue_family_index(to)
                    .image(frame.image(id).raw)
                    .subresource_range(convert::range(whole))];
                record(frame, commands, vk::DependencyInfo::default().image_memory_barriers(&barrier));
            }
            Resource::Buffer(id) => {
                let barrier = [vk::BufferMemoryBarrier2::default()
                    .src_stage_mask(src.0)
                    .src_access_mask(src.1)
                    .dst_stage_mask(dst.0)
                    .dst_access_mask(dst.1)
                    .src_queue_family_index(from)
                    .dst_queue_family_index(to)
                    .buffer(frame.buffer(id).raw)
                    .size(vk::WHOLE_SIZE)];
                record(frame, commands, vk::DependencyInfo::default().buffer_memory_barriers(&barrier));
            }
        }
    }

    /// The queue family of a step; that of none, if all families of the device share it.
    fn own_family(&self, frame: &Frame<'_>, step: StepId) -> u32 {
        let families = &frame.gpu.queues.families;
        let sharing = match self.resource {
            Resource::Image(id) => frame.plan.image(id).sharing,
            Resource::Buffer(id) => frame.plan.buffers[id.0 as usize].sharing,
        };
        match sharing == Sharing::Concurrent && families.indices.len() > 1 {
            true => vk::QUEUE_FAMILY_IGNORED,
            false => families.family(frame.plan.steps[step.0 as usize].queue).index,
        }
    }
}

/// Vulkan's handle of what stands for it in a frame.
fn raw(physical: &PhysicalResources, resource: Resource, frame: u64) -> u64 {
    match resource {
        Resource::Image(id) => physical.image(id, frame).raw.as_raw(),
        Resource::Buffer(id) => physical.buffer(id, frame).raw.as_raw(),
    }
}

/// Stages and accesses of both ends of the barrier. The outside half has none of its own: semaphores order it.
fn ends(state: State, way: OutsideWay) -> [(vk::PipelineStageFlags2, vk::AccessFlags2); 2] {
    let own = (convert::stages(state.stages), convert::accesses(state.accesses));
    match way {
        OutsideWay::Acquire => [(vk::PipelineStageFlags2::ALL_COMMANDS, vk::AccessFlags2::NONE), own],
        OutsideWay::Release => [own, (vk::PipelineStageFlags2::NONE, vk::AccessFlags2::NONE)],
    }
}

fn record(frame: &Frame<'_>, commands: vk::CommandBuffer, info: vk::DependencyInfo<'_>) {
    // SAFETY: the command buffer is being recorded outside a scope, and what the barrier names lives.
    unsafe { frame.gpu.raw.cmd_pipeline_barrier2(commands, &info) };
}
