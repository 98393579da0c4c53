//! The work of a Plan's steps: rendering scopes, passes, dispatches, resolves, copies, fills.

use super::{BufferId, Cause, ImageId, Reason, Resource, ViewId};
use crate::frame::{Blend, BufferRole, Draw, Eye, Groups, ParamValue, RasterState, StencilState};
use crate::vulkan::{
    Accesses, Aspects, ColorComponents, CompareOp, FillValue, Filter, ImageShape, Layout, LoadOp, ResolveMode, Sampler,
    Stages, StoreOp, Subresources,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The work of a step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Work {
    /// A rendering scope (`vkCmdBeginRendering` … `vkCmdEndRendering`).
    Render(Box<RenderScope>),
    /// A compute pass.
    Dispatch(Pass),
    /// A pass that the embedding program records; `shader` is the name by which it knows it.
    Custom(Pass),
    /// A resolve that no scope could carry (`vkCmdResolveImage2`).
    Resolve(Transfer),
    /// A copy (`vkCmdCopyImage2`, `vkCmdCopyBuffer2`, `vkCmdCopyBufferToImage2`, `vkCmdCopyImageToBuffer2`).
    Copy(Transfer),
    /// A scaled copy (`vkCmdBlitImage2`).
    Blit(Transfer),
    /// A clear by transfer (`vkCmdClearColorImage`, `vkCmdClearDepthStencilImage`, `vkCmdFillBuffer`).
    Fill(Fill),
    /// Nothing: barriers alone leave images in their promised state, or change layouts before several queues read.
    Export,
}

/// One rendering scope: attachments, and the passes that draw into them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RenderScope {
    /// Width and height of the render area, from the origin.
    pub extent: [u32; 2],
    /// Array layers drawn to.
    pub layers: u32,
    /// Samples of its attachments.
    pub samples: u32,
    /// Attachments: of colour by location, then depth, then stencil, which is another plane of the depth attachment's image if
    /// there are both.
    pub attachments: Vec<Attachment>,
    /// Passes in order.
    pub passes: Vec<Pass>,
}

/// What an attachment is to its scope. A scope lists its attachments in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AttachmentKind {
    /// A colour attachment; its location is the number of those before it.
    Color,
    /// The depth attachment.
    Depth,
    /// The stencil attachment.
    Stencil,
}

impl AttachmentKind {
    /// The plane of an image that it is.
    #[must_use]
    pub const fn plane(self) -> Aspects {
        match self {
            AttachmentKind::Color => Aspects::COLOR,
            AttachmentKind::Depth => Aspects::DEPTH,
            AttachmentKind::Stencil => Aspects::STENCIL,
        }
    }

    /// Whether a scope may have several of its kind.
    #[must_use]
    pub const fn may_repeat(self) -> bool {
        match self {
            AttachmentKind::Color => true,
            AttachmentKind::Depth | AttachmentKind::Stencil => false,
        }
    }
}

/// An attachment of a rendering scope.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// What it is to the scope.
    pub kind: AttachmentKind,
    /// Which image.
    pub image: ImageId,
    /// Which part of it: one mip level, one plane.
    pub range: Subresources,
    /// Layout during the scope.
    pub layout: Layout,
    /// Load op: the contents when the scope begins.
    pub load: LoadOp,
    /// Store op: the contents when the scope ends.
    pub store: StoreOp,
    /// Clear value where `load` is `CLEAR`: red, green, blue, alpha, or depth or stencil in the
    /// first. The format holds them.
    pub clear: Option<[f64; 4]>,
    /// Resolve at the end of the scope.
    pub resolve: Option<AttachmentResolve>,
    /// Why these operations.
    pub because: Reason,
}

/// A resolve that a rendering scope carries.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AttachmentResolve {
    /// Target.
    pub image: ImageId,
    /// Which part of it.
    pub range: Subresources,
    /// Layout of the target during the scope.
    pub layout: Layout,
    /// How samples become one value.
    pub mode: ResolveMode,
    /// Why it is there.
    pub cause: Cause,
}

