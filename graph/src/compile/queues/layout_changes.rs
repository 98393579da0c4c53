//! Changes of layout before several queues read.
//!
//! If the first reader changed the layout, readers on other queues would wait for that reader and its work. So a step of its
//! own, directly behind the write and on the queue of the write, changes the layout, and no reader waits for another one.

use super::crossing::{Crossing, LayoutChange};
use super::number::QUEUES;
use super::step_uses::uses_of;
use crate::compile::model::{Adapted, PhysicalIndex, SubresourceIndex};
use crate::compile::scope::{Scoped, Step};
use crate::plan::Queue;
use crate::vulkan::Layout;

/// The last use of a subresource: a write, or reads in one layout.
#[derive(Debug, Clone, Copy)]
struct LastUse {
    layout: Layout,
    /// The last step that wrote it.
    written: Option<u32>,
    /// The candidate that began the reads.
    change: Option<u32>,
}

/// A change of layout that readers on several queues may come after.
struct Candidate {
    behind: u32,
    change: LayoutChange,
    readers: [bool; QUEUES],
}

/// Inserts steps behind writes. Returns each with what it changes.
pub(super) fn insert(
    adapted: &Adapted,
    scoped: &mut Scoped,
    queues: &mut Vec<Queue>,
    crossings: &[Option<Crossing>],
) -> Vec<(u32, LayoutChange)> {
    let mut candidates = candidates(adapted, scoped, queues, crossings);
    candidates.retain(|it| it.readers.iter().filter(|reads| **reads).count() > 1);
    candidates.sort_by_key(|it| (it.behind, it.change.subresource));
    let mut changes = Vec::with_capacity(candidates.len());
    for (same, inserted) in candidates.chunk_by(|one, other| one.behind == other.behind).zip(1..) {
        let at = same[0].behind + inserted;
        scoped.steps.insert(at as usize, Step::BarriersOnly);
        queues.insert(at as usize, queues[at as usize - 1]);
        changes.extend(same.iter().map(|it| (at, it.change)));
    }
    changes
}

fn candidates(adapted: &Adapted, scoped: &Scoped, queues: &[Queue], crossings: &[Option<Crossing>]) -> Vec<Candidate> {
    let mut subresources =
        vec![LastUse { layout: Layout::Undefined, written: None, change: None }; adapted.subresources as usize];
    let mut candidates: Vec<Candidate> = Vec::new();
    for ((step, at), queue) in scoped.steps.iter().zip(0..).zip(queues) {
        for used in uses_of(adapted, step) {
            if crossings[used.resource as usize] != Some(Crossing::Image) {
                continue;
            }
            let resource: PhysicalIndex = used.resource;
            adapted.for_each_subresource(used, |index: SubresourceIndex| {
                let subresource = &mut subresources[index as usize];
                if used.writes {
                    *subresource = LastUse { layout: used.layout, written: Some(at), change: None };
                } else if subresource.layout != used.layout {
                    let change = LayoutChange { subresource: index, resource, layout: used.layout };
                    let behind = subresource.written.take().filter(|written| *written != at);
                    let next = candidates.len() as u32;
                    candidates.extend(behind.map(|behind| Candidate { behind, change, readers: [false; QUEUES] }));
                    (subresource.layout, subresource.change) = (used.layout, behind.map(|_| next));
                }
                if let Some(candidate) = subresource.change.and_then(|change| candidates.get_mut(change as usize)) {
                    candidate.readers[*queue as usize] = true;
                }
            });
        }
    }
    candidates
}
