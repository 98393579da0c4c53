//! A Plan's graph in Mermaid's language, which code hosts draw in Markdown.

use super::labels::{Graph, Vertex};
use framewright_graph::dataflow::{Dataflow, NodeKind};
use framewright_graph::plan::Plan;
use std::fmt::Write;

/// The graph.
pub(crate) fn mermaid(plan: &Plan, flow: &Dataflow) -> String {
    let graph = Graph::of(plan, flow);
    let mut shown = String::from("flowchart TB\n");
    for (index, vertex) in graph.vertices.iter().enumerate() {
        let label = quoted(&format!("{}\n{}", graph.name(*vertex), graph.kind(*vertex)));
        let _ = match vertex {
            Vertex::Before(_) | Vertex::After(_) => writeln!(shown, "  n{index}([{label}])"),
            Vertex::Node(_) => writeln!(shown, "  n{index}[{label}]"),
        };
    }
    for ((from, to), resources) in &graph.edges {
        let _ = writeln!(shown, "  n{from} -->|{}| n{to}", quoted(&graph.along(resources)));
    }
    shown += "  classDef resolve fill:#fde8d0,stroke:#b5651d,color:#1c1c1c\n";
    let is_resolve = |vertex: &Vertex| {
        let kind = graph.node(*vertex).map(|node| node.kind);
        matches!(kind, Some(NodeKind::Resolve | NodeKind::FoldedResolve))
    };
    for (index, _) in graph.vertices.iter().enumerate().filter(|(_, vertex)| is_resolve(vertex)) {
        let _ = writeln!(shown, "  class n{index} resolve");
    }
    shown
}

/// A quoted label. Every character that Mermaid, Markdown or HTML could act on is written as a character entity, which Mermaid
/// begins with `#`.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '\n' => quoted += "<br>",
            ' ' | ',' | '.' | '(' | ')' => quoted.push(character),
            _ if character.is_alphanumeric() => quoted.push(character),
            _ => {
                let _ = write!(quoted, "#{};", u32::from(character));
            }
        }
    }
    quoted + "\""
}
