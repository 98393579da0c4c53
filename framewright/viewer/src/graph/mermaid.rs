//! A Plan's graph in Mermaid's language, which code hosts draw in Markdown.

use super::labels::{Graph, Vertex};
use framewright_graph::dataflow::Dataflow;
use framewright_graph::plan::Plan;
use std::fmt::Write;

/// The most edges that Mermaid draws (its `maxEdges`). Code hosts leave it at that.
const MOST_EDGES: usize = 500;
/// The most characters of a graph that Mermaid reads, in UTF-16 (its `maxTextSize`). Code hosts leave it at that.
const MOST_CHARACTERS: usize = 50_000;

/// A character without width, at which no line is broken.
const WORD_JOINER: char = '\u{2060}';

/// The graph, and a sentence for each limit of Mermaid that it is beyond.
pub fn mermaid(plan: &Plan, flow: &Dataflow) -> (String, Vec<String>) {
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
    let is_resolve = |vertex: &Vertex| graph.node(*vertex).is_some_and(|node| node.kind.resolves());
    for (index, _) in graph.vertices.iter().enumerate().filter(|(_, vertex)| is_resolve(vertex)) {
        let _ = writeln!(shown, "  class n{index} resolve");
    }
    let limits = [
        (graph.edges.len(), "edges", MOST_EDGES, "maxEdges"),
        (shown.encode_utf16().count(), "characters", MOST_CHARACTERS, "maxTextSize"),
    ];
    let beyond = limits.into_iter().filter(|(amount, _, most, _)| amount > most).map(|(amount, of, most, setting)| {
        format!(
            "the graph has {amount} {of}, and Mermaid draws at most {most} unless its setting {setting} is raised, which code \
             hosts don't do: SVG and DOT hold more"
        )
    });
    let beyond = beyond.collect();
    (shown, beyond)
}

/// A quoted label. Every character that Mermaid, Markdown or HTML could act on is written as a character entity, which Mermaid
/// begins with `#`. What Mermaid looks for after it has read the entities (`\n`, `fa:fa-`, `$$`, and its own mark for entities) is broken up
/// by an invisible word joiner.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '\n' => quoted += "<br>",
            '\\' | ':' | '$' | '\u{fb02}' | '\u{b6}' => {
                let _ = write!(quoted, "#{};#{};", u32::from(character), u32::from(WORD_JOINER));
            }
            ' ' | ',' | '.' | '(' | ')' => quoted.push(character),
            _ if character.is_alphanumeric() => quoted.push(character),
            _ => {
                let _ = write!(quoted, "#{};", u32::from(character));
            }
        }
    }
    quoted + "\""
}
