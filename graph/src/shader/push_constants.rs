//! Push constants of a draw source's draws: the bytes that it sets, and the blocks that shaders read.

use crate::vulkan::Stages;
use serde::{Deserialize, Serialize};

/// Bytes of push constants that some stages see (`VkPushConstantRange`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PushConstants {
    /// The stages: vertex, fragment or both.
    pub stages: Stages,
    /// The first byte, a multiple of 4.
    pub offset: u32,
    /// How many bytes there are, a multiple of 4 and at least 4.
    pub bytes: u32,
}

/// A block of push constants that a stage reads.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PushedBlock {
    /// Its name in the shader.
    pub name: String,
    /// The stage.
    pub stages: Stages,
    /// The first byte of its members.
    pub offset: u32,
    /// The byte behind its members.
    pub end: u32,
}

impl PushConstants {
    /// Bytes that both stages of a draw see.
    #[must_use]
    pub const fn new(offset: u32, bytes: u32) -> PushConstants {
        PushConstants { stages: Stages::of_draws(), offset, bytes }
    }

    /// The same, for some stages alone.
    #[must_use]
    pub const fn for_stages(mut self, stages: Stages) -> PushConstants {
        self.stages = stages;
        self
    }

    /// What is wrong with them, in words.
    pub(super) fn fault(&self) -> Option<String> {
        let PushConstants { stages, offset, bytes } = self;
        if stages.is_empty() || !Stages::of_draws().contains(*stages) {
            return Some("push constants are for the stages `Vertex` and `Fragment`, or one of them".to_owned());
        }
        let whole = offset.is_multiple_of(4) && bytes.is_multiple_of(4) && *bytes > 0;
        (!whole || offset.checked_add(*bytes).is_none()).then(|| {
            format!(
                "{bytes} bytes of push constants from byte {offset} on: both are multiples of 4, and 4 bytes the least"
            )
        })
    }
}
