//! Who has images and buffers of the program's between frames.

use super::name_of;
use serde::{Deserialize, Serialize};

/// Who else than this device has an image or buffer of the program's between frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum OutsideOwner {
    /// Another device of Vulkan, of the same driver: its memory was handed over as an opaque one (`VK_QUEUE_FAMILY_EXTERNAL`).
    External,
    /// Anything else, as a camera, a decoder or a compositor that shares a DMA-BUF (`VK_QUEUE_FAMILY_FOREIGN_EXT`). The device must have
    /// `VK_EXT_queue_family_foreign` on.
    Foreign,
}

impl OutsideOwner {
    /// All of them.
    pub const ALL: [OutsideOwner; 2] = [OutsideOwner::External, OutsideOwner::Foreign];

    /// Its word in pipeline files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            OutsideOwner::External => "External",
            OutsideOwner::Foreign => "Foreign",
        }
    }

    /// Its name in messages: "its external owner".
    #[must_use]
    pub fn words(self) -> String {
        format!("its {} owner", name_of(&self).to_lowercase())
    }
}
