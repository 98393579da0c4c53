//! The accesses of a pass.

use crate::random_pipelines::pipeline::{
    Compute, Count, DepthTarget, Draw, Geometry, Groups, Part, Pass, Plane, Read, Region, Store, StoreAccess, Thing,
    Work,
};
use framewright_graph::frame::Blend;
use framewright_graph::vulkan::{CompareOp, StencilOp};

/// How a pass accesses a part of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum How {
    Sampled,
    Storage,
    Attachment,
    Transfer,
}

/// One access to a part of an image of this frame.
pub(super) struct Access {
    pub(super) part: Part,
    pub(super) how: How,
    pub(super) reads: bool,
    pub(super) writes: bool,
}

/// Whether a draw reaches every texel of its targets, and passes all tests there.
fn covers(draw: &Draw) -> bool {
    let untested = |depth: DepthTarget| {
        depth.test == CompareOp::Always && depth.stencil.is_none_or(|stencil| stencil.test == CompareOp::Always)
    };
    draw.geometry == Geometry::FullScreen && !draw.discards && draw.depth.is_none_or(untested)
}

/// Every access to images of this frame.
pub(super) fn accesses(pass: &Pass) -> Vec<Access> {
    let mut all = Vec::new();
    let mut add = |part, how, reads, writes| all.push(Access { part, how, reads, writes });
    let (reads, stores) = shader(pass);
    for read in reads {
        match *read {
            Read::Sampled { part, frames_ago: 0, .. } | Read::Own(part) => add(part, How::Sampled, true, false),
            Read::Storage(part) => add(part, How::Storage, true, false),
            _ => {}
        }
    }
    for store in stores {
        if let Region::Image(part) = store.region {
            add(part, How::Storage, store.access != StoreAccess::Write, true);
        }
    }
    match &pass.work {
        Work::Draw(draw) => {
            for target in &draw.color {
                let keeps = target.clear.is_none()
                    && !(covers(draw) && target.blend == Blend::Replace && target.write_mask.is_all());
                add(target.part, How::Attachment, keeps, true);
            }
            if let Some(DepthTarget { part, clear, write, stencil, .. }) = draw.depth {
                let keeps = clear.is_none() && !(covers(draw) && write);
                add(part, How::Attachment, keeps, write || clear.is_some());
                if let Some(stencil) = stencil {
                    let writes = stencil.clear.is_some() || stencil.pass != StencilOp::Keep;
                    let part = Part { plane: Plane::Stencil, ..part };
                    let sets = matches!(stencil.pass, StencilOp::Zero | StencilOp::Replace);
                    let keeps = stencil.clear.is_none() && !(covers(draw) && sets);
                    add(part, How::Attachment, keeps, writes);
                }
            }
        }
        Work::Copy { .. } | Work::Custom { .. } => {
            let (from, to) = copied(pass);
            if let Some(Region::Image(part)) = from {
                add(part, How::Transfer, true, false);
            }
            if let Some(Region::Image(part)) = to {
                add(part, How::Transfer, false, true);
            }
        }
        Work::Blit { from, to } => {
            add(*from, How::Transfer, true, false);
            add(*to, How::Transfer, false, true);
        }
        Work::Fill { to: Region::Image(part), .. } => add(*part, How::Transfer, false, true),
        Work::Fill { .. } | Work::Forward { .. } | Work::Compute(_) => {}
    }
    all
}

/// The accesses of a copy or a custom pass.
fn copied(pass: &Pass) -> (Option<Region>, Option<Region>) {
    match pass.work {
        Work::Copy { from, frames_ago, to } => ((frames_ago == 0).then_some(from), Some(to)),
        Work::Custom { from, to, .. } => (from, Some(to)),
        _ => (None, None),
    }
}

/// The accesses of a pass's shaders beside attachments.
pub(in crate::random_pipelines) fn shader(pass: &Pass) -> (&[Read], &[Store]) {
    match &pass.work {
        Work::Draw(Draw { reads, stores, .. }) | Work::Compute(Compute { reads, stores, .. }) => (reads, stores),
        _ => (&[], &[]),
    }
}

/// Every buffer of this frame that a pass accesses: which, whether it reads and writes it.
pub(super) fn buffers(pass: &Pass) -> Vec<(usize, bool, bool)> {
    let mut all = Vec::new();
    let (reads, stores) = shader(pass);
    for read in reads {
        if let Read::Uniform(buffer, 0) | Read::Block(buffer, 0) = *read {
            all.push((buffer, true, false));
        }
    }
    for store in stores {
        if let Region::Buffer(buffer) = store.region {
            all.push((buffer, store.access != StoreAccess::Write, true));
        }
    }
    match &pass.work {
        Work::Draw(Draw { geometry: Geometry::Triangles { count, vertices, indices }, .. }) => {
            let counts = if let Count::Indirect(buffer) = count { Some(*buffer) } else { None };
            all.extend([*vertices, *indices, counts].into_iter().flatten().map(|buffer| (buffer, true, false)));
        }
        Work::Compute(Compute { groups: Groups::Indirect(buffer, _), .. }) => all.push((*buffer, true, false)),
        Work::Copy { .. } | Work::Custom { .. } => {
            let (from, to) = copied(pass);
            if let Some(Region::Buffer(buffer)) = from {
                all.push((buffer, true, false));
            }
            if let Some(Region::Buffer(buffer)) = to {
                all.push((buffer, false, true));
            }
        }
        Work::Fill { to: Region::Buffer(buffer), .. } => all.push((*buffer, false, true)),
        _ => {}
    }
    all
}

/// Every image and buffer that a pass names, of this frame or of earlier ones.
pub(in crate::random_pipelines) fn things(pass: &Pass) -> Vec<Thing> {
    let mut all: Vec<Thing> = accesses(pass).into_iter().map(|access| Thing::Image(access.part.image)).collect();
    all.extend(buffers(pass).into_iter().map(|(buffer, ..)| Thing::Buffer(buffer)));
    for read in shader(pass).0 {
        all.push(match *read {
            Read::Sampled { part, .. } | Read::Own(part) | Read::Storage(part) => Thing::Image(part.image),
            Read::Uniform(buffer, _) | Read::Block(buffer, _) => Thing::Buffer(buffer),
        });
    }
    match pass.work {
        Work::Forward { from, to } => all.extend([Thing::Image(from), Thing::Image(to)]),
        Work::Copy { from: Region::Image(part), .. } => all.push(Thing::Image(part.image)),
        Work::Copy { from: Region::Buffer(buffer), .. } => all.push(Thing::Buffer(buffer)),
        _ => {}
    }
    all
}
