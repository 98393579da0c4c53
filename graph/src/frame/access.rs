//! What a pass accesses: its images and buffers, which part of each, and whether that is read and written.

use super::{
    BufferRole, ColorTarget, DepthTarget, Image, ImageIndex, Pass, Resource, Sampled, Storage, TransferUse, Work,
};
use crate::base::Span;
use crate::vulkan::{Format, Subresources};

/// An image or a buffer that a pass names.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Access<'p> {
    pub(crate) resource: Resource,
    /// The part of an image, as the pass names it; of depth attachments without planes.
    pub(crate) range: Subresources,
    /// Of which frame: 0 is this one, 1 the one before.
    pub(crate) frames_ago: u32,
    /// Where it is named.
    pub(crate) span: Span,
    pub(crate) kind: AccessKind<'p>,
}

/// The role in which a pass names an image or a buffer.
#[derive(Debug, Clone, Copy)]
pub(crate) enum AccessKind<'p> {
    Sampled(&'p Sampled),
    Storage(&'p Storage),
    Color(&'p ColorTarget),
    Depth(&'p DepthTarget),
    Buffer(BufferRole),
    Transfer { write: bool },
    ForwardSource,
    ForwardTarget,
}

/// What an access does with one part.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Effect {
    /// The part of an image: one plane of what is sampled or tested.
    pub(crate) range: Subresources,
    /// Whether it needs what was there before.
    pub(crate) reads: bool,
    /// Whether it changes it.
    pub(crate) writes: bool,
}

impl Pass {
    /// All that it accesses: what is sampled, storage images, attachments, buffers, transfers, then what is forwarded.
    pub(crate) fn accesses(&self) -> impl Iterator<Item = Access<'_>> {
        let image =
            |image, range, span, kind| Access { resource: Resource::Image(image), range, frames_ago: 0, span, kind };
        let sampled = self.sampled.iter().map(move |it| {
            let kind = AccessKind::Sampled(it);
            Access { frames_ago: it.frames_ago, ..image(it.image, it.range, it.span, kind) }
        });
        let storage = self.storage.iter().map(move |it| image(it.image, it.range, it.span, AccessKind::Storage(it)));
        let color = self.color.iter().map(move |it| image(it.image, it.range, it.span, AccessKind::Color(it)));
        let depth = self.depth.iter().map(move |it| {
            let range = Subresources { aspects: Subresources::WHOLE.aspects, ..it.range };
            image(it.image, range, it.span, AccessKind::Depth(it))
        });
        let buffers = self.buffers.iter().map(|it| {
            let (resource, kind) = (Resource::Buffer(it.buffer), AccessKind::Buffer(it.role));
            Access { resource, range: Subresources::WHOLE, frames_ago: it.frames_ago, span: it.span, kind }
        });
        let transfers = self.transfers.iter().map(|it| {
            let TransferUse { resource, range, frames_ago, span, write } = *it;
            Access { resource, range, frames_ago, span, kind: AccessKind::Transfer { write } }
        });
        let forwarded = match self.work {
            Work::Forward { from, to, .. } => {
                Some([(from, AccessKind::ForwardSource), (to, AccessKind::ForwardTarget)])
            }
            _ => None,
        };
        let forwarded = forwarded.into_iter().flatten();
        let forwarded = forwarded.map(move |(it, kind)| image(it, Subresources::WHOLE, self.span, kind));
        sampled.chain(storage).chain(color).chain(depth).chain(buffers).chain(transfers).chain(forwarded)
    }

    /// Whether it relies on the very format of what it accesses: a shader or a program is told the layout of the texels, or
    /// they are copied to or from a buffer, or from one format into another. `format`: that of an image.
    pub(crate) fn relies_on_format(&self, access: &Access<'_>, format: impl Fn(ImageIndex) -> Option<Format>) -> bool {
        let is_buffer = |used: &TransferUse| matches!(used.resource, Resource::Buffer(_));
        let converts = || self.moved_images().is_some_and(|[from, to]| format(from) != format(to));
        match (access.kind, &self.work) {
            (AccessKind::Storage(_), _) | (AccessKind::Transfer { .. }, Work::Custom { .. }) => true,
            (AccessKind::Transfer { .. }, Work::Copy) => self.transfers.iter().any(is_buffer) || converts(),
            _ => false,
        }
    }

    /// The images of which it copies, scales or forwards the first into the second.
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
    /// Its image; `None`: it is a buffer.
    pub(crate) fn image_index(&self) -> Option<ImageIndex> {
        match self.resource {
            Resource::Image(image) => Some(image),
            Resource::Buffer(_) => None,
        }
    }

    /// Whether it is an attachment.
    pub(crate) fn attaches(&self) -> bool {
        matches!(self.kind, AccessKind::Color(_) | AccessKind::Depth(_))
    }

    /// Calls `visit` with what `pass`, whose access it is, does with each part. `image`: the one of an access to an image.
    #[inline]
    pub(crate) fn for_each_effect(&self, pass: &Pass, image: Option<&Image>, mut visit: impl FnMut(Effect)) {
        let range = self.range;
        let (reads, writes) = match (self.kind, image) {
            (AccessKind::Sampled(_), Some(image)) => {
                return visit(Effect { range: image.sampled_part(range), reads: true, writes: false });
            }
            (AccessKind::Color(target), Some(image)) => (pass.keeps_color(target, image), true),
            (AccessKind::Depth(target), Some(image)) => {
                return target.planes(image.format).for_each(|(plane, _, writes)| {
                    let reads = pass.keeps_plane(target, plane, image);
                    visit(Effect { range: Subresources { aspects: plane, ..range }, reads, writes });
                });
            }
            (AccessKind::Sampled(_) | AccessKind::Color(_) | AccessKind::Depth(_), None) => return,
            (AccessKind::Storage(storage), _) => (storage.read, storage.write),
            (AccessKind::Buffer(role), _) => (role.reads(), role.writes()),
            (AccessKind::Transfer { write }, _) => (!write, write),
            (AccessKind::ForwardSource, _) => (true, false),
            (AccessKind::ForwardTarget, _) => (false, true),
        };
        visit(Effect { range, reads, writes });
    }

    /// Whether it changes any part of its image or buffer.
    pub(crate) fn writes(&self, pass: &Pass, image: Option<&Image>) -> bool {
        let mut writes = false;
        self.for_each_effect(pass, image, |effect| writes |= effect.writes);
        writes
    }
}

impl BufferRole {
    /// Whether earlier contents are read or kept.
    pub(crate) const fn reads(self) -> bool {
        !matches!(self, BufferRole::Storage { read: false, .. })
    }

    /// Whether the buffer is written.
    pub(crate) const fn writes(self) -> bool {
        matches!(self, BufferRole::Storage { write: true, .. })
    }
}
