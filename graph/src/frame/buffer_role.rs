//! Roles of buffers in passes, and what is known of each.

use crate::device::Limit;
use crate::vulkan::AccessKind;
use serde::{Deserialize, Serialize};

/// The role of a buffer in a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BufferRole {
    /// A uniform block.
    Uniform,
    /// A storage block.
    Storage {
        /// Whether earlier contents are read or kept. A storage write that is not `read` replaces the buffer whole.
        read: bool,
        /// Whether it is written.
        write: bool,
    },
    /// Vertex attributes.
    Vertex,
    /// Indices of 32 bits.
    Index,
    /// Counts of a draw or dispatch.
    Indirect,
    /// The number of draws whose counts stand in the buffer of the role `Indirect`.
    Count,
}

impl BufferRole {
    /// The kind of access.
    pub(crate) const fn kind(self) -> AccessKind {
        match self {
            BufferRole::Uniform => AccessKind::Uniform,
            BufferRole::Storage { .. } => AccessKind::Storage,
            BufferRole::Vertex => AccessKind::Vertex,
            BufferRole::Index => AccessKind::Index,
            BufferRole::Indirect | BufferRole::Count => AccessKind::Indirect,
        }
    }

    /// Whether shaders access it, in stages that the pass says.
    #[must_use]
    pub const fn is_of_shaders(self) -> bool {
        match self {
            BufferRole::Uniform | BufferRole::Storage { .. } => true,
            BufferRole::Vertex | BufferRole::Index | BufferRole::Indirect | BufferRole::Count => false,
        }
    }

    /// Whether it holds the counts of a draw or dispatch.
    #[must_use]
    pub const fn is_indirect(self) -> bool {
        matches!(self, BufferRole::Indirect)
    }

    /// Whether it holds a number of draws.
    #[must_use]
    pub const fn is_count(self) -> bool {
        matches!(self, BufferRole::Count)
    }

    /// Whether it holds indices.
    #[must_use]
    pub const fn is_index(self) -> bool {
        matches!(self, BufferRole::Index)
    }

    /// Whether earlier contents are read or kept.
    #[must_use]
    pub const fn reads(self) -> bool {
        !matches!(self, BufferRole::Storage { read: false, .. })
    }

    /// Whether the buffer is written.
    #[must_use]
    pub const fn writes(self) -> bool {
        matches!(self, BufferRole::Storage { write: true, .. })
    }

    /// The device's limit of its bytes, and what a shader sees it as, if a shader does.
    #[must_use]
    pub const fn limit(self) -> Option<(Limit, &'static str)> {
        match self {
            BufferRole::Uniform => Some((Limit::UniformBytes, "uniform block")),
            BufferRole::Storage { .. } => Some((Limit::StorageBytes, "storage block")),
            BufferRole::Vertex | BufferRole::Index | BufferRole::Indirect | BufferRole::Count => None,
        }
    }

    /// What it is, for people.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            BufferRole::Uniform => "uniform",
            BufferRole::Storage { write: false, .. } => "storage, read",
            BufferRole::Storage { read: false, .. } => "storage, written",
            BufferRole::Storage { .. } => "storage, read and written",
            BufferRole::Vertex => "vertices",
            BufferRole::Index => "indices",
            BufferRole::Indirect => "counts",
            BufferRole::Count => "number of draws",
        }
    }

    /// The `read` of a storage block, which can be changed by this, and its `write`; `None` for other roles.
    pub(crate) const fn storage_mut(&mut self) -> Option<(&mut bool, bool)> {
        match self {
            BufferRole::Storage { read, write } => Some((read, *write)),
            BufferRole::Uniform | BufferRole::Vertex | BufferRole::Index | BufferRole::Indirect | BufferRole::Count => {
                None
            }
        }
    }
}
