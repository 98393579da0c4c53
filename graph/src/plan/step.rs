//! Steps, and the waits and barriers before each.

use super::{BufferId, ImageId, OutsideTransfer, Resource, StepId, Work};
use crate::frame::Cadence;
use crate::vulkan::{Accesses, Layout, Stages, Subresources};
use serde::{Deserialize, Serialize};

/// One step on a queue: first what it waits for, then its barriers, all in one call, then its work, then the images that it
/// hands to other queues.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// The queue it runs on.
    pub queue: Queue,
    /// In which frames its work is done. Its waits and barriers stand in every frame.
    #[serde(default, skip_serializing_if = "Cadence::is_always")]
    pub run: Cadence,
    /// Steps of other queues that must have finished.
    pub waits: Vec<Wait>,
    /// Memory barriers before the work.
    pub memory_barriers: Vec<MemoryBarrier>,
    /// Image barriers before the work.
    pub image_barriers: Vec<ImageBarrier>,
    /// The work.
    pub work: Work,
    /// Image barriers after the work: the first halves of queue family ownership transfers.
    pub releases: Vec<ImageBarrier>,
    /// What it takes from outside owners, ahead of its other barriers, and gives back to them at its end; by image and buffer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outside: Vec<OutsideTransfer>,
}

/// A kind of queue. A device without the second or third uses the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum Queue {
    /// Graphics, compute and transfer.
    Graphics,
    /// Compute and transfer, beside graphics.
    Compute,
    /// Transfer only, beside the others.
    Transfer,
}

/// A wait for the timeline semaphore of another queue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wait {
    /// The step that must have finished; it runs on another queue, and if in the same frame stands further up.
    pub step: StepId,
    /// How many frames ago: 0 is this frame.
    pub frames_ago: u32,
    /// Stages that wait, and in which the other queue's writes are visible.
    pub stages: Stages,
}

/// A `VkMemoryBarrier2`: used for buffers, and where memory changes hands, since an image barrier covers only its own image.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MemoryBarrier {
    /// Stages that must have finished.
    pub src_stages: Stages,
    /// Their writes that are made available.
    pub src_accesses: Accesses,
    /// Stages that wait.
    pub dst_stages: Stages,
    /// Accesses that the writes are made visible to.
    pub dst_accesses: Accesses,
    /// Previous and next owner of each piece of memory that changes hands.
    pub hand_overs: Vec<[Resource; 2]>,
    /// Buffers that it is there for.
    pub buffers: Vec<BufferHazard>,
}

/// Why a memory barrier is there for a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BufferHazard {
    /// Which buffer.
    pub buffer: BufferId,
    /// Why.
    pub hazard: Hazard,
    /// The last step that it waits for, in this frame; `None`: what came before the frame.
    pub after: Option<StepId>,
    /// The first step that needs it: the one that it stands before, or a later one; `None`: what comes after the frame.
    pub needed_by: Option<StepId>,
}

/// A `VkImageMemoryBarrier2`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImageBarrier {
    /// Which image.
    pub image: ImageId,
    /// Which part of it.
    pub range: Subresources,
    /// Stages that must have finished.
    pub src_stages: Stages,
    /// Their writes that are made available.
    pub src_accesses: Accesses,
    /// Stages that wait.
    pub dst_stages: Stages,
    /// Accesses that the writes are made visible to.
    pub dst_accesses: Accesses,
    /// Layout before; `UNDEFINED` forgets the contents.
    pub old_layout: Layout,
    /// Layout after.
    pub new_layout: Layout,
    /// The queues between which it hands the image over, if it does: then it stands twice, with the same range and layouts,
    /// in the `releases` of the first queue and in the barriers of the second.
    pub ownership: Option<[Queue; 2]>,
    /// Why it is there.
    pub hazard: Hazard,
    /// The last step that it waits for, in this frame; `None`: what came before the frame.
    pub after: Option<StepId>,
    /// The first step that needs it: the one that it stands before, or a later one; `None`: what comes after the frame.
    pub needed_by: Option<StepId>,
}

/// Why a barrier is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hazard {
    /// First use in the frame: the barrier sets the layout, and waits for the work that used the memory before.
    FirstUse,
    /// A read of what an earlier step wrote.
    ReadAfterWrite,
    /// A write of what an earlier step read.
    WriteAfterRead,
    /// A write of what an earlier step wrote.
    WriteAfterWrite,
    /// Reads in another layout than earlier reads.
    LayoutChange,
    /// The state in which an image that outlives the frame is promised.
    Export,
    /// Another queue takes it over.
    Ownership,
}
