//! What `adapt` hands to the stages after it: physical images, and operations that use them.

use crate::device::ImageDescriptor;
use crate::frame::ImageIndex;
use crate::plan::{Cause, Note, Subresources};
use crate::source::Place;
use crate::vocabulary::{Filter, ResolveMode, Stages, Usage};
use std::ops::Range;
use std::sync::Arc;

/// A physical image.
#[derive(Debug, Clone)]
pub(super) struct Store {
    pub(super) name: Arc<str>,
    pub(super) cause: Cause,
    pub(super) descriptor: ImageDescriptor,
    /// Whether it leaves the frame.
    pub(super) output: bool,
}

impl Store {
    /// All of it.
    pub(super) fn range(&self) -> Subresources {
        Subresources::all(self.descriptor.format, self.descriptor.mips, self.descriptor.layers)
    }
}

/// Index into [`Adapted::stores`].
pub(super) type StoreIndex = u32;

/// Physical images and the operations on them, in frame order.
#[derive(Debug, Default)]
pub(super) struct Adapted {
    pub(super) stores: Vec<Store>,
    pub(super) ops: Vec<Op>,
    pub(super) uses: Vec<Use>,
    /// Stores of the frame's outputs, in its order.
    pub(super) outputs: Vec<StoreIndex>,
    pub(super) notes: Vec<Note>,
}

impl Adapted {
    /// The uses of operation number `op`.
    pub(super) fn uses(&self, op: u32) -> &[Use] {
        &self.uses[self.ops[op as usize].uses.start as usize..self.ops[op as usize].uses.end as usize]
    }
}

/// One operation.
#[derive(Debug)]
pub(super) struct Op {
    pub(super) kind: OpKind,
    /// Into [`Adapted::uses`].
    pub(super) uses: Range<u32>,
}

/// What an operation is.
#[derive(Debug)]
pub(super) enum OpKind {
    /// A raster pass of the frame.
    Draw(u32),
    /// A compute pass of the frame.
    Dispatch(u32),
    /// A full-screen copy that stands in for a pass of the frame that is off.
    ForwardDraw {
        /// The pass of the frame.
        pass: u32,
        /// Filter between texels of the source.
        filter: Filter,
        /// Why.
        because: String,
    },
    /// A resolve; its uses are source and target.
    Resolve {
        /// How samples become one value.
        mode: ResolveMode,
        /// Why.
        because: String,
        /// The place that made it necessary.
        at: Option<Place>,
    },
    /// A copy; its uses are source and target.
    Copy {
        /// Why.
        because: String,
        /// The place that made it necessary.
        at: Option<Place>,
    },
}

/// One use of a physical image by an operation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Use {
    pub(super) store: StoreIndex,
    pub(super) role: Role,
}

/// The role in which an operation uses an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Role {
    /// Sampled by shaders, as the pass's sampled image number `entry`.
    Sampled { entry: u32, stages: Stages },
    /// Accessed by shaders without sampling, as the pass's storage image number `entry`.
    Storage { entry: u32, stages: Stages, read: bool, write: bool },
    /// Colour attachment, as the pass's target number `entry`.
    Color { entry: u32, start: Start, blends: bool },
    /// Depth attachment.
    Depth { start: Start, write: bool },
    /// Source of a resolve or copy.
    Source,
    /// Target of a resolve or copy.
    Target,
}

/// What a pass finds in its attachment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Start {
    /// A clear value.
    Clear([f32; 4]),
    /// What was there.
    Keep,
    /// Nothing: it covers every pixel.
    Discard,
}

impl Role {
    /// Whether it is an attachment of a rendering scope.
    pub(super) fn is_attachment(&self) -> bool {
        matches!(self, Role::Color { .. } | Role::Depth { .. })
    }

    /// Whether it changes the image.
    pub(super) fn writes(&self) -> bool {
        match self {
            Role::Sampled { .. } | Role::Source => false,
            Role::Storage { write, .. } => *write,
            Role::Depth { start, write } => *write || *start != Start::Keep,
            Role::Color { .. } | Role::Target => true,
        }
    }

    /// Whether it needs what earlier operations left in the image.
    pub(super) fn reads(&self) -> bool {
        match self {
            Role::Sampled { .. } | Role::Source => true,
            Role::Storage { read, .. } => *read,
            Role::Color { start, .. } | Role::Depth { start, .. } => *start == Start::Keep,
            Role::Target => false,
        }
    }

    /// The usage that it takes; a resolve that a scope carries takes that of attachments instead.
    pub(super) fn usage(&self) -> Usage {
        match self {
            Role::Sampled { .. } => Usage::SAMPLED,
            Role::Storage { .. } => Usage::STORAGE,
            Role::Color { .. } => Usage::COLOR_ATTACHMENT,
            Role::Depth { .. } => Usage::DEPTH_STENCIL_ATTACHMENT,
            Role::Source => Usage::TRANSFER_SRC,
            Role::Target => Usage::TRANSFER_DST,
        }
    }
}

/// Sample counts in force, for each image of the frame.
#[derive(Debug)]
pub(super) struct Samples {
    pub(super) of: Vec<u32>,
    pub(super) notes: Vec<Note>,
}

impl Samples {
    /// The count of one image.
    pub(super) fn of(&self, image: ImageIndex) -> u32 {
        self.of[image.0 as usize]
    }
}
