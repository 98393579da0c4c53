//! One walk of a Plan: the passes, attachments, sides and resources of a step, for everybody who looks at steps.

use super::{Access, Attachment, AttachmentKind, Cause, ImageId, Pass, RenderScope, Resource, Side, Step, Work};
use crate::vulkan::Subresources;
use std::slice;
use std::sync::Arc;

impl RenderScope {
    /// Colour attachments by location.
    #[must_use]
    pub fn color(&self) -> &[Attachment] {
        let is_color = |attachment: &Attachment| attachment.kind == AttachmentKind::Color;
        let count = self.attachments.iter().take_while(|it| is_color(it)).count();
        &self.attachments[..count]
    }

    /// The depth attachment.
    #[must_use]
    pub fn depth(&self) -> Option<&Attachment> {
        self.only(AttachmentKind::Depth)
    }

    /// The stencil attachment.
    #[must_use]
    pub fn stencil(&self) -> Option<&Attachment> {
        self.only(AttachmentKind::Stencil)
    }

    fn only(&self, kind: AttachmentKind) -> Option<&Attachment> {
        self.attachments.iter().find(|attachment| attachment.kind == kind)
    }

    /// Whether the attachments stand in the order of their kinds, and no kind comes more often than it may.
    #[must_use]
    pub fn is_in_order(&self) -> bool {
        let ordered = |a: &Attachment, b: &Attachment| a.kind < b.kind || a.kind == b.kind && a.kind.may_repeat();
        self.attachments.is_sorted_by(ordered)
    }
}

impl Work {
    /// The rendering scope, if it is one.
    #[must_use]
    pub fn scope(&self) -> Option<&RenderScope> {
        match self {
            Work::Render(scope) => Some(scope),
            Work::Dispatch(_)
            | Work::Custom(_)
            | Work::Resolve(_)
            | Work::Copy(_)
            | Work::Blit(_)
            | Work::Fill(_)
            | Work::Export => None,
        }
    }

    /// Whether it is a compute pass.
    #[must_use]
    pub fn is_dispatch(&self) -> bool {
        matches!(self, Work::Dispatch(_))
    }

    /// Whether it is barriers alone.
    #[must_use]
    pub fn is_export(&self) -> bool {
        matches!(self, Work::Export)
    }

    /// Whether the embedding program records it.
    #[must_use]
    pub fn is_custom(&self) -> bool {
        matches!(self, Work::Custom(_))
    }

    /// The attachments of its rendering scope.
    pub fn attachments(&self) -> impl Iterator<Item = &Attachment> {
        self.scope().into_iter().flat_map(|scope| &scope.attachments)
    }

    /// Its passes in order.
    #[must_use]
    pub fn passes(&self) -> &[Pass] {
        match self {
            Work::Render(scope) => &scope.passes,
            Work::Dispatch(pass) | Work::Custom(pass) => slice::from_ref(pass),
            Work::Resolve(_) | Work::Copy(_) | Work::Blit(_) | Work::Fill(_) | Work::Export => &[],
        }
    }

    /// Its passes, to be changed.
    #[must_use]
    pub fn passes_mut(&mut self) -> &mut [Pass] {
        match self {
            Work::Render(scope) => &mut scope.passes,
            Work::Dispatch(pass) | Work::Custom(pass) => slice::from_mut(pass),
            Work::Resolve(_) | Work::Copy(_) | Work::Blit(_) | Work::Fill(_) | Work::Export => &mut [],
        }
    }

