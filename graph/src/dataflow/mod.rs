//! The dataflow of a Plan: its work as nodes, and an edge where one node needs the contents that another one left.
//!
//! A pass, a transfer and a resolve are a node each, a resolve that a rendering scope carries too. Nodes stand in the order of
//! execution, so that no edge goes back. Contents that come from before the frame, or are needed after it, have an edge with an
//! open end.

mod contents;
mod uses;

use crate::base::Place;
use crate::plan::{Plan, Resource, StepId, Work};
use crate::vulkan::Subresources;
use serde::Serialize;

/// The dataflow of a Plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Dataflow {
    /// Work in the order of execution.
    pub nodes: Vec<Node>,
    /// Contents that go from node to node, in the order of the nodes that need them; those after the frame last.
    pub edges: Vec<Edge>,
}

/// A piece of work.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Node {
    /// Its step.
    pub step: StepId,
    /// Its kind.
    pub kind: NodeKind,
    /// Its name as the file has it, or words for work without one. Not escaped.
    pub name: String,
    /// Why it is there, if the compiler inserted it. Not escaped.
    pub because: Option<String>,
    /// The line that says so or caused it.
    pub at: Option<Place>,
    /// Images and buffers that it uses, in the Plan's order.
    pub uses: Vec<Use>,
}

/// The kind of a piece of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum NodeKind {
    /// A pass of a rendering scope.
    Draw,
    /// A compute pass.
    Dispatch,
    /// A pass that the embedding program records outside of a rendering scope.
    Custom,
    /// A resolve that a rendering scope carries.
    FoldedResolve,
    /// A resolve of its own.
    Resolve,
    /// A copy.
    Copy,
    /// A scaled copy.
    Blit,
    /// A clear by transfer.
    Fill,
}

impl NodeKind {
    /// The kind of a step's work; `None`: it is none.
    #[must_use]
    pub const fn of(work: &Work) -> Option<NodeKind> {
        match work {
            Work::Render(_) => Some(NodeKind::Draw),
            Work::Dispatch(_) => Some(NodeKind::Dispatch),
            Work::Custom(_) => Some(NodeKind::Custom),
            Work::Resolve(_) => Some(NodeKind::Resolve),
            Work::Copy(_) => Some(NodeKind::Copy),
            Work::Blit(_) => Some(NodeKind::Blit),
            Work::Fill(_) => Some(NodeKind::Fill),
            Work::Export => None,
        }
    }

    /// Whether it makes one value of samples.
    #[must_use]
    pub const fn resolves(self) -> bool {
        match self {
            NodeKind::FoldedResolve | NodeKind::Resolve => true,
            NodeKind::Draw
            | NodeKind::Dispatch
            | NodeKind::Custom
            | NodeKind::Copy
            | NodeKind::Blit
            | NodeKind::Fill => false,
        }
    }
}

/// A use of an image or buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Use {
    /// The image or buffer.
    pub resource: Resource,
    /// The part of the image; `None` for a buffer.
    pub range: Option<Subresources>,
    /// How it is used.
    pub role: UseRole,
    /// Whether contents are read. An attachment that is drawn over what is there counts as read.
    pub reads: bool,
    /// Whether contents are written.
    pub writes: bool,
}

/// How an image or buffer is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum UseRole {
    /// A colour attachment.
    Color,
    /// A depth or stencil attachment.
    Depth,
    /// A sampled image.
    Sampled,
    /// A storage image.
    StorageImage,
    /// An attachment read at its own position.
    InputAttachment,
    /// A buffer that shaders or draws read or write.
    Buffer,
    /// The source of a resolve, copy or blit.
    Source,
    /// The target of a resolve, copy, blit or fill.
    Target,
    /// Another use, which the embedding program makes.
    Other,
}

/// Contents of an image or buffer that one node left and another needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
pub struct Edge {
    /// Index of the node that left them; `None`: they come from before the frame.
    pub from: Option<u32>,
    /// Index of the node that needs them; `None`: they are needed after the frame.
    pub to: Option<u32>,
    /// The image or buffer.
    pub resource: Resource,
}

impl Dataflow {
    /// The dataflow of a Plan, which must be one that [`verify`](crate::verify::verify) finds nothing in.
    ///
    /// Takes time and memory in proportion to the Plan.
    #[must_use]
    pub fn of(plan: &Plan) -> Dataflow {
        let nodes = uses::nodes(plan);
        let edges = contents::edges(plan, &nodes);
        Dataflow { nodes, edges }
    }
}
