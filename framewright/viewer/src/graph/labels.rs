//! The words on a graph's nodes and edges, the same in every form.

use framewright_graph::base::escape;
use framewright_graph::dataflow::{Dataflow, Edge, Node, NodeKind};
use framewright_graph::plan::{Plan, Resource};
use std::collections::{BTreeMap, BTreeSet};

/// A graph's vertex: a node of the dataflow, or an image or buffer beside the frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Vertex {
    /// The image or buffer as it was before the frame.
    Before(Resource),
    /// A node, by its index.
    Node(u32),
    /// The image or buffer as the frame leaves it.
    After(Resource),
}

/// A graph of labelled vertices and edges.
pub(super) struct Graph<'a> {
    plan: &'a Plan,
    flow: &'a Dataflow,
    /// Vertices: those before the frame, nodes in their order, those after it.
    pub(super) vertices: Vec<Vertex>,
    /// Edges between indices of vertices, with the images and buffers whose contents go along it.
    pub(super) edges: BTreeMap<(usize, usize), Vec<Resource>>,
}

impl<'a> Graph<'a> {
    pub(super) fn of(plan: &'a Plan, flow: &'a Dataflow) -> Graph<'a> {
        let ends = |edge: &Edge| {
            let from = edge.from.map_or(Vertex::Before(edge.resource), Vertex::Node);
            [from, edge.to.map_or(Vertex::After(edge.resource), Vertex::Node)]
        };
        let nodes = (0_u32..).take(flow.nodes.len()).map(Vertex::Node);
        let vertices: BTreeSet<Vertex> = flow.edges.iter().flat_map(ends).chain(nodes).collect();
        let vertices: Vec<Vertex> = vertices.into_iter().collect();
        let index = |vertex: &Vertex| vertices.binary_search(vertex).unwrap_or_default();
        let mut edges: BTreeMap<_, Vec<_>> = BTreeMap::new();
        for edge in &flow.edges {
            let [from, to] = ends(edge);
            edges.entry((index(&from), index(&to))).or_default().push(edge.resource);
        }
        Graph { plan, flow, vertices, edges }
    }

    pub(super) fn node(&self, vertex: Vertex) -> Option<&'a Node> {
        match vertex {
            Vertex::Node(node) => self.flow.nodes.get(node as usize),
            Vertex::Before(_) | Vertex::After(_) => None,
        }
    }

    /// The name of a vertex. Escaped for a terminal.
    pub(super) fn name(&self, vertex: Vertex) -> String {
        match vertex {
            Vertex::Before(resource) | Vertex::After(resource) => self.resource(resource),
            Vertex::Node(node) => escape(&self.flow.nodes[node as usize].name),
        }
    }

    /// The word under the name: the kind of work, or when the contents are there.
    pub(super) fn kind(&self, vertex: Vertex) -> &'static str {
        match vertex {
            Vertex::Before(_) => "from before the frame",
            Vertex::After(_) => "after the frame",
            Vertex::Node(node) => word(self.flow.nodes[node as usize].kind),
        }
    }

    /// The names of what goes along an edge.
    pub(super) fn along(&self, resources: &[Resource]) -> String {
        resources.iter().map(|resource| self.resource(*resource)).collect::<Vec<_>>().join(", ")
    }

    fn resource(&self, resource: Resource) -> String {
        escape(self.plan.resource_name(resource))
    }
}

/// A kind of work in words.
fn word(kind: NodeKind) -> &'static str {
    match kind {
        NodeKind::Draw => "draw",
        NodeKind::Dispatch => "dispatch",
        NodeKind::Custom => "custom",
        NodeKind::FoldedResolve => "resolve, folded",
        NodeKind::Resolve => "resolve",
        NodeKind::Copy => "copy",
        NodeKind::Blit => "blit",
        NodeKind::Fill => "fill",
    }
}
