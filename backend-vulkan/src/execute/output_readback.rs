//! Output readback: each frame copies its outputs to the host, where no later frame changes them.

use crate::base::Error;
use crate::commands::{Readback, first_plane, mip_extent};
use crate::prepare::{Frame, ResourceUses};
use ash::vk;
use framewright_graph::plan::{Output, Plan, Resource, Role, StepId};
use framewright_graph::vulkan::State;

/// The readback of one output.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OutputReadback {
    resource: Resource,
    state: State,
    /// The step after which it is as the frame leaves it.
    pub(crate) after: StepId,
}

impl OutputReadback {
    /// Every output of `plan`.
    ///
    /// # Errors
    /// [`Error::BadPlan`] if one of them is transient or never touched.
    pub(crate) fn all(plan: &Plan, uses: &ResourceUses) -> Result<Vec<OutputReadback>, Error> {
        let readback = |output: &Output| {
            let resource = output.resource;
            let role = plan.role(resource);
            let bad = || Error::BadPlan { what: "an output is transient, or no step touches it".to_owned() };
            let (Role::Persistent { after: state, .. } | Role::External { after: state, .. }) = role else {
                return Err(bad());
            };
            let span = uses.of(resource).ok_or_else(bad)?;
            Ok(OutputReadback { resource, state: *state, after: span.last })
        };
        plan.outputs.iter().map(readback).collect()
    }

    /// Room for it, in every frame.
    pub(crate) fn make(&self, frame: &Frame<'_>) -> Result<Readback, Error> {
        match self.resource {
            Resource::Image(image) => {
                let descriptor = frame.image(image).descriptor;
                let all = (0, mip_extent(&descriptor, 0));
                Readback::of_image(frame.gpu, &descriptor, first_plane(descriptor.format), all)
            }
            Resource::Buffer(buffer) => Readback::of_buffer(frame.gpu, frame.buffer(buffer).bytes),
        }
    }

    /// Lets it be read as far as the frame uses it.
    pub(crate) fn reach(&self, frame: &Frame<'_>, to: &mut Readback) {
        if let Resource::Image(image) = self.resource {
            let extent = frame.physical.level(frame.plan.image(image), 0, frame.number);
            to.read_as_far_as(&frame.image(image).descriptor, extent);
        }
    }

    /// Records the copy.
    pub(crate) fn record(&self, frame: &Frame<'_>, commands: vk::CommandBuffer, to: &Readback) {
        match self.resource {
            Resource::Image(image) => to.record_image(frame.gpu, commands, frame.image(image), self.state),
            Resource::Buffer(buffer) => to.record_buffer(frame.gpu, commands, frame.buffer(buffer), self.state),
        }
    }
}
