//! The results of all stages, from which the parts of a Plan are made.

use crate::compile::memory::Placed;
use crate::compile::model::{Adapted, Kind, Op, PhysicalIndex, PhysicalResource, SubresourceIndex};
use crate::compile::retain::LoadStoreOps;
use crate::compile::scope::Scoped;
use crate::compile::structure::{Settled, Structure};
use crate::compile::sync::Barriers;
use crate::device::Profile;
use crate::frame::{Frame, Work};
use crate::plan::{BufferId, Cause, ImageId, Inserted, Resource};
use crate::vulkan::Subresources;
use std::sync::Arc;

/// The results of all stages.
pub(in crate::compile) struct StageResults<'a> {
    pub(super) frame: &'a Frame,
    pub(super) device: &'a Profile,
    pub(super) structure: &'a Structure,
    pub(super) adapted: &'a Adapted,
    pub(super) scoped: &'a Scoped,
    pub(super) load_store: &'a LoadStoreOps,
    pub(super) placed: &'a Placed,
    pub(super) sync: &'a Barriers,
    pub(super) exact_memory: bool,
    /// The empty name, for parts without a name.
    pub(super) nothing: Arc<str>,
}

impl<'a> StageResults<'a> {
    pub(in crate::compile) fn new(
        frame: &'a Frame,
        device: &'a Profile,
        structure: &'a Structure,
        settled: &'a Settled,
    ) -> StageResults<'a> {
        StageResults {
            frame,
            device,
            structure,
            adapted: &structure.adapted,
            scoped: &structure.scoped,
            load_store: &structure.load_store,
            placed: &settled.placed,
            sync: &settled.barriers,
            exact_memory: settled.exact_memory,
            nothing: Arc::default(),
        }
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
        Some(because) => Cause::Inserted(Box::new(Inserted { because: because.to_string(), at })),
        None => Cause::Written(at),
    }
}

/// The work of the pass that an operation is or stands in for.
pub(super) fn frame_work<'f>(results: &StageResults<'f>, op: &Op) -> Option<&'f Work> {
    op.kind.pass().map(|pass| &results.frame.passes[pass as usize].work)
}
