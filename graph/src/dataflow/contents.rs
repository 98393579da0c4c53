//! The edges of a Plan's dataflow: the contents that nodes find, and which node left them.

use super::{Edge, Node, Use};
use crate::plan::{Plan, Resource, Role};
use crate::vulkan::Subresources;
use std::collections::{BTreeMap, BTreeSet};

/// The last writers of an image's or buffer's parts.
type Writers = Vec<(Option<Subresources>, u32)>;

/// All edges, without repetition.
pub(super) fn edges(plan: &Plan, nodes: &[Node]) -> Vec<Edge> {
    let mut edges = Vec::new();
    let mut writers: BTreeMap<Resource, Writers> = BTreeMap::new();
    for (to, node) in (0..).zip(nodes) {
        let mut found = BTreeSet::new();
        for used in &node.uses {
            let earlier = writers.get(&used.resource).map_or(&[][..], Vec::as_slice);
            let mut origins =
                earlier.iter().filter(|(range, _)| meet(*range, used.range)).map(|(_, from)| *from).peekable();
            if used.reads && origins.peek().is_none() && outlives(plan, used.resource) {
                found.insert(Edge { from: None, to: Some(to), resource: used.resource });
            }
            if used.reads || used.writes && !replaces(used) {
                let edge = |from| Edge { from: Some(from), to: Some(to), resource: used.resource };
                found.extend(origins.filter(|from| *from != to).map(edge));
            }
        }
        edges.extend(found);
        for used in node.uses.iter().filter(|used| used.writes) {
            let writers = writers.entry(used.resource).or_default();
            writers.retain(|(range, _)| !within(*range, used.range));
            writers.push((used.range, to));
        }
    }
    let mut last = BTreeSet::new();
    for (resource, writers) in &writers {
        if outlives(plan, *resource) {
            last.extend(writers.iter().map(|(_, from)| Edge { from: Some(*from), to: None, resource: *resource }));
        }
    }
    edges.extend(last);
    edges
}

/// Whether a use that reads nothing is sure to leave nothing of what was there: attachments that begin afresh, and the targets
/// of transfers. A storage image or buffer may be written in part.
fn replaces(used: &Use) -> bool {
    use super::UseRole::{Color, Depth, Target};
    matches!(used.role, Color | Depth | Target)
}

fn outlives(plan: &Plan, resource: Resource) -> bool {
    let role = match resource {
        Resource::Image(id) => plan.images.get(id.0 as usize).map(|image| &image.role),
        Resource::Buffer(id) => plan.buffers.get(id.0 as usize).map(|buffer| &buffer.role),
    };
    role.is_some_and(|role| !matches!(role, Role::Transient(_)))
}

/// Whether two parts of one image or buffer have anything in common. A buffer has one part.
fn meet(one: Option<Subresources>, other: Option<Subresources>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => one.overlaps(other),
        _ => true,
    }
}

/// Whether `part` lies within `whole`.
fn within(part: Option<Subresources>, whole: Option<Subresources>) -> bool {
    let (Some(part), Some(whole)) = (part, whole) else { return true };
    let covers =
        |base: u32, count: u32, of: u32, all: u32| of <= base && base.saturating_add(count) <= of.saturating_add(all);
    whole.aspects.contains(part.aspects)
        && covers(part.base_mip, part.mips, whole.base_mip, whole.mips)
        && covers(part.base_layer, part.layers, whole.base_layer, whole.layers)
}
