//! Accesses of a pass: its images and buffers, which part of each, and whether that part is read and written.

use super::{
    BufferUse, ColorTarget, DepthTarget, Draw, Image, ImageIndex, Pass, Resource, SampledImage, Storage, TransferUse,
    Work,
};
use crate::base::Span;
use crate::vulkan::{Format, Subresources};

/// An image or a buffer that a pass names, by the role in which it does.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Access<'p> {
    Sampled(&'p SampledImage),
    Storage(&'p Storage),
    Color(&'p ColorTarget),
    Depth(&'p DepthTarget),
    Buffer(&'p BufferUse),
    Transfer(&'p TransferUse),
    ForwardSource(ImageIndex, Span),
    ForwardTarget(ImageIndex, Span),
}

/// Takes all accesses of a pass, one after the other.
pub(crate) trait VisitAccess<'p> {
    /// Takes the next one. Where it is inlined, it is compiled for each role by itself, and looks up nothing by role: inlining
    /// all that takes accesses saves a fifth of the instructions of compiling 1,000 passes.
    fn visit(&mut self, access: Access<'p>);
}

impl<'p, F: FnMut(Access<'p>)> VisitAccess<'p> for F {
    fn visit(&mut self, access: Access<'p>) {
        self(access);
    }
}

/// The effect of an access on one part.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Effect {
    /// The part of an image: one plane, if it is sampled or tested.
    pub(crate) range: Subresources,
    /// Whether the access needs the earlier contents.
    pub(crate) reads: bool,
    /// Whether the access changes the contents.
    pub(crate) writes: bool,
}

impl Pass {
    /// All accesses of the pass: sampled images, storage images, attachments, buffers, transfers, then forwarded images.
    pub(crate) fn accesses(&self) -> impl Iterator<Item = Access<'_>> {
        let mut listed = Vec::new();
        self.visit_accesses(&mut |access| listed.push(access));
        listed.into_iter()
    }

    /// Shows `visitor` what [`Pass::accesses`] lists, for those who look at all accesses of all passes.
    // Inlined: `VisitAccess::visit` says why.
    #[inline(always)]
    pub(crate) fn visit_accesses<'p>(&'p self, visitor: &mut impl VisitAccess<'p>) {
        self.sampled.iter().for_each(|it| visitor.visit(Access::Sampled(it)));
        self.storage.iter().for_each(|it| visitor.visit(Access::Storage(it)));
        self.color.iter().for_each(|it| visitor.visit(Access::Color(it)));
        self.depth.iter().for_each(|it| visitor.visit(Access::Depth(it)));
        self.buffers.iter().for_each(|it| visitor.visit(Access::Buffer(it)));
        self.transfers.iter().for_each(|it| visitor.visit(Access::Transfer(it)));
        if let Some([from, to]) = self.work.forwarded() {
            visitor.visit(Access::ForwardSource(from, self.span));
            visitor.visit(Access::ForwardTarget(to, self.span));
        }
    }

    /// Whether the pass relies on the very format of an accessed image: a shader or a program is told the layout of the texels,
    /// or they are copied to or from a buffer, or from one format into another. `format`: that of an image.
    pub(crate) fn relies_on_format(&self, access: &Access<'_>, format: impl Fn(ImageIndex) -> Option<Format>) -> bool {
        let is_buffer = |used: &TransferUse| matches!(used.resource, Resource::Buffer(_));
        let converts = || self.moved_images().is_some_and(|[from, to]| format(from) != format(to));
        match (access, &self.work) {
            (Access::Storage(_), _) | (Access::Transfer(_), Work::Custom { .. }) => true,
            (Access::Transfer(_), Work::Copy) => self.transfers.iter().any(is_buffer) || converts(),
            _ => false,
        }
    }

    /// Whether the embedding program records it, with commands that only the program knows.
    pub(crate) fn is_custom(&self) -> bool {
        matches!(self.work, Work::Custom { .. } | Work::Draw { draw: Draw::Custom, .. })
    }

    /// Two images, if the pass copies, scales or forwards the first into the second.
    pub(crate) fn moved_images(&self) -> Option<[ImageIndex; 2]> {
        match (&self.work, &self.transfers[..]) {
            (Work::Forward { from, to, .. }, _) => Some([*from, *to]),
            (Work::Copy | Work::Blit { .. }, [from, to]) => match (from.resource, to.resource) {
                (Resource::Image(from), Resource::Image(to)) => Some([from, to]),
                _ => None,
            },
            _ => None,
        }
    }

    /// The images that it draws into, and which parts of them: colour, then depth.
    pub(crate) fn attachments(&self) -> impl Iterator<Item = (ImageIndex, Subresources)> {
        let color = self.color.iter().map(|target| (target.image, target.range));
        color.chain(self.depth.iter().map(|depth| (depth.image, depth.range)))
    }
}

