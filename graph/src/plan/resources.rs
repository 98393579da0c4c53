//! Physical images and buffers, and the memory that they lie in.

use super::{BufferId, Cause, ImageId, StepId};
use crate::frame::{EyeForm, TextureFile};
use crate::vulkan::{BufferUsage, FillValue, Format, OutsideOwner, Rotation, Shape, Sharing, State, Usage};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

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
    /// The effect of the pipeline's choice of that format, if a policy of the pipeline made one.
    pub chosen: Option<ChosenFormat>,
    /// Flat, deep, or a cube.
    pub shape: Shape,
    /// Width, height, depth in texels: of the part in use, if more is allocated.
    pub extent: [u32; 3],
    /// The allocated width and height, where `extent` is only the part that this frame uses, from the upper left
    /// corner on; `None`: `extent`. Shaders find the part by what they know as `NAME_st`.
    #[serde(rename = "room")]
    pub allocated: Option<[u32; 2]>,
    /// The rotation of its contents: a turned image is only drawn into, filled or left to a program that knows. `extent` and
    /// `allocated` are those of the turned picture.
    pub rotation: Rotation,
    /// The form in which it holds both eyes' parts, if it does. Its other properties, here and wherever it is named, are then
    /// those of one eye's part, and all work on it is done to both parts. It is made with [`Image::made`] and
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

/// The effect of a format that a policy of the pipeline chose.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChosenFormat {
    /// The policy: "`color: Smallest`".
    pub because: Arc<str>,
    /// The format without the policy.
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
    /// Memory of its own, made by the executor; contents stay from frame to frame.
    Persistent {
        /// The image or buffer that it becomes in the next frame (index into the same list): itself, or with history the one
        /// for one frame further back. Over all persistent images, and over all persistent buffers, this is a permutation.
        becomes: u32,
        /// Contents before the first frame, in the state `before`. The first frame waits until they are there.
        initial: FirstContents,
        /// State in which a frame finds it: the `after` of the one that becomes it.
        before: State,
        /// State in which a frame leaves it.
        after: State,
    },
    /// Memory from outside: an output that the embedding program (or the executor for it) finds in `after` when the
    /// frame is done, or something that it hands in.
    External {
        /// State that the frame may rely on when it begins. Layout `UNDEFINED`: contents are not relied on.
        before: State,
        /// State that the frame leaves it in: its next user waits for these stages and accesses, with a barrier of
        /// its own, or by a semaphore if there are none.
        after: State,
        /// Who else than this device has it between frames. Each frame takes it over and gives it back:
        /// [`Step::outside`](super::Step::outside).
        #[serde(default, skip_serializing_if = "Option::is_none")]
        owner: Option<OutsideOwner>,
    },
}

impl Role {
    /// The place in a heap of what lives within the frame.
    #[must_use]
    pub const fn placement(&self) -> Option<&Placement> {
        match self {
            Role::Transient(placement) => Some(placement),
            Role::Persistent { .. } | Role::External { .. } => None,
        }
    }

    /// Who else than this device has it between frames.
    #[must_use]
    pub const fn owner(&self) -> Option<OutsideOwner> {
        match self {
            Role::External { owner, .. } => *owner,
            Role::Transient(_) | Role::Persistent { .. } => None,
        }
    }

    /// The states in which a frame finds and leaves what outlives it.
    #[must_use]
    pub const fn states(&self) -> Option<[&State; 2]> {
        match self {
            Role::Transient(_) => None,
            Role::Persistent { before, after, .. } | Role::External { before, after, .. } => Some([before, after]),
        }
    }
}

/// Contents of a persistent image or buffer before the first frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FirstContents {
    /// This value, in every texel or word.
    Value(FillValue),
    /// An image: the picture of a file in its first mip level, and in each smaller one the mean of the level before; or all that
    /// a texture file stores. No step writes it.
    File(Arc<TextureFile>),
}

/// A place in a heap.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Placement {
    /// Index into [`Plan::heaps`](super::Plan::heaps).
    pub heap: u32,
    /// Offset in bytes.
    pub offset: u64,
    /// Bytes that it takes.
    pub bytes: u64,
    /// Alignment that it needs.
    pub alignment: u64,
    /// Memory types that will do, one bit each.
    pub type_bits: u32,
    /// First and last step whose work accesses it. Between them the memory is its own. Barriers for its first use may
    /// stand before an earlier step, if the previous user of the memory is done by then.
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
