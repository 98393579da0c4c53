//! From a Plan to the objects that executing it needs, frame by frame: views, pipelines, descriptor sets.

use super::descriptions::part;
use super::history::RingCache;
use super::pass::{PreparedDispatch, PreparedDraw, prepare_dispatch, prepare_draw};
use super::physical::PhysicalResources;
use crate::base::Error;
use crate::gpu::Gpu;
use crate::memory::{View, ViewShape};
use crate::shaders::ShaderLibrary;
use framewright_graph::plan::{self, ImageId, Plan, RenderScope, Resource, Work};
use framewright_graph::vulkan::Subresources;
use std::sync::Arc;

/// Everything that a Plan needs on a device.
pub(crate) struct PreparedPlan {
    pub(crate) physical: PhysicalResources,
    /// By step.
    pub(crate) steps: Vec<PreparedStep>,
}

/// A step's objects.
pub(crate) enum PreparedStep {
    /// Of a rendering scope.
    Render(PreparedScope),
    /// Of a dispatch.
    Dispatch(PreparedDispatch),
    /// Of anything else: none.
    Plain,
}

/// A rendering scope's objects.
pub(crate) struct PreparedScope {
    pub(crate) views: RingCache<ScopeViews>,
    pub(crate) passes: Vec<PreparedDraw>,
}

/// A rendering scope's attachments.
pub(crate) struct ScopeViews {
    pub(crate) color: Vec<AttachmentViews>,
    pub(crate) depth: Option<Arc<AttachmentViews>>,
    /// Depth and stencil of one image share a view.
    pub(crate) stencil: Option<Arc<AttachmentViews>>,
}

/// An attachment's view and that of its resolve target.
pub(crate) struct AttachmentViews {
    pub(crate) attachment: View,
    pub(crate) resolve: Option<View>,
}

impl PreparedPlan {
    /// Makes everything that the first frame needs. The Plan must have passed [`crate::prepare::check()`].
    pub(crate) fn new(gpu: &Arc<Gpu>, plan: &Plan, shaders: &mut ShaderLibrary) -> Result<PreparedPlan, Error> {
        let physical = PhysicalResources::new(gpu, plan)?;
        let mut steps = Vec::new();
        for step in &plan.steps {
            steps.push(match &step.work {
                Work::Render(scope) => PreparedStep::Render(self::scope(gpu, plan, &physical, scope, shaders)?),
                Work::Dispatch(pass) => PreparedStep::Dispatch(prepare_dispatch(gpu, plan, &physical, pass, shaders)?),
                _ => PreparedStep::Plain,
            });
        }
        let mut prepared = PreparedPlan { physical, steps };
        prepared.prepare_frame(gpu, plan, 0)?;
        Ok(prepared)
    }

    /// Makes what frame `frame` needs and no frame before it needed.
    pub(crate) fn prepare_frame(&mut self, gpu: &Arc<Gpu>, plan: &Plan, frame: u64) -> Result<(), Error> {
        let physical = &self.physical;
        for (step, made) in plan.steps.iter().zip(&mut self.steps) {
            match (&step.work, made) {
                (Work::Render(scope), PreparedStep::Render(made)) => {
                    made.views.prepare(frame, || views(plan, physical, scope, frame))?;
                    for pass in &mut made.passes {
                        pass.sets.prepare(frame, || pass.template.fill(gpu, physical, frame))?;
                    }
                }
                (Work::Dispatch(_), PreparedStep::Dispatch(made)) => {
                    made.sets.prepare(frame, || made.template.fill(gpu, physical, frame))?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Forgets all views and sets, since another image or buffer was handed in. Nothing may be in flight.
    pub(crate) fn forget(&mut self) {
        for step in &mut self.steps {
            match step {
                PreparedStep::Render(scope) => {
                    scope.views.forget();
                    scope.passes.iter_mut().for_each(|pass| pass.sets.forget());
                }
                PreparedStep::Dispatch(pass) => pass.sets.forget(),
                PreparedStep::Plain => {}
            }
        }
    }
}

fn scope(
    gpu: &Arc<Gpu>,
    plan: &Plan,
    physical: &PhysicalResources,
    scope: &RenderScope,
    shaders: &mut ShaderLibrary,
) -> Result<PreparedScope, Error> {
    let mut passes = Vec::new();
    for pass in &scope.passes {
        passes.push(prepare_draw(gpu, plan, physical, scope, pass, shaders)?);
    }
    let attachments = scope.color.iter().chain(&scope.depth).chain(&scope.stencil);
    let images = attachments.flat_map(|it| [Some(it.image), it.resolve.as_ref().map(|resolve| resolve.image)]);
    let period = physical.period(images.flatten().map(Resource::Image));
    Ok(PreparedScope { views: RingCache::new(period), passes })
}

fn views(plan: &Plan, physical: &PhysicalResources, scope: &RenderScope, frame: u64) -> Result<ScopeViews, Error> {
    let view = |id: ImageId, range: Subresources| {
        let image = plan.image(id);
        // A view for an attachment has all planes.
        let range = Subresources { aspects: image.format.aspects(), ..part(image, range) };
        let shape = if range.layers > 1 { ViewShape::Layers } else { ViewShape::Flat };
        View::new(physical.image(id, frame), range, shape)
    };
    let views = |attachment: &plan::Attachment| {
        let resolve = attachment.resolve.as_ref().map(|resolve| view(resolve.image, resolve.range)).transpose()?;
        Ok::<_, Error>(AttachmentViews { attachment: view(attachment.image, attachment.range)?, resolve })
    };
    let color = scope.color.iter().map(views).collect::<Result<_, _>>()?;
    let depth = scope.depth.as_ref().map(views).transpose()?.map(Arc::new);
    let stencil = match (&scope.depth, &scope.stencil, &depth) {
        (Some(of_depth), Some(of_stencil), Some(of_both)) if shares(of_depth, of_stencil) => Some(of_both.clone()),
        (_, of_stencil, _) => of_stencil.as_ref().map(views).transpose()?.map(Arc::new),
    };
    Ok(ScopeViews { color, depth, stencil })
}

/// Whether two attachments are planes of one image, and their resolve targets too.
fn shares(depth: &plan::Attachment, stencil: &plan::Attachment) -> bool {
    let target = |it: &plan::Attachment| it.resolve.as_ref().map(|resolve| resolve.image);
    depth.image == stencil.image && (target(stencil).is_none() || target(depth) == target(stencil))
}