impl Access<'_> {
    /// The image or buffer.
    #[inline]
    pub(crate) fn resource(&self) -> Resource {
        match *self {
            Access::Sampled(it) => Resource::Image(it.image),
            Access::Storage(it) => Resource::Image(it.image),
            Access::Color(it) => Resource::Image(it.image),
            Access::Depth(it) => Resource::Image(it.image),
            Access::Buffer(it) => Resource::Buffer(it.buffer),
            Access::Transfer(it) => it.resource,
            Access::ForwardSource(image, _) | Access::ForwardTarget(image, _) => Resource::Image(image),
        }
    }

    /// The part of an image, as the pass names it; of depth attachments without planes.
    #[inline]
    pub(crate) fn range(&self) -> Subresources {
        match *self {
            Access::Sampled(it) => it.range,
            Access::Storage(it) => it.range,
            Access::Color(it) => it.range,
            Access::Depth(it) => Subresources { aspects: Subresources::WHOLE.aspects, ..it.range },
            Access::Transfer(it) => it.range,
            Access::Buffer(_) | Access::ForwardSource(..) | Access::ForwardTarget(..) => Subresources::WHOLE,
        }
    }

    /// How many frames ago: 0 is this frame.
    #[inline]
    pub(crate) fn frames_ago(&self) -> u32 {
        match *self {
            Access::Sampled(it) => it.frames_ago,
            Access::Buffer(it) => it.frames_ago,
            Access::Transfer(it) => it.frames_ago,
            _ => 0,
        }
    }

    /// Where it is named.
    #[inline]
    pub(crate) fn span(&self) -> Span {
        match *self {
            Access::Sampled(it) => it.span,
            Access::Storage(it) => it.span,
            Access::Color(it) => it.span,
            Access::Depth(it) => it.span,
            Access::Buffer(it) => it.span,
            Access::Transfer(it) => it.span,
            Access::ForwardSource(_, span) | Access::ForwardTarget(_, span) => span,
        }
    }

    /// Its image; `None`: it is a buffer.
    #[inline]
    pub(crate) fn image_index(&self) -> Option<ImageIndex> {
        match self.resource() {
            Resource::Image(image) => Some(image),
            Resource::Buffer(_) => None,
        }
    }

    /// Whether it is an attachment.
    #[inline]
    pub(crate) fn attaches(&self) -> bool {
        matches!(self, Access::Color(_) | Access::Depth(_))
    }

    /// Calls `visit` with the effect on each part. `pass`: the pass of this access. `image`: the accessed image, if it is one.
    // Inlined: `VisitAccess::visit` says why.
    #[inline(always)]
    pub(crate) fn for_each_effect(&self, pass: &Pass, image: Option<&Image>, mut visit: impl FnMut(Effect)) {
        let (reads, writes) = match (*self, image) {
            (Access::Sampled(it), Some(image)) => {
                return visit(Effect { range: image.sampled_part(it.range), reads: true, writes: false });
            }
            (Access::Color(target), Some(image)) => (pass.keeps_color(target, image), true),
            (Access::Depth(target), Some(image)) => {
                return target.planes(image.format).for_each(|(plane, _, writes)| {
                    let reads = pass.keeps_plane(target, plane, image);
                    visit(Effect { range: Subresources { aspects: plane, ..target.range }, reads, writes });
                });
            }
            (Access::Sampled(_) | Access::Color(_) | Access::Depth(_), None) => return,
            (Access::Storage(storage), _) => (storage.read, storage.write),
            (Access::Buffer(used), _) => (used.role.reads(), used.role.writes()),
            (Access::Transfer(used), _) => (!used.write || used.keeps, used.write),
            (Access::ForwardSource(..), _) => (true, false),
            (Access::ForwardTarget(..), _) => (false, true),
        };
        visit(Effect { range: self.range(), reads, writes });
    }

    /// Whether it changes any part of its image or buffer.
    pub(crate) fn writes(&self, pass: &Pass, image: Option<&Image>) -> bool {
        let mut writes = false;
        self.for_each_effect(pass, image, |effect| writes |= effect.writes);
        writes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Blend, BufferIndex, BufferRole};
    use crate::vulkan::{ColorComponents, CompareOp, Stages};

    #[test]
    fn a_pass_lists_all_accesses_in_their_order() {
        let image = ImageIndex;
        let (range, span, stages) = (Subresources::WHOLE, Span::NONE, Stages::FRAGMENT_SHADER);
        let work = Work::Forward { from: image(6), to: image(7), because: String::new() };
        let mut pass = Pass::new("all", work);
        pass.sampled = vec![SampledImage::new("s", image(0), stages)];
        pass.storage = vec![Storage {
            binding: "t".into(),
            image: image(1),
            range,
            span,
            read: true,
            write: true,
            eye: None,
            stages,
        }];
        pass.color = vec![ColorTarget {
            image: image(2),
            range,
            span,
            clear: None,
            blend: Blend::Replace,
            write_mask: ColorComponents::RGBA,
        }];
        let test = CompareOp::Always;
        pass.depth = Some(DepthTarget { image: image(3), range, span, clear: None, test, write: true, stencil: None });
        let (buffer, role) = (BufferIndex(4), BufferRole::Uniform);
        pass.buffers = vec![BufferUse { binding: None, buffer, frames_ago: 0, role, stages, span }];
        let resource = Resource::Image(image(5));
        pass.transfers = vec![TransferUse { resource, range, frames_ago: 0, write: false, keeps: false, span }];
        let listed: Vec<Resource> = pass.accesses().map(|access| access.resource()).collect();
        let expected: Vec<Resource> = (0..8)
            .map(|number| if number == 4 { Resource::Buffer(buffer) } else { Resource::Image(image(number)) })
            .collect();
        assert_eq!(listed, expected);
    }
}
