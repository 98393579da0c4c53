//! How queues share images and buffers.

use super::number::QUEUES;
use crate::compile::model::{PhysicalIndex, SubresourceIndex};
use crate::vulkan::{Accesses, Layout, Stages};

/// How several queues share an image or buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::compile) enum Crossing {
    /// A concurrent buffer: waits alone keep its accesses in order.
    Buffer,
    /// A concurrent image.
    Image,
    /// An exclusive image: one queue family at a time owns it.
    Exclusive,
    /// All queues read it, in one layout, and nothing ever writes it.
    Constant,
}

/// How queues use a subresource since its last write or change of layout.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::compile) struct QueueUses {
    pub(in crate::compile) by: [QueueUse; QUEUES],
    /// The queue and the step that wrote it, changed its layout, or used it first. All later reads come after that step.
    pub(in crate::compile) begun: (usize, u32),
    /// Whether that step wrote it, and nothing on its queue has read it since.
    pub(in crate::compile) unread: bool,
}

/// How one queue uses a subresource.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::compile) struct QueueUse {
    pub(in crate::compile) stages: Stages,
    pub(in crate::compile) accesses: Accesses,
    /// One more than the last step that uses it; 0 for none.
    pub(in crate::compile) until: u32,
    /// The barrier before the first of these uses, if there is one.
    pub(in crate::compile) barrier: Option<u32>,
}

/// A change of layout in a step of its own, before several queues read.
#[derive(Debug, Clone, Copy)]
pub(in crate::compile) struct LayoutChange {
    pub(in crate::compile) subresource: SubresourceIndex,
    pub(in crate::compile) resource: PhysicalIndex,
    pub(in crate::compile) layout: Layout,
}

/// A queue family ownership transfer: one queue acquires a subresource, with its contents, that another one releases.
#[derive(Debug, Clone, Copy)]
pub(in crate::compile) struct OwnershipTransfer {
    /// The barrier that acquires it.
    pub(in crate::compile) barrier: u32,
    /// The last step that uses it on the queue that releases it.
    pub(in crate::compile) from: u32,
    /// How that queue uses it.
    pub(in crate::compile) stages: Stages,
    pub(in crate::compile) accesses: Accesses,
}
