//! The reads and writes of a pass, part by part, as far as its images and buffers are known.

use super::parts::{self, Cells};
use super::resources::Resources;
use crate::base::Span;
use crate::frame::{Access, Effect, Image, Pass, Resource};
use crate::vulkan::{Aspects, Subresources};

/// A read.
pub(super) struct Read {
    pub(super) resource: Resource,
    pub(super) cells: Cells,
    pub(super) frames_ago: u32,
    pub(super) span: Span,
}

/// A write.
pub(super) struct Write {
    pub(super) resource: Resource,
    pub(super) cells: Cells,
    pub(super) span: Span,
    /// How to clear the target, if the write may leave texels untouched: then it adds to the earlier contents.
    pub(super) continues: Option<&'static str>,
}

/// All of an image or buffer; `None` if nothing is known about it.
pub(super) fn whole(resources: &Resources<'_>, resource: Resource) -> Option<Cells> {
    part(resources, resource, &Subresources::WHOLE)
}

fn image<'r>(resources: &'r Resources<'_>, resource: Resource) -> Option<&'r Image> {
    match resource {
        Resource::Image(index) => Some(&resources.image(index)?.image),
        Resource::Buffer(_) => None,
    }
}

/// A part of an image, or a buffer.
pub(super) fn part(resources: &Resources<'_>, resource: Resource, range: &Subresources) -> Option<Cells> {
    match resource {
        Resource::Image(_) => Some(parts::cells(image(resources, resource)?, range)),
        Resource::Buffer(_) => Some(Cells { mips: 0..1, layers: 0..1, planes: Aspects::COLOR }),
    }
}

/// Shows the reads of `pass`. A target that the pass only adds to stands among its writes.
pub(super) fn for_each_read(resources: &Resources<'_>, pass: &Pass, mut see: impl FnMut(Read)) {
    pass.visit_accesses(&mut |access: Access<'_>| {
        if access.attaches() {
            return;
        }
        let (resource, frames_ago, span) = (access.resource(), access.frames_ago(), access.span());
        access.for_each_effect(pass, image(resources, resource), |effect| {
            if effect.reads
                && let Some(cells) = part(resources, resource, &effect.range)
            {
                see(Read { resource, cells, frames_ago, span });
            }
        });
    });
}

/// The reads of `pass`, as [`for_each_read`] shows them.
pub(super) fn reads(resources: &Resources<'_>, pass: &Pass) -> Vec<Read> {
    let mut reads = Vec::new();
    for_each_read(resources, pass, |read| reads.push(read));
    reads
}

/// Shows the writes of `pass`, and all targets that it draws into.
pub(super) fn for_each_write(resources: &Resources<'_>, pass: &Pass, mut see: impl FnMut(Write)) {
    pass.visit_accesses(&mut |access: Access<'_>| {
        let (resource, span) = (access.resource(), access.span());
        access.for_each_effect(pass, image(resources, resource), |Effect { range, reads, writes: changes }| {
            let clear = match access {
                Access::Color(_) => Some("(image: \"…\", clear: (0.0, 0.0, 0.0, 1.0))"),
                Access::Depth(_) if range.aspects == Aspects::STENCIL => Some("(image: \"…\", stencil: (clear: 0))"),
                Access::Depth(_) => Some("(image: \"…\", clear: 0.0)"),
                _ => None,
            };
            if (clear.is_some() || changes)
                && let Some(cells) = part(resources, resource, &range)
            {
                see(Write { resource, cells, span, continues: clear.filter(|_| reads) });
            }
        });
    });
}

/// The writes of `pass`, as [`for_each_write`] shows them.
pub(super) fn writes(resources: &Resources<'_>, pass: &Pass) -> Vec<Write> {
    let mut writes = Vec::new();
    for_each_write(resources, pass, |write| writes.push(write));
    writes
}

/// Images and buffers whose contents `pass` would make, were it on.
pub(super) fn would_write(pass: &Pass) -> impl Iterator<Item = (Resource, Span)> {
    let writes = |access: &Access<'_>| access.attaches() || access.writes(pass, None);
    pass.accesses().filter(writes).map(|access| (access.resource(), access.span()))
}
