//! What was decided about a frame, beside the frame: the parts of a Plan are made of both.

use crate::compile::memory::PlacedResources;
use crate::compile::model::{AdaptedFrame, Kind, Op, PhysicalIndex, PhysicalResource, SubresourceIndex};
use crate::compile::retain::LoadStoreOps;
use crate::compile::scope::ScopedSteps;
use crate::compile::stages::Decisions;
use crate::compile::sync::Barriers;
use crate::frame::{Frame, Work};
use crate::plan::{BufferId, Cause, ImageId, InsertionCause, Resource};
use crate::vulkan::Subresources;
use std::sync::Arc;

/// What was decided about a frame, beside the frame.
pub(super) struct StageResults<'a> {
    pub(super) frame: &'a Frame,
    pub(super) decisions: &'a Decisions,
    pub(super) adapted: &'a AdaptedFrame,
    pub(super) scoped: &'a ScopedSteps,
    pub(super) load_store: &'a LoadStoreOps,
    pub(super) placed: &'a PlacedResources,
    pub(super) sync: &'a Barriers,
    /// The empty name, for parts without a name.
    pub(super) nothing: Arc<str>,
}

impl<'a> StageResults<'a> {
    pub(super) fn new(frame: &'a Frame, decisions: &'a Decisions) -> StageResults<'a> {
        let Decisions { adapted, scoped, load_store, placed, barriers: sync, .. } = decisions;
        StageResults { frame, decisions, adapted, scoped, load_store, placed, sync, nothing: Arc::default() }
    }
}

impl StageResults<'_> {
    /// The subresources that a subresource is.
    pub(super) fn subresources(&self, resource: PhysicalIndex, subresource: SubresourceIndex) -> Subresources {
        let resource = &self.adapted.resources[resource as usize];
        let grid = resource.grid.as_ref();
        grid.map_or(resource.all(), |grid| grid.range(subresource - resource.first_subresource))
    }
}

/// The id of a physical resource in the Plan.
pub(super) fn resource_id(resource: &PhysicalResource) -> Resource {
    match resource.kind {
        Kind::Image(_) => Resource::Image(ImageId(resource.id)),
        Kind::Buffer(_) => Resource::Buffer(BufferId(resource.id)),
    }
}

/// Why an operation is in the Plan.
pub(super) fn cause(results: &StageResults<'_>, op: &Op) -> Cause {
    if let Some(why) = op.kind.inserted() {
        return Cause::Inserted(Box::new(why.clone()));
    }
    let Some(pass) = op.kind.pass().map(|pass| &results.frame.passes[pass as usize]) else {
        return Cause::Written(None);
    };
    let at = results.frame.sources.place(pass.span);
    match &pass.inserted {
        Some(because) => Cause::Inserted(Box::new(InsertionCause { because: because.to_string(), at })),
        None => Cause::Written(at),
    }
}

/// The work of the pass that an operation is or stands in for.
pub(super) fn frame_work<'f>(frame: &'f Frame, op: &Op) -> Option<&'f Work> {
    op.kind.pass().map(|pass| &frame.passes[pass as usize].work)
}
