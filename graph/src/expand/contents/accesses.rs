//! The reads and writes of a pass, part by part, as far as its images and buffers are known.

use crate::base::Span;
use crate::expand::resources::Resources;
use crate::frame::check::contents::Contents;
use crate::frame::tracked_parts::{self, Grids, Parts};
use crate::frame::{Access, BufferIndex, Effect, Image, ImageIndex, Pass, Resource};
use crate::vulkan::{Format, Subresources};

/// An access to a part of an image or a buffer of this frame.
pub(in crate::expand) struct Use {
    pub(in crate::expand) resource: Resource,
    /// The part, with planes named.
    pub(in crate::expand) part: Subresources,
    pub(in crate::expand) span: Span,
    /// Whether it is a target that the pass draws into.
    pub(super) attaches: bool,
    /// Whether it needs what is there.
    pub(in crate::expand) reads: bool,
    /// Whether it writes, or is a target.
    pub(in crate::expand) writes: bool,
}

/// The images of the frame, and how its passes cut them into parts.
pub(in crate::expand) struct CutImages {
    images: Vec<Image>,
    buffers: usize,
    grids: Grids,
}

impl CutImages {
    pub(in crate::expand) fn new<'p>(resources: &Resources<'_>, passes: impl Iterator<Item = &'p Pass>) -> CutImages {
        let unknown = || Image::new("", Format::R8G8B8A8_UNORM, 1, 1);
        let images = resources.images.iter().map(|image| image.as_ref().map_or_else(unknown, |it| it.image.clone()));
        let images: Vec<Image> = images.collect();
        let grids = Grids::new(&images, passes);
        CutImages { images, buffers: resources.buffers.len(), grids }
    }

    pub(in crate::expand) fn parts(&self) -> Parts<'_> {
        Parts::new(&self.images, self.buffers, &self.grids)
    }
}

/// The contents before the first pass. Something that is wrong itself counts as written: nothing more is said of it.
pub(in crate::expand) fn contents<'p>(resources: &Resources<'_>, parts: &'p Parts<'p>) -> Contents<'p> {
    let mut contents = Contents::new(parts, resources.pipeline.passes.len());
    let images = (0..).map(|at| Resource::Image(ImageIndex(at))).take(resources.images.len());
    let buffers = (0..).map(|at| Resource::Buffer(BufferIndex(at))).take(resources.buffers.len());
    let holds = |of: &Resource| resources.lifetime(*of).is_none_or(|lifetime| lifetime.has_contents(*of));
    images.chain(buffers).filter(holds).for_each(|of| contents.begin(of));
    contents
}

/// Shows what `pass` uses of this frame, as far as it is known.
pub(super) fn for_each_use(resources: &Resources<'_>, pass: &Pass, mut see: impl FnMut(Use)) {
    pass.visit_accesses(&mut |access: Access<'_>| {
        let (resource, span, attaches) = (access.resource(), access.span(), access.attaches());
        let image = match resource {
            Resource::Image(index) => resources.image(index).map(|image| &image.image),
            Resource::Buffer(_) => None,
        };
        if access.frames_ago() > 0 || image.is_none() && access.image_index().is_some() {
            return;
        }
        access.for_each_effect(pass, image, |Effect { range, reads, writes }| {
            let part = tracked_parts::part_of(image, range);
            see(Use { resource, part, span, attaches, reads, writes: writes || attaches });
        });
    });
}

/// What `pass` uses of this frame, as [`for_each_use`] shows it.
pub(in crate::expand) fn uses(resources: &Resources<'_>, pass: &Pass) -> Vec<Use> {
    let mut uses = Vec::new();
    for_each_use(resources, pass, |used| uses.push(used));
    uses
}

/// Images and buffers whose contents `pass` would make, were it on.
pub(super) fn would_write(pass: &Pass) -> impl Iterator<Item = (Resource, Span)> {
    let writes = |access: &Access<'_>| access.attaches() || access.writes(pass, None);
    pass.accesses().filter(writes).map(|access| (access.resource(), access.span()))
}
