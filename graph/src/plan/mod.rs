//! The Plan: what the compiler decided, as plain data with a stable JSON form.
//!
//! A Plan is self-sufficient: whoever reads it, in this process or another program, can check it and replay it without the
//! pipeline file. Names of stages, accesses, layouts, usages, formats and operations are Vulkan's, without prefix. Sets of
//! flags are written `A | B`. Everything is in execution order; same input, same bytes. `docs/plan-format.md` describes the
//! JSON form field by field.
//!
//! What a step touches:
//! - A [`Work::Render`] scope touches its attachments as their load, store and resolve operations say (colour in
//!   `COLOR_ATTACHMENT_OUTPUT`; depth loads in `EARLY_FRAGMENT_TESTS`, stores in `LATE_FRAGMENT_TESTS`; *every* resolve in
//!   `COLOR_ATTACHMENT_OUTPUT`), and each of its passes touches what its `accesses` list.
//! - A [`Work::Dispatch`] touches its accesses.
//! - A [`Work::Resolve`] or [`Work::Copy`] reads its source and writes its target.
//! - [`Work::Export`] touches nothing: its barriers leave outputs in the state that [`Role::Output`] promises.

use crate::format::Format;
use crate::source::Place;
use crate::vocabulary::{Accesses, Aspects, Layout, Stages, Usage};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

mod json;
pub(crate) mod names;
mod outline;
mod totals;
mod tree;
mod work;

pub use json::PlanError;
pub use totals::Totals;
pub use work::{Access, Attachment, AttachmentResolve, Binding, DepthState, Param, Pass, RenderScope, Transfer, Work};

/// The version of the JSON form that this library writes and reads.
pub const FORMAT_VERSION: u32 = 1;

/// Index of an image in [`Plan::images`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ImageId(pub u32);

/// Index of a step in [`Plan::steps`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct StepId(pub u32);

/// What a frame does on a device, step by step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// [`FORMAT_VERSION`] of the library that wrote it.
    pub format_version: u32,
    /// The device it was made for.
    pub device: DeviceUsed,
    /// Settings in force.
    pub settings: Vec<SettingUsed>,
    /// Every image; an [`ImageId`] is an index into this list.
    pub images: Vec<Image>,
    /// Blocks of memory that transient images share.
    pub heaps: Vec<Heap>,
    /// Steps in execution order.
    pub steps: Vec<Step>,
    /// Images that leave the frame, in the pipeline's order.
    pub outputs: Vec<ImageId>,
    /// Decisions that no step shows: what was left out, lowered, not merged or not folded, and why.
    pub notes: Vec<Note>,
    /// Sums.
    pub totals: Totals,
}

/// The device that a Plan was made for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceUsed {
    /// Name in its profile.
    pub name: String,
    /// Whether memory needs are the device's own (`true`) or estimated from a profile.
    pub exact_memory: bool,
}

/// A setting in force.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SettingUsed {
    /// Name.
    pub name: Arc<str>,
    /// Value, as it is shown.
    pub value: String,
}

/// A physical image.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Image {
    /// Its own index, for readers of the JSON form.
    pub id: ImageId,
    /// Unique name: that of the pipeline's image, with a suffix for resolved and second images.
    pub name: Arc<str>,
    /// Why it exists.
    pub cause: Cause,
    /// Texel format.
    pub format: Format,
    /// Width, height, depth in texels.
    pub extent: [u32; 3],
    /// Mip levels.
    pub mips: u32,
    /// Array layers.
    pub layers: u32,
    /// Samples a texel.
    pub samples: u32,
    /// Uses, exactly those that the steps make of it.
    pub usage: Usage,
    /// Where its memory comes from.
    pub role: Role,
}

/// Where an image's memory comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Role {
    /// Lives within the frame, at an offset of a heap that it shares.
    Transient(Placement),
    /// Memory of its own, made by whoever runs the Plan, which finds it in `after` when the frame is done.
    Output {
        /// State that the frame may rely on when it begins. Contents are never relied on.
        before: ImageState,
        /// State that the frame leaves it in.
        after: ImageState,
    },
}

