//! The tree of nodes, walked without recursion.

use super::document::{Document, Node, follow};
use super::problem::{GltfError, Problem};
use crate::scene::notes::Notes;
use glam::{DMat4, DQuat, DVec3};

/// A node with its place in the world.
pub(super) struct Placed<'d> {
    pub(super) number: usize,
    pub(super) node: &'d Node,
    pub(super) to_world: DMat4,
}

/// Every node of the scene that is shown, parents before children, siblings in the file's order.
pub(super) fn walk<'d>(document: &'d Document, notes: &mut Notes) -> Result<Vec<Placed<'d>>, GltfError> {
    let parents = parents(document)?;
    let Roots { tops, listed } = roots(document, &parents, notes)?;
    let mut waiting: Vec<(usize, DMat4, bool)> =
        tops.into_iter().rev().map(|top| (top, DMat4::IDENTITY, false)).collect();
    let mut placed = Vec::new();
    while let Some((number, parent_to_world, parent_shown)) = waiting.pop() {
        let node = &document.nodes[number];
        let at = format!("node {number}");
        let to_world = parent_to_world * local(node, &at)?;
        if !to_world.is_finite() {
            return Err(Problem::NotFinite("its place and those of its ancestors together").at(&at));
        }
        let shown = parent_shown || listed[number];
        // `parents` has checked that every child exists and has no other parent.
        waiting.extend(node.children.iter().rev().map(|child| (*child as usize, to_world, shown)));
        if shown {
            placed.push(Placed { number, node, to_world });
        }
    }
    Ok(placed)
}

/// The parent of every node. Each node has at most one, and none is its own ancestor.
fn parents(document: &Document) -> Result<Vec<Option<usize>>, GltfError> {
    let nodes = &document.nodes;
    let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
    for (number, node) in nodes.iter().enumerate() {
        for child in &node.children {
            follow(nodes, *child, "node", &format!("node {number}"))?;
            let child = *child as usize;
            if let Some(other) = parents[child].replace(number) {
                return Err(Problem::TwoParents(other, number).at(&format!("node {child}")));
            }
        }
    }
    let mut tried_from = vec![usize::MAX; nodes.len()];
    for start in 0..nodes.len() {
        let mut next = Some(start);
        while let Some(node) = next.filter(|node| tried_from[*node] == usize::MAX) {
            tried_from[node] = start;
            next = parents[node];
        }
        if let Some(node) = next.filter(|node| tried_from[*node] == start) {
            return Err(Problem::Loop.at(&format!("node {node}")));
        }
    }
    Ok(parents)
}

/// The nodes at which a walk begins.
struct Roots {
    /// Nodes without parents.
    tops: Vec<usize>,
    /// By node, whether it and its descendants are shown.
    listed: Vec<bool>,
}

/// The nodes at the top of the scene that the file shows; without any scene, of the file. Of a node that isn't at the top all
/// that is above it is walked too, for its place.
fn roots(document: &Document, parents: &[Option<usize>], notes: &mut Notes) -> Result<Roots, GltfError> {
    let all = (0..document.nodes.len()).filter(|number| parents[*number].is_none());
    if document.scenes.is_empty() && document.scene.is_none() {
        return Ok(Roots { tops: all.collect(), listed: vec![true; document.nodes.len()] });
    }
    let number = document.scene.unwrap_or(0);
    let scene = follow(&document.scenes, number, "scene", "")?;
    let at = format!("scene {number}");
    let (mut tops, mut inner) = (Vec::new(), false);
    let mut listed = vec![false; document.nodes.len()];
    for root in &scene.nodes {
        follow(&document.nodes, *root, "node", &at)?;
        let number = *root as usize;
        if std::mem::replace(&mut listed[number], true) {
            notes.add(format!("{at}: it lists node {number} twice, which is drawn once"));
        } else if let Some(parent) = parents[number] {
            inner = true;
            notes.add(format!(
                "{at}: it lists node {number}, a child of node {parent}, which is drawn once, where its parent places it"
            ));
        } else {
            tops.push(number);
        }
    }
    if inner {
        tops.extend(all.filter(|number| !listed[*number]));
    }
    Ok(Roots { tops, listed })
}

/// From the node's space to its parent's.
fn local(node: &Node, at: &str) -> Result<DMat4, GltfError> {
    let Some(matrix) = node.matrix else {
        let scale = node.scale.map_or(DVec3::ONE, DVec3::from);
        let translation = node.translation.map_or(DVec3::ZERO, DVec3::from);
        let rotation = match node.rotation {
            Some(rotation) => {
                let length = DQuat::from_array(rotation).length();
                if !(length > 0.0 && length.is_finite()) {
                    let is = format!("{rotation:?}");
                    return Err(Problem::OutOfRange { what: "its rotation", is, expected: "a unit quaternion" }.at(at));
                }
                DQuat::from_array(rotation.map(|part| part / length))
            }
            None => DQuat::IDENTITY,
        };
        return Ok(DMat4::from_scale_rotation_translation(scale, rotation, translation));
    };
    if node.translation.is_some() || node.rotation.is_some() || node.scale.is_some() {
        return Err(Problem::MatrixAndParts.at(at));
    }
    let mut matrix = DMat4::from_cols_array(&matrix);
    // Exporters round what was exact.
    if !matrix.row(3).abs_diff_eq(glam::DVec4::W, 1e-4) {
        return Err(Problem::NotAffine.at(at));
    }
    for (column, last) in [0.0, 0.0, 0.0, 1.0].into_iter().enumerate() {
        matrix.col_mut(column).w = last;
    }
    Ok(matrix)
}
