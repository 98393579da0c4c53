//! Eligible queues: which queues beside graphics can run a step.
//!
//! Drawing, blits and resolves need a graphics queue; so do copies and fills of depth, stencil and multisampled images.
//! A transfer queue copies, and fills buffers. Filling an image needs a compute queue at least. What a program records can be on a compute
//! queue, if it agrees and declares stages that are there.

use super::number::QUEUES;
use crate::compile::model::{AdaptedFrame, MemorySource, OpKind, PhysicalResource, Use};
use crate::compile::options::Options;
use crate::compile::scope::Step;
use crate::device::Profile;
use crate::frame::{Frame, Resource, Work};
use crate::plan::Queue;
use crate::vulkan::Stages;

/// Why a step can run only on the graphics queue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum GraphicsOnly {
    /// It is drawn, or inserted by the compiler.
    DrawnOrInserted,
    /// It is a blit.
    Blit,
    /// The embedding program records it.
    Custom,
    /// It has an effect that no image or buffer shows, in order with others.
    Effect,
    /// It copies or fills a depth, stencil or multisampled image.
    DepthOrMultisampled,
    /// It uses an image or buffer that is imported or leaves the frame.
    Outside,
    /// It doesn't run in every frame, so it saves nothing in most.
    Rare,
    /// The device has no other queue that can run it.
    NoQueue,
}

impl GraphicsOnly {
    /// The words of the note; `None` where there is none.
    pub(super) fn why(self) -> Option<&'static str> {
        match self {
            GraphicsOnly::DrawnOrInserted => None,
            GraphicsOnly::Blit => Some("blits need it"),
            GraphicsOnly::Custom => Some("the embedding program records it"),
            GraphicsOnly::Effect => Some("its effect comes in order with others that no image or buffer shows"),
            GraphicsOnly::DepthOrMultisampled => Some("copies and fills of depth, stencil or several samples need it"),
            GraphicsOnly::Outside => Some("what it touches is handed in or leaves the frame"),
            GraphicsOnly::Rare => Some("it doesn't run in every frame"),
            GraphicsOnly::NoQueue => Some("no other queue of the device can do it"),
        }
    }
}

/// The stages that a queue has.
fn stages(queue: Queue) -> Stages {
    match queue {
        Queue::Graphics => Stages::all(),
        Queue::Compute => Stages::ON_COMPUTE,
        Queue::Transfer => Stages::ON_TRANSFER,
    }
}

/// Finds the eligible queues of each step.
pub(super) struct EligibleQueues<'a> {
    pub(super) frame: &'a Frame,
    pub(super) adapted: &'a AdaptedFrame,
    pub(super) device: &'a Profile,
    pub(super) options: &'a Options,
}

impl EligibleQueues<'_> {
    /// The queues beside graphics that can run a step, by number.
    pub(super) fn of(&self, step: &Step) -> Result<[bool; QUEUES], GraphicsOnly> {
        let Step::Single(op) = step else { return Err(GraphicsOnly::DrawnOrInserted) };
        let kind = &self.adapted.ops[*op as usize];
        let OpKind::Pass(pass) = kind.kind else { return Err(GraphicsOnly::DrawnOrInserted) };
        let uses = self.adapted.uses(*op);
        let declared = &self.frame.passes[pass as usize];
        let work = &declared.work;
        let fills = work.filled().is_some();
        match work {
            _ if kind.side_effect => return Err(GraphicsOnly::Effect),
            Work::Custom { .. } if !declared.any_queue => return Err(GraphicsOnly::Custom),
            Work::Blit { .. } => return Err(GraphicsOnly::Blit),
            Work::Copy | Work::Fill { .. } | Work::Custom { .. }
                if uses.iter().any(|used| self.is_depth_or_multisampled(used)) =>
            {
                return Err(GraphicsOnly::DepthOrMultisampled);
            }
            Work::Draw { .. } | Work::Forward { .. } => return Err(GraphicsOnly::DrawnOrInserted),
            Work::Dispatch { .. } | Work::Copy | Work::Fill { .. } | Work::Custom { .. } => {}
        }
        if uses.iter().any(|used| self.is_outside(used)) {
            return Err(GraphicsOnly::Outside);
        }
        if !self.adapted.cadence(*op).is_always() {
            return Err(GraphicsOnly::Rare);
        }
        let images = || uses.iter().filter(|used| self.adapted.resources[used.resource as usize].image().is_some());
        // Poison fills images wherever they are used first.
        let fills_images = (fills || self.options.poison) && images().next().is_some();
        let mut eligible = [false; QUEUES];
        let queues = [(Queue::Compute, self.device.queues.compute), (Queue::Transfer, self.device.queues.transfer)];
        for (queue, has) in queues {
            let has_stages = uses.iter().all(|used| stages(queue).contains(used.stages) && self.is_found(used, queue));
            let refused = queue == Queue::Transfer && (fills_images || declared.is_custom());
            eligible[queue as usize] = has && has_stages && !refused;
        }
        if eligible.contains(&true) { Ok(eligible) } else { Err(GraphicsOnly::NoQueue) }
    }

    fn is_depth_or_multisampled(&self, used: &Use) -> bool {
        let image = self.adapted.resources[used.resource as usize].image();
        image.is_some_and(|image| image.format.is_depth() || image.samples > 1)
    }

    /// Whether something outside of the frame uses the same image or buffer. Imported buffers can be used on any one queue.
    fn is_outside(&self, used: &Use) -> bool {
        let resource = &self.adapted.resources[used.resource as usize];
        match resource.memory {
            MemorySource::Transient => false,
            MemorySource::Output => true,
            MemorySource::Imported { .. } => {
                resource.image().is_some() || resource.after.is_some() || self.has_owner(resource)
            }
            // The reader of an output comes after one queue.
            MemorySource::Persistent { .. } => self.adapted.outputs.contains(&used.resource),
        }
    }

    /// Whether somebody else than this device has it between frames: then one queue takes it over and gives it back.
    fn has_owner(&self, resource: &PhysicalResource) -> bool {
        let lifetime = match resource.of {
            Resource::Image(image) => &self.frame.images[image.0 as usize].lifetime,
            Resource::Buffer(buffer) => &self.frame.buffers[buffer.0 as usize].lifetime,
        };
        lifetime.owner().is_some()
    }

    /// Whether a queue can wait for what was done before the frame.
    fn is_found(&self, used: &Use, queue: Queue) -> bool {
        match self.adapted.resources[used.resource as usize].memory {
            MemorySource::Imported { before } => stages(queue).contains(before.stages),
            _ => true,
        }
    }
}