/// One pass: a draw of a rendering scope, or a dispatch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pass {
    /// Unique name.
    pub name: Arc<str>,
    /// Where the file declares it, or why it was inserted.
    pub cause: Cause,
    /// The view that it draws for; `None` if the Plan has none.
    pub view: Option<ViewId>,
    /// The geometry; `None` for a dispatch.
    pub draw: Option<Draw>,
    /// How many workgroups; `None` if the pass is no dispatch.
    pub groups: Option<Groups>,
    /// The shader's name.
    pub shader: Arc<str>,
    /// The pass whose depth it draws again, and nothing else. Its shader is compiled for that (the macro `DEPTH_ONLY`), or left
    /// out where it would change nothing.
    pub redraws: Option<Arc<str>>,
    /// Whether its fragment shader leaves samples out, as it does where it discards fragments: then a full-screen draw doesn't
    /// cover.
    pub discards: bool,
    /// Why else a full-screen draw doesn't cover, in words, or why its shader leaves samples out.
    pub untouched: Option<Arc<str>>,
    /// Whether the file promises that it sets every texel of its targets, whatever its shader is known to do.
    pub covers: bool,
    /// Whether the alpha that its shader writes at location 0 says how many samples are covered: it is compiled for that (the
    /// macro `ALPHA_TO_COVERAGE`).
    pub alpha_to_coverage: bool,
    /// How new colour meets old, for each colour attachment of the scope.
    pub blend: Vec<Blend>,
    /// The channels that it writes, for each colour attachment of the scope; empty: all of each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub write_masks: Vec<ColorComponents>,
    /// How its primitives become fragments.
    #[serde(default, skip_serializing_if = "RasterState::is_usual")]
    pub raster: RasterState,
    /// Depth comparison and whether passing fragments write depth; `None`: no test, no write.
    pub depth: Option<DepthState>,
    /// Stencil test and update; `None`: no test, no update.
    pub stencil: Option<StencilState>,
    /// Values for the shader's parameter block.
    pub params: Vec<Param>,
    /// Values for the shader's specialization constants.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub constants: Vec<Param>,
    /// Every access to an image that it makes, attachments included, with the shader's name for a bound image; load, store
    /// and resolve operations are the scope's.
    pub accesses: Vec<Access>,
    /// Every access to a buffer that it makes.
    pub buffers: Vec<BufferAccess>,
    /// Whether what earlier passes of the scope drew is made visible to it by a by-region barrier
    /// (`COLOR_ATTACHMENT_OUTPUT`, `COLOR_ATTACHMENT_WRITE` to `FRAGMENT_SHADER`, `INPUT_ATTACHMENT_READ`). Its scopes
    /// include earlier and later stages of the pipeline, so colour that they read at their own position is read by then, and
    /// may be drawn over.
    pub local_barrier: bool,
    /// Whether the program agrees to record it for another queue than that for graphics.
    #[serde(default, skip_serializing_if = "is_not")]
    pub any_queue: bool,
    /// Whether the program records it for both eyes at once: what it touches holds both eyes' parts.
    #[serde(default, skip_serializing_if = "is_not")]
    pub both_eyes: bool,
    /// Why it shares its scope with the pass before it. Boxed, since few passes do.
    pub merged: Option<Box<Reason>>,
}

impl Pass {
    /// The channels that it writes of the colour attachment at this place.
    #[must_use]
    pub fn write_mask(&self, attachment: usize) -> ColorComponents {
        self.write_masks.get(attachment).copied().unwrap_or_default()
    }
}

/// Depth comparison and writing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DepthState {
    /// The comparison.
    pub test: CompareOp,
    /// Whether passing fragments write depth.
    pub write: bool,
}

/// A shader's name for an image.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Binding {
    /// The shader's name; of the element of an array its name and number, `taps[0]`.
    pub name: Arc<str>,
    /// How it is bound.
    pub kind: BindingKind,
    /// The type that the shader is compiled to declare (the macro `TEXTURE_NAME`); `None` where its own declaration stands.
    pub texture: Option<ImageShape>,
}

