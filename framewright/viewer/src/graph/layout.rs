//! Places for a graph's vertices, and ways for its edges.
//!
//! Vertices stand in layers from top to bottom, each below everything that it needs. An edge over several layers gets a bend in
//! each layer between, so that it passes beside vertices and not through them.

use super::labels::Graph;
use rust_sugiyama::configure::{Config, CrossingMinimization, RankingType};
use std::collections::BTreeMap;

/// Height of a vertex in pixels.
pub(super) const HEIGHT: f64 = 40.0;
/// Distance between vertices of a layer, and between layers.
const SPACING: f64 = 36.0;
/// Width of a letter, about.
const LETTER: f64 = 7.2;
/// A vertex has room for this many letters.
pub(super) const LETTERS: usize = 32;
/// Letters that a vertex has beside its kind: the number of its step.
const STEP: usize = 9;
/// The most bends, counted for each vertex: edges that are left without any run straight.
const MOST_BENDS: usize = 12;

/// Places in pixels, x to the right and y downwards.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// Middle and width of each vertex.
    pub(super) places: Vec<[f64; 3]>,
    /// The points of each edge, from the foot of its first vertex to the head of its second.
    pub(super) ways: Vec<Vec<[f64; 2]>>,
    /// Width and height of all.
    pub(super) extent: [f64; 2],
}

/// Lays out a graph. The same graph has the same layout.
pub(super) fn layout(graph: &Graph<'_>) -> Layout {
    let widths: Vec<f64> = graph
        .vertices
        .iter()
        .map(|vertex| {
            let letters = [graph.name(*vertex).chars().count(), graph.kind(*vertex).len() + STEP];
            letters.map(|letters| letters.min(LETTERS) as f64).into_iter().fold(0.0, f64::max) * LETTER + 20.0
        })
        .collect();
    let layers = layers(graph);
    let mut vertices: Vec<(u32, (f64, f64))> =
        numbered(&widths).map(|(number, width)| (number, (width, HEIGHT))).collect();
    let mut parts = Vec::new();
    let mut bends: Vec<Vec<u32>> = Vec::with_capacity(graph.edges.len());
    for &(from, to) in graph.edges.keys() {
        let between = layers[to].saturating_sub(layers[from]).saturating_sub(1);
        let mut bent = Vec::new();
        let mut last = from as u32;
        if vertices.len() + between <= (MOST_BENDS + 1) * widths.len() {
            for _ in 0..between {
                let bend = vertices.len() as u32;
                vertices.push((bend, (12.0, HEIGHT)));
                parts.push((last, bend));
                bent.push(bend);
                last = bend;
            }
        }
        parts.push((last, to as u32));
        bends.push(bent);
    }
    let config = Config {
        vertex_spacing: SPACING,
        dummy_vertices: true,
        ranking_type: RankingType::Up,
        c_minimization: CrossingMinimization::Median,
        transpose: vertices.len() < 400,
        ..Config::default()
    };
    let mut places: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
    let mut right = 0.0;
    for (part, _, _) in rust_sugiyama::from_vertices_and_edges(&vertices, &parts, &config) {
        let half = |vertex: usize| vertices[vertex].1.0 / 2.0;
        let left = part.iter().map(|(vertex, (x, _))| x - half(*vertex)).fold(f64::INFINITY, f64::min);
        let end = part.iter().map(|(vertex, (x, _))| x + half(*vertex)).fold(f64::NEG_INFINITY, f64::max);
        let top = part.iter().map(|(_, (_, y))| *y).fold(f64::INFINITY, f64::min);
        places.extend(part.iter().map(|(vertex, (x, y))| (*vertex, [right + x - left, y - top + HEIGHT / 2.0])));
        right += end - left + SPACING;
    }
    let place = |vertex: usize| places.get(&vertex).copied().unwrap_or_default();
    let edges = graph.edges.keys().zip(&bends).map(|(&(from, to), bends)| {
        let [[from_x, from_y], [to_x, to_y]] = [place(from), place(to)];
        let first = [from_x, from_y + HEIGHT / 2.0];
        let last = [to_x, to_y - HEIGHT / 2.0];
        let between = bends.iter().flat_map(|bend| {
            let [x, y] = place(*bend as usize);
            [[x, y - HEIGHT / 2.0], [x, y + HEIGHT / 2.0]]
        });
        std::iter::once(first).chain(between).chain([last]).collect()
    });
    let bottom = places.values().map(|[_, y]| y + HEIGHT / 2.0).fold(0.0, f64::max);
    Layout {
        ways: edges.collect(),
        places: numbered(&widths)
            .map(|(number, width)| {
                let [x, y] = place(number as usize);
                [x, y, width]
            })
            .collect(),
        extent: [(right - SPACING).max(0.0), bottom],
    }
}

fn numbered(widths: &[f64]) -> impl Iterator<Item = (u32, f64)> {
    (0..).zip(widths.iter().copied())
}

/// The layer of each vertex: one more than the deepest that it needs. Edges lead from a vertex to a later one.
fn layers(graph: &Graph<'_>) -> Vec<usize> {
    let mut layers = vec![0; graph.vertices.len()];
    for &(from, to) in graph.edges.keys() {
        layers[to] = layers[to].max(layers[from] + 1);
    }
    layers
}
