//! What a pass of the frame reads and writes, part by part.

use super::order::State;
use super::parts::{self, Cells};
use super::things::Things;
use crate::frame::{Blend, BufferRole, Draw, Pass, Resource, Work};
use crate::source::Span;
use crate::vocabulary::{Aspects, CompareOp, StencilOp, Subresources};

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

/// Whether what a draw draws replaces every texel of a target of one layer that isn't blended.
fn covers(pass: &Pass) -> bool {
    let full_screen = matches!(pass.work, Work::Draw { draw: Draw::FullScreen, discards: false, .. });
    let stencil = |test: &crate::frame::StencilState| test.test != CompareOp::Always;
    let tested = pass
        .depth
        .as_ref()
        .is_some_and(|depth| depth.test != CompareOp::Always || depth.stencil.as_ref().is_some_and(stencil));
    full_screen && !tested
}

/// What `pass` writes.
pub(super) fn writes(things: &Things, pass: &Pass) -> Vec<Write> {
    let mut writes = Vec::new();
    let mut add = |resource, cells: Option<Cells>, span, continues: Option<&'static str>| {
        if let Some(cells) = cells {
            writes.push(Write { resource, cells, span, continues });
        }
    };
    let covers = covers(pass);
    let single = |cells: &Option<Cells>| cells.as_ref().is_none_or(|cells| cells.layers.len() == 1);
    for target in &pass.color {
        let cells = part(things, Resource::Image(target.image), &target.range);
        let whole = target.clear.is_some() || (covers && target.blend == Blend::Replace && single(&cells));
        let clear = "(image: \"…\", clear: (0.0, 0.0, 0.0, 1.0))";
        add(Resource::Image(target.image), cells, target.span, (!whole).then_some(clear));
    }
    if let Some(target) = &pass.depth {
        let resource = Resource::Image(target.image);
        let plane = |aspects| part(things, resource, &Subresources { aspects, ..target.range });
        let depth = plane(Aspects::DEPTH);
        let whole = target.clear.is_some() || (covers && target.write && single(&depth));
        add(resource, depth, target.span, (!whole).then_some("(image: \"…\", clear: 0.0)"));
        if let Some(stencil) = target.stencil {
            let cells = plane(Aspects::STENCIL);
            let sets = matches!(stencil.pass, StencilOp::Replace | StencilOp::Zero);
            let whole = stencil.clear.is_some() || (covers && sets && single(&cells));
            let clear = "(image: \"…\", stencil: (clear: 0))";
            add(resource, cells, target.span, (!whole).then_some(clear));
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

impl State {
    /// The passes that run here: itself or its stand-ins.
    pub(super) fn runs(&self) -> &[Pass] {
        match self {
            State::On(pass) => std::slice::from_ref(pass),
            State::Off { stand_ins, .. } => stand_ins,
        }
    }
}
