//! Imports: external images and buffers belong to the embedding program, which brings each to the state that the Plan relies
//! on. For those that the executor made itself, it does so: before each frame, from the state that the last frame left.

use super::outside_owner::OutsideOwner;
use crate::commands::{barriers, memory_change, state_change};
use crate::prepare::{Frame, PhysicalResources, ResourceUses};
use ash::vk;
use framewright_graph::plan::{Plan, Resource, Role, StepId, Wait};
use framewright_graph::vulkan::{Layout, Stages, State, Subresources};

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
    /// Who has it between frames, if it is somebody outside of the device.
    pub(super) owner: Option<OutsideOwner>,
    /// Where another queue than the first one's used it last, in the frame before: what is to be waited for.
    pub(crate) wait: Option<Wait>,
}

impl Import {
    /// Everything external that `plan` touches.
    pub(crate) fn all(plan: &Plan, uses: &ResourceUses) -> Vec<Import> {
        let images = plan.images.iter().map(|it| (Resource::Image(it.id), &it.role));
        let buffers = plan.buffers.iter().map(|it| (Resource::Buffer(it.id), &it.role));
        let import = |(resource, role): (Resource, &Role)| {
            let Role::External { before, after } = role else { return None };
            let span = uses.of(resource)?;
            let queue = |step: StepId| plan.steps[step.0 as usize].queue;
            let stages = Stages::ALL_COMMANDS;
            let other = queue(span.first) != queue(span.last);
            let wait = other.then_some(Wait { step: span.last, frames_ago: 1, stages });
            let (before, after) = (*before, *after);
            Some(Import { resource, before, after, first: span.first, last: span.last, owner: None, wait })
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

    /// Records what takes it over from an outside owner, and the barrier from `after` to `before`, ahead of the first step that accesses the resource. Nothing is recorded
    /// in the first frame, for resources that the program imports itself, and if `before` equals `after`: then the Plan's
    /// own barrier waits for all accesses of the frame before.
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
