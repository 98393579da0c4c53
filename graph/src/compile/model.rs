//! Physical images and buffers, and operations that use them: the result of `adapt`, and the input of the stages after it.

use crate::device::{BufferDescriptor, ImageDescriptor};
use crate::frame::tracked_parts::Grid;
use crate::frame::{Cadence, EyeForm, ImageIndex, Resource, ViewIndex};
use crate::plan::{AttachmentKind, InsertionCause, Note};
use crate::vulkan::{
    AccessKind, Accesses, Aspects, BufferUsage, FillValue, Filter, Format, Layout, ResolveMode, Rotation, Sharing,
    Stages, State, Subresources, Usage,
};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// A physical image or buffer.
#[derive(Debug, Clone)]
pub(super) struct PhysicalResource {
    /// Its number among the images of the Plan, or among the buffers.
    pub(super) id: u32,
    /// The purpose that it was made for.
    pub(super) of: Resource,
    /// Its name, if that isn't the one of what it was made for.
    pub(super) renamed: Option<Arc<str>>,
    /// Why it was inserted, if it was.
    pub(super) inserted: Option<Box<InsertionCause>>,
    pub(super) kind: Kind,
    /// The format that it would have if the pipeline hadn't chosen another one.
    pub(super) usual: Option<Format>,
    pub(super) memory: MemorySource,
    /// The state in which it is to be left, if one was asked for.
    pub(super) after: Option<State>,
    /// How it is cut; `None`: it is one part.
    pub(super) grid: Option<Arc<Grid>>,
    /// The first of its subresources: what is tracked by itself.
    pub(super) first_subresource: u32,
}

/// Image or buffer.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    Image(ImageDescriptor),
    Buffer(BufferDescriptor),
}

/// Where the memory and the contents of a physical resource come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum MemorySource {
    /// It shares memory with others.
    Transient,
    /// Memory of its own, without contents from before the frame.
    Output,
    /// Memory of its own, with contents that stay: the next frame finds them in `becomes`. The first frame finds `initial`,
    /// or the contents of its file.
    Persistent { becomes: PhysicalIndex, initial: Option<FillValue> },
    /// The embedding program hands it in, in this state.
    Imported { before: State },
}

impl PhysicalResource {
    /// The descriptor, if it is an image.
    pub(super) fn image(&self) -> Option<&ImageDescriptor> {
        match &self.kind {
            Kind::Image(descriptor) => Some(descriptor),
            Kind::Buffer(_) => None,
        }
    }

    /// Its subresources.
    pub(super) fn subresources(&self) -> Range<SubresourceIndex> {
        self.first_subresource..self.first_subresource + self.grid.as_ref().map_or(1, |grid| grid.len())
    }

    /// Calls `visit` with its subresources in `range`.
    #[inline]
    pub(super) fn for_each_in(&self, range: Subresources, mut visit: impl FnMut(SubresourceIndex)) {
        match &self.grid {
            None => visit(self.first_subresource),
            Some(grid) => grid.cover(range).for_each(|part| visit(self.first_subresource + part)),
        }
    }

    /// The layout of all its planes, one of which is in `layout`.
    pub(super) fn layout_of_all_planes(&self, layout: Layout) -> Layout {
        let both = self.image().is_some_and(|image| image.format.aspects().contains(Aspects::STENCIL));
        match layout {
            Layout::DepthAttachmentOptimal | Layout::StencilAttachmentOptimal if both => {
                Layout::DepthStencilAttachmentOptimal
            }
            Layout::DepthReadOnlyOptimal | Layout::StencilReadOnlyOptimal if both => {
                Layout::DepthStencilReadOnlyOptimal
            }
            layout => layout,
        }
    }

    /// All of an image.
    pub(super) fn all(&self) -> Subresources {
        match &self.kind {
            Kind::Image(image) => Subresources::all(image.format, image.mips, image.layers),
            Kind::Buffer(_) => Subresources::WHOLE,
        }
    }

