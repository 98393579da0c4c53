//! Draws whose counts a buffer holds: how many there are, and where they stand.

use serde::{Deserialize, Serialize};

/// Draws whose counts follow each other in the pass's buffer of the role [`BufferRole::Indirect`](super::BufferRole::Indirect).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IndirectDraws {
    /// How many there are, at least one; with `count` the most.
    pub draws: u32,
    /// The byte at which the first counts stand.
    pub offset: u64,
    /// Bytes from counts to counts; `None`: they stand side by side.
    pub stride: Option<u32>,
    /// The byte at which the number of draws stands, in the pass's buffer of the role [`BufferRole::Count`](super::BufferRole::Count);
    /// `None`: all are drawn.
    pub count: Option<u64>,
}

impl IndirectDraws {
    /// One draw, whose counts begin the buffer.
    pub const ONE: IndirectDraws = IndirectDraws { draws: 1, offset: 0, stride: None, count: None };

    /// Bytes of the counts of one draw: of a `VkDrawIndexedIndirectCommand` or a `VkDrawIndirectCommand`.
    #[must_use]
    pub const fn command_bytes(indexed: bool) -> u32 {
        if indexed { 20 } else { 16 }
    }

    /// Bytes from counts to counts.
    #[must_use]
    pub fn stride(self, indexed: bool) -> u32 {
        self.stride.unwrap_or(IndirectDraws::command_bytes(indexed))
    }

    /// Bytes up to the end of the last counts.
    #[must_use]
    pub fn end(self, indexed: bool) -> u64 {
        let before = u64::from(self.draws.saturating_sub(1)).saturating_mul(self.stride(indexed).into());
        self.offset.saturating_add(before).saturating_add(IndirectDraws::command_bytes(indexed).into())
    }

    /// Why no device draws them, in words; `None` if one may.
    #[must_use]
    pub fn fault(self, indexed: bool) -> Option<String> {
        let (bytes, stride) = (IndirectDraws::command_bytes(indexed), self.stride(indexed));
        let uneven = |what: &str, at: u64| Some(format!("{what} stands at a multiple of 4 bytes, not at {at}"));
        match self.count {
            _ if self.draws == 0 => Some("there is no draw".to_owned()),
            _ if !self.offset.is_multiple_of(4) => uneven("the first draw", self.offset),
            Some(at) if !at.is_multiple_of(4) => uneven("the number of draws", at),
            _ if stride < bytes || !stride.is_multiple_of(4) => {
                Some(format!("draws stand a multiple of 4 bytes apart, at least {bytes}, and not {stride}"))
            }
            _ => None,
        }
    }

    /// The features that it takes, by Vulkan's names, each with what for.
    pub fn features(self) -> impl Iterator<Item = (&'static str, &'static str)> {
        let many = ("multiDrawIndirect", "several indirect draws at once");
        let counted = ("drawIndirectCount", "a number of draws that a buffer holds");
        let all = [(self.draws > 1 && self.count.is_none(), many), (self.count.is_some(), counted)];
        all.into_iter().filter_map(|(takes, feature)| takes.then_some(feature))
    }
}
