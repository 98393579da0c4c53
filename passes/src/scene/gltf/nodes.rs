//! The tree of nodes, walked without recursion.

use super::document::{Document, Node, follow};
use super::notes::Notes;
use super::problem::{GltfError, Problem};
use glam::{DMat4, DQuat, DVec3};

/// A node with its place in the world.
pub(super) struct PlacedNode<'d> {
    pub(super) number: usize,
    pub(super) node: &'d Node,
    pub(super) to_world: DMat4,
}

/// Every node of the scene that is shown, parents before children, siblings in the file's order. A node with a mistake is left out,
/// and what is below it, whose place isn't known then.
pub(super) fn walk<'d>(document: &'d Document, notes: &mut Notes) -> Vec<PlacedNode<'d>> {
    let family = Family::of(document, notes);
    let Roots { tops, listed } = roots(document, &family.parents, notes);
    let mut waiting: Vec<(usize, DMat4, bool)> =
        tops.into_iter().rev().map(|top| (top, DMat4::IDENTITY, false)).collect();
    let mut placed = Vec::new();
    while let Some((number, parent_to_world, parent_shown)) = waiting.pop() {
        let node = &document.nodes[number];
        let at = format!("node {number}");
        let to_world = match local(node, &at).map(|local| parent_to_world * local) {
            _ if node.left_out => continue,
            Ok(to_world) if to_world.is_finite() => Ok(to_world),
            Ok(_) => Err(Problem::NotFinite("its place and those of its ancestors together").at(&at)),
            Err(error) => Err(error),
        };
        let to_world = match to_world {
            Ok(to_world) => to_world,
            Err(error) => {
                notes.mistake(format!("{error}, so it and what is below it are left out"));
                continue;
            }
        };
        let shown = parent_shown || listed[number];
        waiting.extend(family.children[number].iter().rev().map(|child| (*child, to_world, shown)));
        if shown {
            placed.push(PlacedNode { number, node, to_world });
        }
    }
    placed
}

/// The nodes around each node.
struct Family {
    /// The parent of each node. Those of nodes that are their own ancestors lead in a circle, which no walk from the top reaches.
    parents: Vec<Option<usize>>,
    /// The children of each node. Each is a child once.
    children: Vec<Vec<usize>>,
}

impl Family {
    fn of(document: &Document, notes: &mut Notes) -> Family {
        let count = document.nodes.len();
        let mut family = Family { parents: vec![None; count], children: vec![Vec::new(); count] };
        for (number, node) in document.nodes.iter().enumerate() {
            for child in &node.children {
                let index = usize::try_from(*child).ok().filter(|child| *child < count);
                let Some(index) = index else {
                    let missing = Problem::Missing { kind: "node", index: *child, count }.at(&format!("node {number}"));
                    notes.mistake(format!("{missing}, so that child is left out"));
                    continue;
                };
                match family.parents[index] {
                    Some(other) => {
                        let two = Problem::TwoParents(other, number).at(&format!("node {index}"));
                        notes.mistake(format!("{two}, so it stands where node {other} places it"));
                    }
                    None => {
                        family.parents[index] = Some(number);
                        family.children[number].push(index);
                    }
                }
            }
        }
        family.note_circles(notes);
        family
    }

    fn note_circles(&self, notes: &mut Notes) {
        let count = self.parents.len();
        let mut tried_from = vec![usize::MAX; count];
        for start in 0..count {
            let mut next = Some(start);
            while let Some(node) = next.filter(|node| tried_from[*node] == usize::MAX) {
                tried_from[node] = start;
                next = self.parents[node];
            }
            if let Some(node) = next.filter(|node| tried_from[*node] == start) {
                let circle = Problem::Loop.at(&format!("node {node}"));
                notes.mistake(format!("{circle}, so it and what is below it are left out"));
            }
        }
    }
}

/// The nodes at which a walk begins.
struct Roots {
    /// Nodes without parents.
    tops: Vec<usize>,
    /// By node, whether it and its descendants are shown.
    listed: Vec<bool>,
}

/// The nodes at the top of the scene that the file shows; without any scene, of the file. If one isn't at the top, all
/// nodes above it are walked too, for its place.
fn roots(document: &Document, parents: &[Option<usize>], notes: &mut Notes) -> Roots {
    let count = document.nodes.len();
    let all = || (0..count).filter(|number| parents[*number].is_none());
    let whole = || Roots { tops: all().collect(), listed: vec![true; count] };
    if document.scenes.is_empty() && document.scene.is_none() {
        return whole();
    }
    let number = document.scene.unwrap_or(0);
    let scene = match follow(&document.scenes, number, "scene", "") {
        Ok(scene) => scene,
        Err(error) => {
            notes.mistake(format!("{error}, so all nodes are shown"));
            return whole();
        }
    };
    let at = format!("scene {number}");
    let (mut tops, mut inner) = (Vec::new(), false);
    let mut listed = vec![false; count];
    for root in &scene.nodes {
        let Some(number) = usize::try_from(*root).ok().filter(|root| *root < count) else {
            let missing = Problem::Missing { kind: "node", index: *root, count }.at(&at);
            notes.mistake(format!("{missing}, so that node is left out"));
            continue;
        };
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
        tops.extend(all().filter(|number| !listed[*number]));
    }
    Roots { tops, listed }
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
