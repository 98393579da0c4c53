//! Bytes that a frame moves: what scopes load and store, and what resolves, copies, blits and fills read and write.
//!
//! If the size of an image may change, its part in use counts. Samples, clears and draws aren't part of it, nor is what a device compresses
//! or keeps in its caches.

use super::{Attachment, Image, ImageId, Plan, Resource, Side, Step, Transfer, Work};
use crate::device::ImageDescriptor;
use crate::frame::EyeForm;
use crate::vulkan::{LoadOp, StoreOp, Subresources};
use serde::Serialize;
use std::ops::Add;

/// Bytes that a step, or a frame, moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct MovedBytes {
    /// Loaded when rendering scopes begin.
    pub loaded: u64,
    /// Stored when they end.
    pub stored: u64,
    /// Written by resolves, and read by those that are steps of their own.
    pub resolved: u64,
    /// Read and written by copies and blits, and written by fills.
    pub copied: u64,
}

impl MovedBytes {
    /// All of them; [`u64::MAX`] if the sum is larger.
    #[must_use]
    pub fn sum(self) -> u64 {
        [self.loaded, self.stored, self.resolved, self.copied].into_iter().fold(0, u64::saturating_add)
    }
}

impl Add for MovedBytes {
    type Output = MovedBytes;

    fn add(self, other: MovedBytes) -> MovedBytes {
        MovedBytes {
            loaded: self.loaded.saturating_add(other.loaded),
            stored: self.stored.saturating_add(other.stored),
            resolved: self.resolved.saturating_add(other.resolved),
            copied: self.copied.saturating_add(other.copied),
        }
    }
}

impl Plan {
    /// The bytes that all steps move.
    #[must_use]
    pub fn moved(&self) -> MovedBytes {
        self.steps.iter().map(|step| self.moved_by(step)).fold(MovedBytes::default(), Add::add)
    }

    /// The bytes that one of its steps moves.
    #[must_use]
    pub fn moved_by(&self, step: &Step) -> MovedBytes {
        self.moved_of_each(step).into_iter().map(|(_, moved)| moved).fold(MovedBytes::default(), Add::add)
    }

    /// The bytes that one of its steps moves, image by image and buffer by buffer; one may stand there more than once.
    #[must_use]
    pub fn moved_of_each(&self, step: &Step) -> Vec<(Resource, MovedBytes)> {
        let none = MovedBytes::default();
        let sides = |transfer: &Transfer, moved: fn(u64) -> MovedBytes| {
            [transfer.source, transfer.target].map(|side| (side.resource(), moved(self.of_side(side)))).into()
        };
        match &step.work {
            Work::Render(scope) => {
                scope.attachments.iter().flat_map(|attachment| self.of_attachment(attachment)).collect()
            }
            Work::Resolve(transfer) => sides(transfer, |resolved| MovedBytes { resolved, ..MovedBytes::default() }),
            Work::Copy(transfer) | Work::Blit(transfer) => {
                sides(transfer, |copied| MovedBytes { copied, ..MovedBytes::default() })
            }
            Work::Fill(fill) => {
                vec![(fill.target.resource(), MovedBytes { copied: self.of_side(fill.target), ..none })]
            }
            Work::Dispatch(_) | Work::Custom(_) | Work::Export => Vec::new(),
        }
    }

    fn of_attachment(&self, attachment: &Attachment) -> impl Iterator<Item = (Resource, MovedBytes)> {
        let bytes = self.of_range(attachment.image, attachment.range);
        let own = MovedBytes {
            loaded: if attachment.load == LoadOp::Load { bytes } else { 0 },
            stored: if attachment.store == StoreOp::Store { bytes } else { 0 },
            ..MovedBytes::default()
        };
        let resolved = attachment.resolve.as_ref().map(|resolve| {
            let resolved = self.of_range(resolve.image, resolve.range);
            (Resource::Image(resolve.image), MovedBytes { resolved, ..MovedBytes::default() })
        });
        std::iter::once((Resource::Image(attachment.image), own)).chain(resolved)
    }

    fn of_side(&self, side: Side) -> u64 {
        match side {
            Side::Image { image, range, .. } => self.of_range(image, range),
            Side::Buffer { bytes, .. } => bytes,
        }
    }

    /// Bytes of a part of an image, as far as it is in use, for both eyes if it holds both.
    pub(super) fn of_range(&self, image: ImageId, range: Subresources) -> u64 {
        let Image { format, shape, extent, mips, layers, samples, usage, sharing, eyes, .. } = *self.image(image);
        let in_use = ImageDescriptor { format, shape, extent, mips, layers, samples, usage, sharing };
        in_use.bytes(range).saturating_mul(EyeForm::parts(eyes))
    }
}
