//! A Plan's graph as an SVG picture.

use super::labels::{Graph, Vertex};
use super::layout::{HEIGHT, LETTERS, layout};
use crate::xml::escaped;
use framewright_graph::dataflow::{Dataflow, NodeKind};
use framewright_graph::plan::Plan;
use std::fmt::Write;

/// Empty space around the graph.
const MARGIN: f64 = 16.0;
/// Edges have their labels on them while there are at most this many; beyond that only when the pointer is on them.
const MOST_LABELS: usize = 80;

const STYLE: &str = "svg{background:#fff;color:#1c1c1c;font:12px system-ui,sans-serif}text{fill:currentColor;text-anchor:middle}\
.kind{font-size:10px;opacity:.75}.along{font-size:10px;fill:#5c5c5c;paint-order:stroke;stroke:#fff;stroke-width:4px;stroke-linejoin:round}rect{fill:#eef3fa;stroke:#5c7ea8}.dispatch rect{fill:#e3f4e3;stroke:#4d8a4d}\
.resolve rect{fill:#fde8d0;stroke:#b5651d}.beside rect{fill:#f4f4f4;stroke:#888}path{fill:none;stroke:currentColor;opacity:.45}\
@media (prefers-color-scheme:dark){svg{background:#181818;color:#eee}rect{fill:#223147}.dispatch rect{fill:#1f3a1f}\
.resolve rect{fill:#4a3218}.beside rect{fill:#333}.along{fill:#aaa;stroke:#181818}}";

/// The picture.
pub fn svg(plan: &Plan, flow: &Dataflow) -> String {
    let graph = Graph::of(plan, flow);
    let layout = layout(&graph);
    let [width, height] = layout.extent.map(|extent| (extent + 2.0 * MARGIN).ceil());
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{0} {0} {width} {height}\" width=\"{width}\" height=\"{height}\">\n\
         <style>{STYLE}</style>\n<defs><marker id=\"end\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" \
         markerHeight=\"7\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" style=\"fill:currentColor;stroke:none;opacity:1\"/></marker></defs>\n",
        -MARGIN
    );
    let labelled = graph.edges.len() <= MOST_LABELS;
    // Above all edges: none crosses them out.
    let mut labels = String::new();
    for (points, resources) in layout.ways.iter().zip(graph.edges.values()) {
        let along = escaped(&graph.along(resources));
        let _ = write!(svg, "<g><title>{along}</title><path marker-end=\"url(#end)\" d=\"{}\"/>", curve(points));
        if let (true, [first, second, ..]) = (labelled, points.as_slice()) {
            let middle = [0, 1].map(|axis| (first[axis] + second[axis]) / 2.0);
            let [x, y] = [middle[0], middle[1] + 3.0];
            let _ = writeln!(labels, "<text class=\"along\" x=\"{x:.1}\" y=\"{y:.1}\">{along}</text>");
        }
        svg += "</g>\n";
    }
    svg += &labels;
    for (vertex, [x, y, width]) in graph.vertices.iter().zip(&layout.places) {
        let node = graph.node(*vertex);
        let class = match (vertex, node.map(|node| node.kind)) {
            (Vertex::Before(_) | Vertex::After(_), _) => "beside",
            (_, Some(kind)) if kind.resolves() => "resolve",
            (_, Some(NodeKind::Dispatch)) => "dispatch",
            _ => "draw",
        };
        let name = graph.name(*vertex);
        let about = node.map_or_else(
            || name.clone(),
            |node| {
                let because = node.because.as_ref().map_or_else(String::new, |because| format!("\n{because}"));
                let at = node.at.as_ref().map_or_else(String::new, |at| format!("\n{at}"));
                format!("{name}, step {}{because}{at}", node.step.0)
            },
        );
        let short: String = match name.char_indices().nth(LETTERS) {
            Some((end, _)) => format!("{}…", &name[..end]),
            None => name,
        };
        let _ = writeln!(
            svg,
            "<g class=\"{class}\"><title>{}</title><rect x=\"{:.1}\" y=\"{:.1}\" width=\"{width:.1}\" height=\"{HEIGHT}\" rx=\"6\"/>\
             <text x=\"{x:.1}\" y=\"{:.1}\">{}</text><text class=\"kind\" x=\"{x:.1}\" y=\"{:.1}\">{}</text></g>",
            escaped(&about),
            x - width / 2.0,
            y - HEIGHT / 2.0,
            y - 2.0,
            escaped(&short),
            y + 13.0,
            graph.kind(*vertex)
        );
    }
    svg + "</svg>\n"
}

/// A smooth way through the points.
fn curve(points: &[[f64; 2]]) -> String {
    let mut way = String::new();
    for (at, [x, y]) in points.iter().enumerate() {
        let _ = match at.checked_sub(1).map(|before| points[before]) {
            None => write!(way, "M{x:.1} {y:.1}"),
            Some([before_x, before_y]) => {
                let middle = (before_y + y) / 2.0;
                write!(way, "C{before_x:.1} {middle:.1} {x:.1} {middle:.1} {x:.1} {y:.1}")
            }
        };
    }
    way
}
