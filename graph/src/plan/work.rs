//! What the steps of a Plan do: rendering scopes, passes, dispatches, resolves, copies.

use super::{Cause, ImageId, Subresources};
use crate::frame::{Blend, Draw, ParamValue};
use crate::vocabulary::{Accesses, CompareOp, Filter, Layout, LoadOp, ResolveMode, Stages, StoreOp};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What a step does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Work {
    /// A rendering scope (`vkCmdBeginRendering` … `vkCmdEndRendering`).
    Render(RenderScope),
    /// A compute pass.
    Dispatch(Pass),
    /// A resolve that no scope could carry (`vkCmdResolveImage2`).
    Resolve(Transfer),
    /// A copy (`vkCmdCopyImage2`).
    Copy(Transfer),
    /// Nothing: barriers alone leave the outputs in their promised state.
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
    /// Colour attachments by location.
    pub color: Vec<Attachment>,
    /// Depth attachment.
    pub depth: Option<Attachment>,
    /// Passes in order.
    pub passes: Vec<Pass>,
}

/// An attachment of a rendering scope.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// Which image.
    pub image: ImageId,
    /// Which part of it; one mip level.
    pub range: Subresources,
    /// Layout during the scope.
    pub layout: Layout,
    /// What happens to the contents at the beginning.
    pub load: LoadOp,
    /// What happens to the contents at the end.
    pub store: StoreOp,
    /// Clear value where `load` is `CLEAR`: red, green, blue, alpha, or depth in the first.
    pub clear: Option<[f32; 4]>,
    /// Resolve at the end of the scope.
    pub resolve: Option<AttachmentResolve>,
    /// Why these operations.
    pub because: String,
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
    /// What is drawn; `None` for a dispatch.
    pub draw: Option<Draw>,
    /// The shader's name.
    pub shader: Arc<str>,
    /// How new colour meets old, for each colour attachment of the scope.
    pub blend: Vec<Blend>,
    /// Depth comparison and whether passing fragments write depth; `None`: no test, no write.
    pub depth: Option<DepthState>,
    /// Images bound to the shader's names.
    pub bindings: Vec<Binding>,
    /// Values for the shader's parameter block.
    pub params: Vec<Param>,
    /// Every access that it makes, attachments included; load, store and resolve operations are the scope's.
    pub accesses: Vec<Access>,
    /// Why it shares its scope with the pass before it.
    pub merged: Option<String>,
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

/// An image bound to a shader's name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Binding {
    /// The shader's name.
    pub name: Arc<str>,
    /// Which image.
    pub image: ImageId,
    /// Which part of it.
    pub range: Subresources,
    /// Layout.
    pub layout: Layout,
    /// Filter for sampled images; `None`: a storage image.
    pub filter: Option<Filter>,
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Access {
    /// Which image.
    pub image: ImageId,
    /// Which part of it.
    pub range: Subresources,
    /// Stages.
    pub stages: Stages,
    /// Accesses.
    pub accesses: Accesses,
    /// The layout that it needs.
    pub layout: Layout,
}

/// A copy or resolve from image to image.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Transfer {
    /// Source, `TRANSFER_SRC_OPTIMAL`.
    pub source: ImageId,
    /// Part that is read; one mip level.
    pub source_range: Subresources,
    /// Target, `TRANSFER_DST_OPTIMAL`.
    pub target: ImageId,
    /// Part that is written; one mip level.
    pub target_range: Subresources,
    /// Width, height, depth in texels, from the origin of both.
    pub extent: [u32; 3],
    /// Why it is there.
    pub cause: Cause,
}