    /// Sets its usage flags, which are bits of `VkImageUsageFlags` or `VkBufferUsageFlags`.
    pub(super) fn set_usage(&mut self, bits: u32) {
        match &mut self.kind {
            Kind::Image(image) => image.usage = Usage::from_bits_truncate(bits),
            Kind::Buffer(buffer) => buffer.usage = BufferUsage::from_bits_truncate(bits),
        }
    }

    /// The bits of its usage flags.
    pub(super) fn usage(&self) -> u32 {
        match &self.kind {
            Kind::Image(image) => image.usage.bits(),
            Kind::Buffer(buffer) => buffer.usage.bits(),
        }
    }

    pub(super) fn set_sharing(&mut self, sharing: Sharing) {
        match &mut self.kind {
            Kind::Image(image) => image.sharing = sharing,
            Kind::Buffer(buffer) => buffer.sharing = sharing,
        }
    }

    pub(super) fn is_transient(&self) -> bool {
        matches!(self.memory, MemorySource::Transient)
    }
}

/// Index into [`AdaptedFrame::resources`].
pub(super) type PhysicalIndex = u32;
/// Number of a part of a physical image, or of a buffer, among all of them.
pub(super) type SubresourceIndex = u32;

/// Physical images and buffers, and the operations on them, in frame order.
#[derive(Debug, Default)]
pub(super) struct AdaptedFrame {
    pub(super) resources: Vec<PhysicalResource>,
    pub(super) ops: Vec<Op>,
    pub(super) uses: Vec<Use>,
    /// Ranges that are not all of their image.
    pub(super) ranges: Vec<Subresources>,
    /// Number of subresources of all resources.
    pub(super) subresources: u32,
    /// Number of buffers among the resources.
    pub(super) buffers: u32,
    /// In which frames each operation runs; empty if all run in each.
    pub(super) cadences: Vec<Cadence>,
    /// The frame's outputs, in its order.
    pub(super) outputs: Vec<PhysicalIndex>,
    /// The allocated width and height of images whose size may change.
    pub(super) allocated: HashMap<PhysicalIndex, [u32; 2]>,
    /// How images hold both eyes' parts, and how they are turned.
    pub(super) eyes: HashMap<PhysicalIndex, (EyeForm, Rotation)>,
}

impl AdaptedFrame {
    /// Whether each resource is one subresource, which has the number of the resource. Mostly so: then a walk through the
    /// subresources needs nothing of the resources.
    pub(super) fn is_uncut(&self) -> bool {
        self.subresources as usize == self.resources.len()
    }

    /// The uses of operation number `op`.
    pub(super) fn uses(&self, op: u32) -> &[Use] {
        let Range { start, end } = self.ops[op as usize].uses;
        &self.uses[start as usize..end as usize]
    }

    /// The part of its image that a use is about.
    pub(super) fn range(&self, used: &Use) -> Subresources {
        match self.ranges.get(used.range as usize) {
            Some(range) => *range,
            None => self.resources[used.resource as usize].all(),
        }
    }

    /// The subresources that a use is about.
    #[inline]
    pub(super) fn for_each_subresource(&self, used: &Use, mut visit: impl FnMut(SubresourceIndex)) {
        if used.subresource != Use::SEVERAL {
            return visit(used.subresource);
        }
        self.resources[used.resource as usize].for_each_in(self.range(used), visit);
    }
}

/// One operation.
#[derive(Debug)]
pub(super) struct Op {
    pub(super) kind: OpKind,
    /// Into [`AdaptedFrame::uses`].
    pub(super) uses: Range<u32>,
    /// Whether it has an effect that no image or buffer shows.
    pub(super) side_effect: bool,
}

