//! Push constants of a draw source's draws: the bytes that it sets, and the blocks that shaders read.

use super::{DrawFault, DrawInterface, DrawPart};
use crate::device::{Limit, Need, NeedKind};
use crate::vulkan::Stages;

/// Bytes of push constants that some stages see (`VkPushConstantRange`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PushConstants {
    /// The stages: vertex, fragment or both.
    pub stages: Stages,
    /// The first byte, a multiple of 4.
    pub offset: u32,
    /// How many bytes there are, a multiple of 4 and at least 4.
    pub bytes: u32,
}

/// A block of push constants that a stage reads.
#[derive(Debug, Clone, PartialEq, Eq)]
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
        PushConstants { stages: Stages::VERTEX_SHADER.union(Stages::FRAGMENT_SHADER), offset, bytes }
    }

    /// The same, for some stages alone.
    #[must_use]
    pub const fn for_stages(mut self, stages: Stages) -> PushConstants {
        self.stages = stages;
        self
    }

    fn fault(&self) -> Option<String> {
        let PushConstants { stages, offset, bytes } = self;
        let both = Stages::VERTEX_SHADER | Stages::FRAGMENT_SHADER;
        if stages.is_empty() || !both.contains(*stages) {
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

impl DrawInterface {
    /// The byte behind the last push constant.
    #[must_use]
    pub fn pushed_bytes(&self) -> u32 {
        self.push_constants.iter().map(|it| it.offset.saturating_add(it.bytes)).max().unwrap_or(0)
    }

    /// Why a block of push constants doesn't fit what is brought along, in words; `None`: it does.
    #[must_use]
    pub fn pushed_misfit(&self, block: &PushedBlock) -> Option<String> {
        let PushedBlock { name, stages, offset, end } = block;
        let seen = || self.push_constants.iter().filter(|it| it.stages.contains(*stages));
        let holds = |it: &PushConstants| it.offset <= *offset && *end <= it.offset.saturating_add(it.bytes);
        if seen().any(holds) {
            return None;
        }
        let there: Vec<String> = seen().map(|it| format!("{} to {}", it.offset, it.offset + it.bytes - 1)).collect();
        let there = if there.is_empty() { "none".to_owned() } else { format!("bytes {}", there.join(" and ")) };
        Some(format!("push constants `{name}`, bytes {offset} to {}, and the stage is brought {there}", end - 1))
    }

    /// What is wrong with its push constants.
    pub(super) fn push_faults(&self) -> impl Iterator<Item = DrawFault> {
        let fault = |(number, it): (usize, &PushConstants)| {
            Some(DrawFault { at: DrawPart::PushConstants(number), message: it.fault()?, first: None })
        };
        self.push_constants.iter().enumerate().filter_map(fault)
    }
}

/// What the push constants of a draw source ask of the device.
#[must_use]
pub fn push_needs(brought: &DrawInterface) -> Option<Need> {
    let value = u64::from(brought.pushed_bytes());
    let what = || format!("{value} bytes of push constants are brought along").into();
    let limit = Limit::PushConstantBytes;
    (value > limit.least()).then(|| Need { kind: NeedKind::Limit { limit, value, what: what() }, place: "".into() })
}