    /// The word for it.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self {
            Work::Render(_) => "draw",
            Work::Dispatch(_) => "dispatch",
            Work::Custom(_) => "custom",
            Work::Resolve(_) => "resolve",
            Work::Copy(_) => "copy",
            Work::Blit(_) => "blit",
            Work::Fill(_) => "fill",
            Work::Export => "export",
        }
    }

    /// The name of its one pass. A rendering scope has none, nor has a transfer that the compiler inserted.
    #[must_use]
    pub const fn name(&self) -> Option<&Arc<str>> {
        match self {
            Work::Dispatch(pass) | Work::Custom(pass) => Some(&pass.name),
            Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => transfer.name.as_ref(),
            Work::Fill(fill) => fill.name.as_ref(),
            Work::Render(_) | Work::Export => None,
        }
    }

    /// Why a transfer is there.
    #[must_use]
    pub fn cause(&self) -> Option<&Cause> {
        match self {
            Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => Some(&transfer.cause),
            Work::Fill(fill) => Some(&fill.cause),
            Work::Render(_) | Work::Dispatch(_) | Work::Custom(_) | Work::Export => None,
        }
    }

    /// The sides of a transfer: first the source, then the target. A fill has only a target.
    pub fn sides(&self) -> impl Iterator<Item = &Side> {
        let (source, target) = match self {
            Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => {
                (Some(&transfer.source), Some(&transfer.target))
            }
            Work::Fill(fill) => (None, Some(&fill.target)),
            Work::Render(_) | Work::Dispatch(_) | Work::Custom(_) | Work::Export => (None, None),
        };
        source.into_iter().chain(target)
    }

    /// The sides of a transfer, to be changed.
    pub fn sides_mut(&mut self) -> impl Iterator<Item = &mut Side> {
        let (source, target) = match self {
            Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => {
                (Some(&mut transfer.source), Some(&mut transfer.target))
            }
            Work::Fill(fill) => (None, Some(&mut fill.target)),
            Work::Render(_) | Work::Dispatch(_) | Work::Custom(_) | Work::Export => (None, None),
        };
        source.into_iter().chain(target)
    }

    /// All that it uses, of images with the part: accesses of its passes, attachments with what they are resolved into, and the sides
    /// of transfers. One may come more than once.
    pub fn used(&self) -> impl Iterator<Item = (Resource, Option<Subresources>)> {
        let image = |image, range| (Resource::Image(image), Some(range));
        let of_passes = self.passes().iter().flat_map(move |pass| {
            let images = pass.accesses.iter().map(move |access| image(access.image, access.range));
            images.chain(pass.buffers.iter().map(|access| (Resource::Buffer(access.buffer), None)))
        });
        let attached = self.attachments().flat_map(move |attachment| {
            let resolve = attachment.resolve.as_ref().map(|resolve| image(resolve.image, resolve.range));
            std::iter::once(image(attachment.image, attachment.range)).chain(resolve)
        });
        of_passes.chain(attached).chain(self.sides().map(|side| (side.resource(), side.range())))
    }

    /// Whether it writes some of an image.
    #[must_use]
    pub fn writes(&self, image: ImageId) -> bool {
        let stored = |access: &Access| access.image == image && !access.accesses.writes().is_empty();
        let attached = |attachment: &Attachment| {
            attachment.image == image || attachment.resolve.as_ref().is_some_and(|resolve| resolve.image == image)
        };
        let moved = match self {
            Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => Some(transfer.target),
            Work::Fill(fill) => Some(fill.target),
            Work::Render(_) | Work::Dispatch(_) | Work::Custom(_) | Work::Export => None,
        };
        moved.is_some_and(|side| side.resource() == Resource::Image(image))
            || self.attachments().any(attached)
            || self.passes().iter().flat_map(|pass| &pass.accesses).any(stored)
    }
}

impl Step {
    /// All that it touches: what its barriers are about, what its work uses, and what outside owners give or get.
    pub fn touched(&self) -> impl Iterator<Item = Resource> {
        self.touched_inside().chain(self.outside.iter().map(|it| it.resource))
    }

    /// The same without what outside owners give or get.
    pub(crate) fn touched_inside(&self) -> impl Iterator<Item = Resource> {
        let images = self.image_barriers.iter().chain(&self.releases).map(|barrier| Resource::Image(barrier.image));
        let hazards = self.memory_barriers.iter().flat_map(|barrier| &barrier.buffers);
        let buffers = hazards.map(|hazard| Resource::Buffer(hazard.buffer));
        images.chain(buffers).chain(self.work.used().map(|(resource, _)| resource))
    }
}
