//! Who has images and buffers of the program's between frames.

use ash::vk;

/// Who has an image or buffer of the program's between frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum OutsideOwner {
    /// Another device of Vulkan, of the same driver: its memory was handed over as an opaque one (`VK_QUEUE_FAMILY_EXTERNAL`).
    External,
    /// Anything else, as a camera, a decoder or a compositor that shares a DMA-BUF (`VK_QUEUE_FAMILY_FOREIGN_EXT`). The device must have
    /// `VK_EXT_queue_family_foreign` on.
    Foreign,
}

impl OutsideOwner {
    pub(super) const fn family(self) -> u32 {
        match self {
            OutsideOwner::External => vk::QUEUE_FAMILY_EXTERNAL,
            OutsideOwner::Foreign => vk::QUEUE_FAMILY_FOREIGN_EXT,
        }
    }
}
