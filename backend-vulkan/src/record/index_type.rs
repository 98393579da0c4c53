//! The types of indices.

use ash::vk;

/// The type of an index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum IndexType {
    /// Two bytes.
    U16,
    /// Four bytes.
    U32,
}

impl IndexType {
    /// Bytes of an index.
    pub(super) const fn bytes(self) -> u64 {
        match self {
            IndexType::U16 => 2,
            IndexType::U32 => 4,
        }
    }

    pub(super) const fn vulkan(self) -> vk::IndexType {
        match self {
            IndexType::U16 => vk::IndexType::UINT16,
            IndexType::U32 => vk::IndexType::UINT32,
        }
    }
}