/// How an image is bound to a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BindingKind {
    /// A combined image sampler.
    Sampled(Sampler),
    /// A storage image.
    Storage,
    /// An input attachment.
    InputAttachment,
}

impl BindingKind {
    /// The sampler, if it is sampled.
    #[must_use]
    pub fn sampler(&self) -> Option<&Sampler> {
        match self {
            BindingKind::Sampled(sampler) => Some(sampler),
            BindingKind::Storage | BindingKind::InputAttachment => None,
        }
    }

    /// Whether it is an input attachment.
    #[must_use]
    pub fn is_input_attachment(&self) -> bool {
        matches!(self, BindingKind::InputAttachment)
    }
}

/// A value for a member of a shader's parameter block.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Param {
    /// The member's name.
    pub name: Arc<str>,
    /// Its value.
    pub value: ParamValue,
}

/// One access to a part of an image.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Access {
    /// Which image.
    pub image: ImageId,
    /// Which part of it.
    pub range: Subresources,
    /// Whose part it is, of an image that holds both eyes'; `None`: that of the eye that is drawn for, or both.
    pub eye: Option<Eye>,
    /// Stages.
    pub stages: Stages,
    /// Accesses.
    pub accesses: Accesses,
    /// The layout that it needs.
    pub layout: Layout,
    /// The shader's name for it; `None` for attachments and for images that a custom pass transfers.
    pub binding: Option<Binding>,
    /// Whether a custom pass declares these stages, accesses and this layout. Else what the program records is any command.
    #[serde(default, skip_serializing_if = "is_not")]
    pub declared: bool,
}

/// One access to a buffer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BufferAccess {
    /// Which buffer.
    pub buffer: BufferId,
    /// The role of the buffer; `None` where a custom pass transfers it.
    pub role: Option<BufferRole>,
    /// Stages.
    pub stages: Stages,
    /// Accesses.
    pub accesses: Accesses,
    /// The shader's name for it, if it has one.
    pub binding: Option<Arc<str>>,
    /// Whether a custom pass declares these stages and accesses. Else what the program records is any command.
    #[serde(default, skip_serializing_if = "is_not")]
    pub declared: bool,
}

/// Whether something isn't so: then the JSON form leaves it out.
fn is_not(so: &bool) -> bool {
    !so
}

/// A copy, blit or resolve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Transfer {
    /// The pass that it is; `None`: the compiler inserted it.
    pub name: Option<Arc<str>>,
    /// Why it is there.
    pub cause: Cause,
    /// The side that is read.
    pub source: Side,
    /// The side that is written.
    pub target: Side,
    /// Filter between texels; of blits only.
    pub filter: Option<Filter>,
}

/// A clear by transfer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fill {
    /// The pass that it is.
    pub name: Option<Arc<str>>,
    /// Why it is there.
    pub cause: Cause,
    /// The side that is written.
    pub target: Side,
    /// The value.
    pub value: FillValue,
}

/// A part of an image or buffer that a copy, blit, resolve or fill reads or writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Side {
    /// A part of an image, from the origin on.
    Image {
        /// Which image.
        image: ImageId,
        /// Which part of it; one mip level, but any number for fills.
        range: Subresources,
        /// Width, height, depth in texels of the first of its mip levels.
        extent: [u32; 3],
        /// Its layout meanwhile.
        layout: Layout,
    },
    /// A buffer, from its first byte on.
    Buffer {
        /// Which buffer.
        buffer: BufferId,
        /// Bytes. Beside an image the texels follow each other without gaps, rows and layers likewise.
        bytes: u64,
    },
}

impl Side {
    /// The part of an image; `None`: it is a buffer.
    #[must_use]
    pub const fn range(&self) -> Option<Subresources> {
        match self {
            Side::Image { range, .. } => Some(*range),
            Side::Buffer { .. } => None,
        }
    }

    /// The image or buffer.
    #[must_use]
    pub const fn resource(&self) -> Resource {
        match self {
            Side::Image { image, .. } => Resource::Image(*image),
            Side::Buffer { buffer, .. } => Resource::Buffer(*buffer),
        }
    }
}
