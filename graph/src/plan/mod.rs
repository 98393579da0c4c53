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
//! - A [`Work::Dispatch`] or [`Work::Custom`] touches its accesses.
//! - A [`Work::Resolve`], [`Work::Copy`] or [`Work::Blit`] reads its source and writes its target in the stage of that name
//!   (`RESOLVE`, `COPY`, `BLIT`); a [`Work::Fill`] writes its target in `CLEAR`.
//! - [`Work::Export`] touches nothing: its barriers leave images in the state that their [`Role`] promises, or change their
//!   layout before several queues read them.
//!
//! Order. Steps stand in the order in which they are submitted; those of one queue run in that order, as far as their
//! barriers make them. A [`Wait`] of a step holds up the whole step, barriers included, until a step on another queue has
//! finished, its writes made available; it makes them visible in the stages that it names.
//!
//! Frames. The same Plan is executed frame after frame on the same queues; the host may submit the next before the last has
//! finished. Nothing orders frames but the Plan's own barriers and waits: transient memory is handed from the last step that
//! uses it to the first one in the next frame, and what persists is found in the state in which the frame before left it.
//! At the end of a frame each persistent image or buffer becomes the one that `becomes` names: itself, or for history the
//! one that stands for one frame further back, and the oldest becomes the newest again. What the host writes or reads itself
//! (parameters, object data, outputs) is not the Plan's: whoever executes it keeps one copy for each frame in flight.

use crate::base::Place;
use crate::frame::change::Action;
use crate::frame::{DrawList, EyeForm, Stereo, TextureFile};
pub use crate::vulkan::Subresources;
use crate::vulkan::{Accesses, BufferUsage, FillValue, Format, Layout, Rotation, Shape, Sharing, Stages, State, Usage};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

mod changes;
mod json;
pub(crate) mod names;
mod note;
mod outline;
mod output;
mod part;
mod totals;
mod tree;
mod values;
mod view;
mod work;

pub use json::PlanError;
pub use note::{Note, Stage};
pub use output::Output;
pub use totals::Totals;
pub use view::{View, ViewEye};
pub use work::{
    Access, Attachment, AttachmentResolve, Binding, BindingKind, BufferAccess, DepthState, Fill, Param, Pass,
    RenderScope, Side, Transfer, Work,
};

/// The version of the JSON form that this library writes and reads.
pub const FORMAT_VERSION: u32 = 9;

/// Index of an image in [`Plan::images`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ImageId(pub u32);

/// Index of a buffer in [`Plan::buffers`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct BufferId(pub u32);

/// An image or a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Resource {
    /// An image.
    Image(ImageId),
    /// A buffer.
    Buffer(BufferId),
}

/// Index of a step in [`Plan::steps`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct StepId(pub u32);

/// Index of a view in [`Plan::views`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ViewId(pub u32);

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
    /// What files did to the pipeline that they extend, in the order in which they did it.
    pub changes: Vec<Change>,
    /// How it is drawn for two eyes: what scopes do whose attachments hold both eyes' parts ([`Image::eyes`]).
    pub stereo: Stereo,
    /// The views that passes draw for, the main one first; empty if the frame names none. A [`ViewId`] is an index into this
    /// list.
    pub views: Vec<View>,
    /// Every image; an [`ImageId`] is an index into this list.
    pub images: Vec<Image>,
    /// Every buffer; a [`BufferId`] is an index into this list.
    pub buffers: Vec<Buffer>,
    /// Blocks of memory that transient images or buffers share.
    pub heaps: Vec<Heap>,
    /// Steps in the order in which they are submitted.
    pub steps: Vec<Step>,
    /// What leaves the frame, in the pipeline's order.
    pub outputs: Vec<Output>,
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

/// Something that a file did to the pipeline that it extends.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// What.
    pub action: Action,
    /// Where it says so.
    pub at: Option<Place>,
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
    /// What the pipeline's choice of that format comes to, if a policy of it made one.
    pub chosen: Option<ChosenFormat>,
    /// Flat, deep, or a cube.
    pub shape: Shape,
    /// Width, height, depth in texels: of the part in use, if it has room for more.
    pub extent: [u32; 3],
    /// Width and height that it is made with, where `extent` is only the part that this frame uses, from the upper left
    /// corner on; `None`: `extent`. Shaders find the part by what they know as `NAME_st`.
    pub room: Option<[u32; 2]>,
    /// By how much what it holds is turned: it is only drawn into, filled or left to a program that knows. `extent` and
    /// `room` are those of the turned picture.
    pub rotation: Rotation,
    /// How it holds both eyes' parts, if it does. Everything else that is said of it here, and wherever it is named, is said
    /// of one eye's part then, and what is done to it is done to both; it is made with [`Image::made`] and
    /// [`Image::made_layers`].
    pub eyes: Option<EyeForm>,
    /// Mip levels.
    pub mips: u32,
    /// Array layers.
    pub layers: u32,
    /// Samples a texel.
    pub samples: u32,
    /// Uses, exactly those that the steps make of it; of an image that outlives the frame also `TRANSFER_SRC` (it may be
    /// read back) and, if it has initial contents, `TRANSFER_DST`.
    pub usage: Usage,
    /// Whether several queues may use it without handing it over.
    pub sharing: Sharing,
    /// Where its memory comes from.
    pub role: Role,
}

