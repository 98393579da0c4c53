//! Steps, rendering scopes and their attachments.

use crate::compile::model::{AdaptedFrame, OpKind, PhysicalIndex, Role, Use};
use crate::frame::Frame;
use crate::vulkan::Subresources;
use std::sync::Arc;

/// One step.
#[derive(Debug, PartialEq)]
pub(crate) enum Step {
    /// A rendering scope.
    Scope(Box<Scope>),
    /// One operation that is not drawn.
    Single(u32),
    /// The promised state of what outlives the frame.
    BarriersOnly,
}

/// An attachment: which part of which image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Target {
    pub(crate) resource: PhysicalIndex,
    pub(crate) range: Subresources,
}

impl Target {
    pub(crate) fn of(adapted: &AdaptedFrame, used: &Use) -> Target {
        Target { resource: used.resource, range: adapted.range(used) }
    }
}

/// A rendering scope.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Scope {
    /// Colour attachments by location.
    pub(crate) color: Vec<Target>,
    pub(crate) depth: Option<Target>,
    pub(crate) stencil: Option<Target>,
    /// Operations that draw.
    pub(crate) ops: Vec<u32>,
    /// For each colour attachment its folded resolve operation.
    pub(crate) resolves: Vec<Option<u32>>,
    /// The folded resolve operation of the depth attachment.
    pub(crate) depth_resolve: Option<u32>,
    /// Whether passes read at their own position what others drew: then each draws into some of the colour attachments.
    pub(crate) local: bool,
    /// Whether the program records some of its draws, and may bind pipelines of its own: these know one list of colours.
    pub(crate) custom: bool,
}

impl Step {
    /// The operations that it runs, without folded resolves.
    pub(crate) fn ops(&self) -> &[u32] {
        match self {
            Step::Scope(scope) => &scope.ops,
            Step::Single(op) => std::slice::from_ref(op),
            Step::BarriersOnly => &[],
        }
    }
}

/// The name of a physical image or buffer.
pub(crate) fn resource_name<'n>(frame: &'n Frame, adapted: &'n AdaptedFrame, resource: PhysicalIndex) -> &'n Arc<str> {
    let resource = &adapted.resources[resource as usize];
    resource.renamed.as_ref().unwrap_or_else(|| frame.name(resource.of))
}

/// The colour attachments of an operation with these uses.
pub(super) fn colors_of(adapted: &AdaptedFrame, uses: &[Use]) -> Vec<Target> {
    uses.iter().filter(|used| used.role.is_color()).map(|used| Target::of(adapted, used)).collect()
}

/// Its depth or its stencil attachment.
pub(super) fn plane_of(adapted: &AdaptedFrame, uses: &[Use], role: Role) -> Option<Target> {
    uses.iter().find(|used| used.role == role).map(|used| Target::of(adapted, used))
}

/// The name of the pass that an operation is in the Plan.
pub(crate) fn op_name<'f>(frame: &'f Frame, adapted: &'f AdaptedFrame, op: u32) -> Option<&'f Arc<str>> {
    match &adapted.ops[op as usize].kind {
        OpKind::DepthOnly { draw, .. } | OpKind::ResolveDraw { draw, .. } => Some(&draw.name),
        kind => kind.pass().map(|pass| &frame.passes[pass as usize].name),
    }
}