/// A place in a heap.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Placement {
    /// Index into [`Plan::heaps`].
    pub heap: u32,
    /// Offset in bytes.
    pub offset: u64,
    /// Bytes that it takes.
    pub bytes: u64,
    /// Alignment that it needs.
    pub alignment: u64,
    /// Memory types that will do, one bit each.
    pub type_bits: u32,
    /// First and last step that touch it. Between them the memory is its own.
    pub lifetime: [StepId; 2],
}

/// The last accesses of an image, and its layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImageState {
    /// Stages.
    pub stages: Stages,
    /// Accesses.
    pub accesses: Accesses,
    /// Layout.
    pub layout: Layout,
}

/// A block of memory for transient images.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Heap {
    /// Bytes.
    pub bytes: u64,
    /// Alignment.
    pub alignment: u64,
    /// Memory types that every image in it accepts.
    pub type_bits: u32,
    /// Whether lazily allocated memory is asked for.
    pub lazily_allocated: bool,
}

/// One step on a queue: first its barriers, all in one call, then its work.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// The queue it runs on.
    pub queue: Queue,
    /// Memory barriers before the work.
    pub memory_barriers: Vec<MemoryBarrier>,
    /// Image barriers before the work.
    pub image_barriers: Vec<ImageBarrier>,
    /// The work.
    pub work: Work,
}

/// A kind of queue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum Queue {
    /// Graphics, compute and transfer.
    Graphics,
}

/// A `VkMemoryBarrier2`: used where memory changes hands, since an image barrier covers only its own image.
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
    /// Previous and next occupant of each piece of memory that changes hands.
    pub hand_overs: Vec<[ImageId; 2]>,
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
    /// Why it is there.
    pub hazard: Hazard,
    /// The last step that it waits for, in this frame; `None`: what came before the frame.
    pub after: Option<StepId>,
}

/// Why a barrier is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hazard {
    /// First use in the frame: the layout is set, and whatever used the memory before is waited for.
    FirstUse,
    /// A read of what an earlier step wrote.
    ReadAfterWrite,
    /// A write of what an earlier step read.
    WriteAfterRead,
    /// A write of what an earlier step wrote.
    WriteAfterWrite,
    /// Reads in another layout than earlier reads.
    LayoutChange,
    /// The state that an output is promised in.
    Export,
}

/// A part of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Subresources {
    /// Planes.
    pub aspects: Aspects,
    /// First mip level.
    pub base_mip: u32,
    /// Number of mip levels.
    pub mips: u32,
    /// First array layer.
    pub base_layer: u32,
    /// Number of array layers.
    pub layers: u32,
}

/// Why something is in a Plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// The pipeline says so, there (`None`: the frame was built in memory).
    Written(Option<Place>),
    /// The compiler inserted it.
    Inserted {
        /// In the reader's words: "pass `tonemap` samples `color` and it has 4 samples".
        because: String,
        /// The place that made it necessary.
        at: Option<Place>,
    },
}

/// A decision that no step shows.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Note {
    /// Which stage decided.
    pub stage: Stage,
    /// What it is about: a pass or an image.
    pub subject: Arc<str>,
    /// In the reader's words.
    pub text: String,
    /// The place it comes from.
    pub at: Option<Place>,
}

/// A stage of the compiler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Settings and conditions.
    Expand,
    /// Versions and dependencies.
    Link,
    /// What reaches no output goes.
    Cull,
    /// Samples, sizes and formats meet.
    Adapt,
    /// The order.
    Schedule,
    /// Rendering scopes.
    Scope,
    /// Load and store operations.
    Retain,
    /// Memory.
    Place,
    /// Barriers.
    Synchronise,
}

impl Subresources {
    /// All of an image.
    #[must_use]
    pub const fn all(format: Format, mips: u32, layers: u32) -> Subresources {
        Subresources { aspects: format.aspects(), base_mip: 0, mips, base_layer: 0, layers }
    }
}

impl Plan {
    /// The image with the id `id`.
    ///
    /// # Panics
    /// If the Plan has no such image; a Plan that came from outside must have passed [`Plan::from_json`].
    #[must_use]
    pub fn image(&self, id: ImageId) -> &Image {
        &self.images[id.0 as usize]
    }

    /// The tree form for people.
    #[must_use]
    pub fn tree(&self) -> String {
        tree::tree(self)
    }
}