/// What a format comes to that a policy of the pipeline chose.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChosenFormat {
    /// The policy: "`color: Smallest`".
    pub because: Arc<str>,
    /// The format without it.
    pub usual: Format,
    /// Bytes that the image takes more than it would in the usual format; below 0: fewer.
    pub more_bytes: i64,
}

/// A buffer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Buffer {
    /// Its own index, for readers of the JSON form.
    pub id: BufferId,
    /// Unique name, among images too.
    pub name: Arc<str>,
    /// Why it exists.
    pub cause: Cause,
    /// Bytes.
    pub bytes: u64,
    /// Uses, as of an image.
    pub usage: BufferUsage,
    /// Whether several queues may use it without handing it over. Buffers that several queues use are always `CONCURRENT`.
    pub sharing: Sharing,
    /// Where its memory comes from. The layout in its states is `UNDEFINED`.
    pub role: Role,
}

/// Where the memory of an image or a buffer comes from, and in what state frames find it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Role {
    /// Lives within the frame, at an offset of a heap that it shares.
    Transient(Placement),
    /// Memory of its own, made by whoever runs the Plan; contents stay from frame to frame.
    Persistent {
        /// What it is in the next frame (index into the same list): itself, or with history the one that stands for one
        /// frame further back. Over all persistent images, and over all persistent buffers, this is a permutation.
        becomes: u32,
        /// Contents before the first frame, in the state `before`. The first frame waits until they are there.
        initial: Initial,
        /// State in which a frame finds it: the `after` of the one that becomes it.
        before: State,
        /// State in which a frame leaves it.
        after: State,
    },
    /// Memory from outside: an output that the embedding program (or whoever runs the Plan for it) finds in `after` when the
    /// frame is done, or something that it hands in.
    External {
        /// State that the frame may rely on when it begins. Layout `UNDEFINED`: contents are not relied on.
        before: State,
        /// State that the frame leaves it in: whoever uses it next waits for these stages and accesses, with a barrier of
        /// its own, or by a semaphore if there are none.
        after: State,
    },
}

/// What something persistent holds before the first frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Initial {
    /// This, in every texel or word.
    Value(FillValue),
    /// An image: the picture of a file in its first mip level, and in each smaller one the mean of the level before. No step
    /// writes it.
    File(Arc<TextureFile>),
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
    /// First and last step whose work touches it. Between them the memory is its own. Barriers for its first use may
    /// stand before an earlier step, if whoever had the memory is done by then.
    pub lifetime: [StepId; 2],
}

/// A block of memory for transient images, or for transient buffers.
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

/// One step on a queue: first what it waits for, then its barriers, all in one call, then its work, then the images that it
/// hands to other queues.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// The queue it runs on.
    pub queue: Queue,
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
    /// Of which frame: 0 is this one, 1 the one before.
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
    /// Previous and next occupant of each piece of memory that changes hands.
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
    /// The state in which an image that outlives the frame is promised.
    Export,
    /// Another queue takes it over.
    Ownership,
}

/// Why something is in a Plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// The pipeline says so, there (`None`: the frame was built in memory).
    Written(Option<Place>),
    /// The compiler inserted it. Few things are: what all the others hold is kept small.
    Inserted(Box<Inserted>),
}

/// Why the compiler inserted something.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Inserted {
    /// In the reader's words: "pass `tonemap` samples `color` and it has 4 samples".
    pub because: String,
    /// The place that made it necessary.
    pub at: Option<Place>,
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

    /// By how much what a rendering scope draws is turned: as its attachments are.
    #[must_use]
    pub fn rotation(&self, scope: &RenderScope) -> Rotation {
        self.first_attachment(scope).map_or(Rotation::Identity, |it| it.rotation)
    }

    /// How a rendering scope's attachments hold both eyes' parts, if they do: then each of its draws is for both.
    #[must_use]
    pub fn eyes(&self, scope: &RenderScope) -> Option<EyeForm> {
        self.first_attachment(scope).and_then(|it| it.eyes)
    }

    fn first_attachment(&self, scope: &RenderScope) -> Option<&Image> {
        let first = scope.color.iter().chain(&scope.depth).chain(&scope.stencil).next();
        first.and_then(|first| self.images.get(first.image.0 as usize))
    }

    /// The tree form for people.
    #[must_use]
    pub fn tree(&self) -> String {
        tree::tree(self, None)
    }

    /// The tree form for people, of a frame of a scene that has so many objects in each draw list: passes say how many they
    /// draw at most.
    #[must_use]
    pub fn tree_of(&self, objects: &dyn Fn(DrawList) -> usize) -> String {
        tree::tree(self, Some(objects))
    }
}