/// The kind of an operation.
#[derive(Debug)]
pub(super) enum OpKind {
    /// A raster pass of the frame.
    Draw(u32),
    /// A pass of the frame that is not drawn.
    Pass(u32),
    /// A full-screen copy that stands in for a pass of the frame that is off.
    ForwardDraw {
        /// The pass of the frame.
        pass: u32,
        /// Filter between texels of the source.
        filter: Filter,
        /// Why.
        why: Box<InsertionCause>,
    },
    /// A draw of the frame again, of nothing but its depth and with one sample; its only use is that depth.
    DepthOnly {
        /// The pass of the frame.
        pass: u32,
        /// Its own name, and why.
        draw: Box<InsertedDraw>,
    },
    /// A fill of the frame again, of other depth with one sample; its only use is that depth.
    FillAgain {
        /// The pass of the frame.
        pass: u32,
        /// Why.
        why: Box<InsertionCause>,
    },
    /// An inserted full-screen draw that resolves depth or colour; its uses are source and target.
    ResolveDraw {
        /// How samples become one value.
        by: ResolveShader,
        /// The view that it draws for.
        view: ViewIndex,
        /// Its name, and why.
        draw: Box<InsertedDraw>,
    },
    /// An inserted resolve; its uses are source and target.
    Resolve {
        /// How samples become one value.
        mode: ResolveMode,
        /// Why.
        why: Box<InsertionCause>,
    },
    /// An inserted copy; its uses are source and target.
    Copy(Box<InsertionCause>),
    /// A copy in place of a pass that is off and forwards an image; its uses are source and target.
    ForwardCopy(Box<InsertionCause>),
}

/// An inserted draw that has a name of its own.
#[derive(Debug)]
pub(super) struct InsertedDraw {
    pub(super) name: Arc<str>,
    pub(super) why: InsertionCause,
}

/// The values that a full-screen draw resolves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ResolveShader {
    /// Depth, in this mode.
    Depth(ResolveMode),
    /// Colour: bright samples weigh less.
    Weighted,
    /// Sample zero of unsigned integers.
    Uint,
    /// Sample zero of signed integers.
    Sint,
}

impl OpKind {
    /// The pass of the frame that it is, stands in for or draws again.
    pub(super) fn pass(&self) -> Option<u32> {
        match self {
            OpKind::Draw(pass)
            | OpKind::Pass(pass)
            | OpKind::ForwardDraw { pass, .. }
            | OpKind::DepthOnly { pass, .. }
            | OpKind::FillAgain { pass, .. } => Some(*pass),
            OpKind::ResolveDraw { .. } | OpKind::Resolve { .. } | OpKind::Copy(_) | OpKind::ForwardCopy(_) => None,
        }
    }

    /// Whether it draws into attachments.
    pub(super) fn draws(&self) -> bool {
        match self {
            OpKind::Draw(_) | OpKind::ForwardDraw { .. } | OpKind::DepthOnly { .. } | OpKind::ResolveDraw { .. } => {
                true
            }
            OpKind::Pass(_)
            | OpKind::FillAgain { .. }
            | OpKind::Resolve { .. }
            | OpKind::Copy(_)
            | OpKind::ForwardCopy(_) => false,
        }
    }

    /// Why it was inserted, if it was.
    pub(super) fn inserted(&self) -> Option<&InsertionCause> {
        match self {
            OpKind::Draw(_) | OpKind::Pass(_) => None,
            OpKind::DepthOnly { draw, .. } | OpKind::ResolveDraw { draw, .. } => Some(&draw.why),
            OpKind::ForwardDraw { why, .. }
            | OpKind::FillAgain { why, .. }
            | OpKind::Resolve { why, .. }
            | OpKind::Copy(why)
            | OpKind::ForwardCopy(why) => Some(why),
        }
    }
}

/// One use of a physical image or buffer by an operation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Use {
    pub(super) resource: PhysicalIndex,
    /// Into [`AdaptedFrame::ranges`]; [`Use::ALL`]: all of it.
    pub(super) range: u32,
    /// The one subresource that it is about; [`Use::SEVERAL`] if there may be several.
    pub(super) subresource: SubresourceIndex,
    /// Which entry of the pass's list of such uses it is.
    pub(super) entry: u32,
    pub(super) role: Role,
    /// The initial contents, if it is an attachment.
    pub(super) contents: InitialContents,
    /// Whether it needs what earlier operations left.
    pub(super) reads: bool,
    /// Whether it changes it.
    pub(super) writes: bool,
    pub(super) layout: Layout,
    pub(super) stages: Stages,
    pub(super) accesses: Accesses,
}

impl Use {
    /// All of a resource.
    pub(super) const ALL: u32 = u32::MAX;
    /// Several subresources.
    pub(super) const SEVERAL: SubresourceIndex = u32::MAX;

