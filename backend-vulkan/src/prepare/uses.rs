//! Where in a frame each image and buffer is used first and last.

use framewright_graph::plan::{BufferId, ImageId, Plan, Resource, StepId};

/// First and last step that touch an image or buffer, barriers included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StepSpan {
    pub(crate) first: StepId,
    pub(crate) last: StepId,
}

/// The first and last uses of a Plan.
pub(crate) struct ResourceUses {
    images: Vec<Option<StepSpan>>,
    buffers: Vec<Option<StepSpan>>,
}

impl ResourceUses {
    /// The uses of `plan`.
    pub(crate) fn new(plan: &Plan) -> ResourceUses {
        let mut uses = ResourceUses { images: vec![None; plan.images.len()], buffers: vec![None; plan.buffers.len()] };
        for (id, step) in (0..).map(StepId).zip(&plan.steps) {
            step.touched().for_each(|resource| {
                let span = match resource {
                    Resource::Image(ImageId(id)) => &mut uses.images[id as usize],
                    Resource::Buffer(BufferId(id)) => &mut uses.buffers[id as usize],
                };
                span.get_or_insert(StepSpan { first: id, last: id }).last = id;
            });
        }
        uses
    }

    /// Where an image or buffer is used; `None` if nowhere.
    pub(crate) fn of(&self, resource: Resource) -> Option<StepSpan> {
        match resource {
            Resource::Image(image) => self.images[image.0 as usize],
            Resource::Buffer(buffer) => self.buffers[buffer.0 as usize],
        }
    }
}
