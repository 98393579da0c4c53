//! A Plan's graph in Graphviz's language.

use super::labels::{Graph, Vertex};
use framewright_graph::dataflow::{Dataflow, NodeKind};
use framewright_graph::plan::Plan;
use std::fmt::Write;

/// The graph. Passes of one rendering scope stand in one box.
pub fn dot(plan: &Plan, flow: &Dataflow) -> String {
    let graph = Graph::of(plan, flow);
    let mut dot = String::from(
        "digraph plan {\n  rankdir=TB\n  node [shape=box style=\"rounded,filled\" fillcolor=\"#eef3fa\" fontname=\"sans-serif\"]\n  \
         edge [fontname=\"sans-serif\" fontsize=10]\n",
    );
    let mut scope = None;
    for (index, vertex) in graph.vertices.iter().enumerate() {
        let step =
            graph.node(*vertex).map(|node| node.step).filter(|step| plan.steps[step.0 as usize].work.scope().is_some());
        if scope != step {
            if scope.is_some() {
                dot += "  }\n";
            }
            if let Some(step) = step {
                let _ =
                    writeln!(dot, "  subgraph cluster_step_{0} {{\n    label=\"step {0}\" color=\"#8899aa\"", step.0);
            }
            scope = step;
        }
        let style = match (vertex, graph.node(*vertex).map(|node| node.kind)) {
            (Vertex::Before(_) | Vertex::After(_), _) => " shape=ellipse fillcolor=\"#f4f4f4\"",
            (_, Some(kind)) if kind.resolves() => " fillcolor=\"#fde8d0\"",
            (_, Some(NodeKind::Dispatch)) => " fillcolor=\"#e3f4e3\"",
            _ => "",
        };
        let name = quoted(&format!("{}\n{}", graph.name(*vertex), graph.kind(*vertex)));
        let _ = writeln!(dot, "    n{index} [label={name}{style}]");
    }
    if scope.is_some() {
        dot += "  }\n";
    }
    for ((from, to), resources) in &graph.edges {
        let _ = writeln!(dot, "  n{from} -> n{to} [label={}]", quoted(&graph.along(resources)));
    }
    dot + "}\n"
}

/// A quoted string: a backslash would begin one of DOT's own escapes, and `&` one of HTML's, which Graphviz reads too.
fn quoted(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n");
    format!("\"{text}\"")
}