    /// The usage that it takes of an image.
    pub(super) fn usage(&self) -> Usage {
        match self.role {
            Role::Sampled => AccessKind::Sampled.usage(),
            Role::Input => AccessKind::InputAttachment.usage(),
            Role::Storage => AccessKind::Storage.usage(),
            Role::Color => AccessKind::ColorAttachment.usage(),
            Role::Depth | Role::Stencil => AccessKind::DepthAttachment.usage(),
            Role::Source => AccessKind::TransferSource.usage(),
            Role::Target if self.accesses.reads_by_transfer() => {
                AccessKind::TransferSource.usage() | AccessKind::TransferTarget.usage()
            }
            Role::Target => AccessKind::TransferTarget.usage(),
            Role::Declared => self.accesses.image_usage() | self.layout.usage(),
            Role::Buffer => Usage::empty(),
        }
    }
}

/// The role in which an operation uses an image or buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Sampled by shaders.
    Sampled,
    /// Attachment of the same scope, read by fragment shaders at their own position.
    Input,
    /// Accessed by shaders without sampling.
    Storage,
    /// Colour attachment.
    Color,
    /// Depth attachment.
    Depth,
    /// Stencil attachment.
    Stencil,
    /// A buffer, in the way that its pass says.
    Buffer,
    /// An image or buffer as the program's commands use it, in the way that their pass declares. Its entry is its place among all
    /// accesses of the pass.
    Declared,
    /// Source of a transfer.
    Source,
    /// Target of a transfer.
    Target,
}

impl Role {
    /// Which attachment of a rendering scope it is, if it is one.
    pub(super) fn attachment(self) -> Option<AttachmentKind> {
        match self {
            Role::Color => Some(AttachmentKind::Color),
            Role::Depth => Some(AttachmentKind::Depth),
            Role::Stencil => Some(AttachmentKind::Stencil),
            Role::Sampled
            | Role::Input
            | Role::Storage
            | Role::Buffer
            | Role::Declared
            | Role::Source
            | Role::Target => None,
        }
    }

    /// Whether it is a side of a transfer.
    pub(super) fn is_transfer(self) -> bool {
        matches!(self, Role::Source | Role::Target)
    }

    /// Whether it is a colour attachment.
    pub(super) fn is_color(self) -> bool {
        matches!(self, Role::Color)
    }

    /// Whether it is sampled.
    pub(super) fn is_sampled(self) -> bool {
        matches!(self, Role::Sampled)
    }

    /// Whether it is read as an attachment of its scope.
    pub(super) fn is_input(self) -> bool {
        matches!(self, Role::Input)
    }

    /// Whether shaders may access it without sampling.
    pub(super) fn is_stored(self) -> bool {
        matches!(self, Role::Storage | Role::Buffer | Role::Declared)
    }

    /// Whether it is a buffer.
    pub(super) fn is_buffer(self) -> bool {
        matches!(self, Role::Buffer)
    }

    /// Whether its pass declares the use.
    pub(super) fn is_declared(self) -> bool {
        matches!(self, Role::Declared)
    }

    /// Whether it is the target of a transfer.
    pub(super) fn is_target(self) -> bool {
        matches!(self, Role::Target)
    }

    /// Whether it is an attachment of a rendering scope.
    pub(super) fn is_attachment(self) -> bool {
        self.attachment().is_some()
    }
}

/// Initial contents of an attachment, as its pass finds them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum InitialContents {
    /// A clear value.
    Clear,
    /// The earlier contents.
    Keep,
    /// Nothing: it covers every pixel.
    Discard,
}

/// Findings about each image of the frame, before anything is decided.
#[derive(Debug)]
pub(super) struct Negotiated {
    /// Samples in force.
    pub(super) samples: Vec<u32>,
    /// Whether any image has several samples.
    pub(super) multisampled: bool,
    /// Whether any image is an attachment.
    pub(super) attached: bool,
    pub(super) notes: Vec<Note>,
}

impl Negotiated {
    /// The sample count of one image.
    pub(super) fn samples(&self, image: ImageIndex) -> u32 {
        self.samples[image.0 as usize]
    }
}
