//! Where in a frame each image and buffer is used first and last.

use framewright_graph::plan::{BufferId, ImageId, Pass, Plan, Resource, Side, Step, StepId, Work};
use framewright_graph::vulkan::Subresources;

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
            touched(step, &mut |resource| {
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

/// Calls `touch` for everything that a step touches, barriers included.
pub(super) fn touched(step: &Step, touch: &mut impl FnMut(Resource)) {
    for barrier in step.image_barriers.iter().chain(&step.releases) {
        touch(Resource::Image(barrier.image));
    }
    for hazard in step.memory_barriers.iter().flat_map(|it| &it.buffers) {
        touch(Resource::Buffer(hazard.buffer));
    }
    used(&step.work, &mut |resource, _| touch(resource));
}

/// The passes of a step.
pub(crate) fn passes(work: &Work) -> &[Pass] {
    match work {
        Work::Render(scope) => &scope.passes,
        Work::Dispatch(pass) | Work::Custom(pass) => std::slice::from_ref(pass),
        Work::Resolve(_) | Work::Copy(_) | Work::Blit(_) | Work::Fill(_) | Work::Export => &[],
    }
}

/// Calls `touch` for everything that a step's work uses, of images with the part.
pub(super) fn used(work: &Work, touch: &mut impl FnMut(Resource, Option<Subresources>)) {
    for pass in passes(work) {
        pass.accesses.iter().for_each(|access| touch(Resource::Image(access.image), Some(access.range)));
        pass.buffers.iter().for_each(|access| touch(Resource::Buffer(access.buffer), None));
    }
    match work {
        Work::Render(scope) => {
            for attachment in scope.color.iter().chain(&scope.depth).chain(&scope.stencil) {
                touch(Resource::Image(attachment.image), Some(attachment.range));
                if let Some(resolve) = &attachment.resolve {
                    touch(Resource::Image(resolve.image), Some(resolve.range));
                }
            }
        }
        Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => {
            transferred(&transfer.source, touch);
            transferred(&transfer.target, touch);
        }
        Work::Fill(fill) => transferred(&fill.target, touch),
        Work::Dispatch(_) | Work::Custom(_) | Work::Export => {}
    }
}

fn transferred(side: &Side, touch: &mut impl FnMut(Resource, Option<Subresources>)) {
    match side {
        Side::Image { image, range, .. } => touch(Resource::Image(*image), Some(*range)),
        Side::Buffer { buffer, .. } => touch(Resource::Buffer(*buffer), None),
    }
}
