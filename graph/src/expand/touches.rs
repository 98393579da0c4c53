//! What a pass of the frame reads and writes, part by part.

use super::parts::{self, Cells};
use super::things::Things;
use crate::base::Span;
use crate::frame::{BufferRole, Pass, Resource, Work};
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
    /// How to clear it, if it may leave texels untouched: then it adds to what is there.
    pub(super) continues: Option<&'static str>,
}

/// All of an image or buffer; `None` if nothing is known about it.
pub(super) fn whole(things: &Things, resource: Resource) -> Option<Cells> {
    part(things, resource, &Subresources::WHOLE)
}

/// A part of an image, or a buffer.
fn part(things: &Things, resource: Resource, range: &Subresources) -> Option<Cells> {
    match resource {
        Resource::Image(index) => Some(parts::cells(&things.image(index)?.image, range)),
        Resource::Buffer(_) => Some(Cells { mips: 0..1, layers: 0..1, planes: Aspects::COLOR }),
    }
}

/// What `pass` reads. What it only adds to stands among its writes.
pub(super) fn reads(things: &Things, pass: &Pass) -> Vec<Read> {
    let mut reads = Vec::new();
    let mut add = |resource, range: &Subresources, frames_ago, span| {
        if let Some(cells) = part(things, resource, range) {
            reads.push(Read { resource, cells, frames_ago, span });
        }
    };
    for sampled in &pass.sampled {
        add(Resource::Image(sampled.image), &sampled.range, sampled.frames_ago, sampled.span);
    }
    for storage in pass.storage.iter().filter(|storage| storage.read) {
        add(Resource::Image(storage.image), &storage.range, 0, storage.span);
    }
    for used in &pass.buffers {
        if !matches!(used.role, BufferRole::Storage { read: false, .. }) {
            add(Resource::Buffer(used.buffer), &Subresources::WHOLE, used.frames_ago, used.span);
        }
    }
    for transfer in pass.transfers.iter().filter(|transfer| !transfer.write) {
        add(transfer.resource, &transfer.range, transfer.frames_ago, transfer.span);
    }
    if let Work::Forward { from, .. } = pass.work {
        add(Resource::Image(from), &Subresources::WHOLE, 0, pass.span);
    }
    reads
}

/// What `pass` writes.
pub(super) fn writes(things: &Things, pass: &Pass) -> Vec<Write> {
    let mut writes = Vec::new();
    let mut add = |resource, cells: Option<Cells>, span, continues: Option<&'static str>| {
        if let Some(cells) = cells {
            writes.push(Write { resource, cells, span, continues });
        }
    };
    let image = |image| things.image(image).map(|known| &known.image);
    for target in &pass.color {
        let covers = image(target.image).is_none_or(|image| pass.covers_color(target, image));
        let clear = "(image: \"…\", clear: (0.0, 0.0, 0.0, 1.0))";
        let cells = part(things, Resource::Image(target.image), &target.range);
        let whole = target.clear.is_some() || covers;
        add(Resource::Image(target.image), cells, target.span, (!whole).then_some(clear));
    }
    if let Some(target) = &pass.depth {
        let covers = |plane| image(target.image).is_none_or(|image| pass.covers_plane(target, plane, image));
        let mut plane = |aspects, clears: bool, clear| {
            let resource = Resource::Image(target.image);
            let cells = part(things, resource, &Subresources { aspects, ..target.range });
            add(resource, cells, target.span, (!clears && !covers(aspects)).then_some(clear));
        };
        plane(Aspects::DEPTH, target.clear.is_some(), "(image: \"…\", clear: 0.0)");
        if let Some(stencil) = target.stencil {
            plane(Aspects::STENCIL, stencil.clear.is_some(), "(image: \"…\", stencil: (clear: 0))");
        }
    }
    for storage in pass.storage.iter().filter(|storage| storage.write) {
        let resource = Resource::Image(storage.image);
        add(resource, part(things, resource, &storage.range), storage.span, None);
    }
    for used in &pass.buffers {
        if let BufferRole::Storage { write: true, .. } = used.role {
            let resource = Resource::Buffer(used.buffer);
            add(resource, whole(things, resource), used.span, None);
        }
    }
    for transfer in pass.transfers.iter().filter(|transfer| transfer.write) {
        add(transfer.resource, part(things, transfer.resource, &transfer.range), transfer.span, None);
    }
    if let Work::Forward { to, .. } = pass.work {
        add(Resource::Image(to), whole(things, Resource::Image(to)), pass.span, None);
    }
    writes
}

/// Images and buffers whose contents `pass` would make, were it on.
pub(super) fn would_write(pass: &Pass) -> impl Iterator<Item = (Resource, Span)> {
    let color = pass.color.iter().map(|target| (Resource::Image(target.image), target.span));
    let depth = pass.depth.iter().map(|target| (Resource::Image(target.image), target.span));
    let storage = pass.storage.iter().filter(|storage| storage.write);
    let storage = storage.map(|storage| (Resource::Image(storage.image), storage.span));
    let buffers = pass.buffers.iter().filter(|used| matches!(used.role, BufferRole::Storage { write: true, .. }));
    let buffers = buffers.map(|used| (Resource::Buffer(used.buffer), used.span));
    let transfers = pass.transfers.iter().filter(|transfer| transfer.write);
    let transfers = transfers.map(|transfer| (transfer.resource, transfer.span));
    color.chain(depth).chain(storage).chain(buffers).chain(transfers)
}
