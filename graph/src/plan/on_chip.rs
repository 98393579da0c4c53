//! What stays on the chip of a device that draws in tiles: attachments that no scope brings to memory.
//!
//! Such an attachment lies in lazily allocated memory, which only those devices have, and its scope neither loads nor stores it.
//! Its bytes are counted once, however many passes of the scope draw into it. That is the least that scopes of their own would
//! move: between two of them, an attachment is stored and loaded.

use super::{Attachment, ImageId, Plan, Step};
use crate::vulkan::{LoadOp, StoreOp};

impl Plan {
    /// The bytes that stay on the chip in all steps.
    #[must_use]
    pub fn on_chip(&self) -> u64 {
        self.steps.iter().map(|step| self.on_chip_in(step)).fold(0, u64::saturating_add)
    }

    /// The bytes that stay on the chip in one of its steps.
    #[must_use]
    pub fn on_chip_in(&self, step: &Step) -> u64 {
        self.on_chip_of_each(step).into_iter().map(|(_, bytes)| bytes).fold(0, u64::saturating_add)
    }

    /// The bytes that stay on the chip in one of its steps, attachment by attachment: those of depth and of stencil stand apart.
    #[must_use]
    pub fn on_chip_of_each(&self, step: &Step) -> Vec<(ImageId, u64)> {
        let stay = step.work.attachments().filter(|attachment| self.stays_on_chip(attachment));
        stay.map(|attachment| (attachment.image, self.of_range(attachment.image, attachment.range))).collect()
    }

    fn stays_on_chip(&self, attachment: &Attachment) -> bool {
        let heap = self.image(attachment.image).role.placement().and_then(|it| self.heaps.get(it.heap as usize));
        heap.is_some_and(|heap| heap.lazily_allocated)
            && attachment.load != LoadOp::Load
            && attachment.store != StoreOp::Store
    }
}
