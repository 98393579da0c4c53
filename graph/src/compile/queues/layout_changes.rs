//! Changes of layout before several queues read.
//!
//! If the first reader changed the layout, readers on other queues would wait for that reader and its work. So a step of its
//! own, directly behind the write and on the queue of the write, changes the layout, and no reader waits for another one.

use super::crossing::{Crossing, LayoutChange};
use super::number::QUEUES;
use super::step_uses::uses_of;
use crate::compile::model::{AdaptedFrame, PhysicalIndex, SubresourceIndex, Use};
use crate::compile::scope::{ScopedSteps, Step};
use crate::plan::Queue;
use crate::vulkan::Layout;

/// The last use of a subresource: a write, or reads in one layout. Reads in the layout of the write don't count: the step that
/// changes the layout comes directly behind the write. So this is no [`AccessChain`](crate::compile::access_chain::AccessChain).
#[derive(Debug, Clone, Copy)]
struct LastUse {
    layout: Layout,
    /// The last step that wrote it.
    written: Option<u32>,
    /// The candidate that began the reads.
    change: Option<u32>,
}

/// A change of layout that readers on several queues may come after.
///
/// A step that reads and writes is no reader: it changes the layout again, into one that lets it write. As a reader on the queue of the
/// write it would have the change made, and nothing on that queue would wait for the barrier, so that no semaphore could lead on from it.
struct Candidate {
    behind: u32,
    change: LayoutChange,
    readers: [bool; QUEUES],
}

/// Steps with the queue of each, and steps among them that only change layouts.
pub(super) struct ChangedLayoutSteps {
    pub(super) scoped: ScopedSteps,
    pub(super) queues: Vec<Queue>,
    /// The step that makes each change, and the change.
    pub(super) changes: Vec<(u32, LayoutChange)>,
}

/// Inserts steps that change layouts behind writes.
pub(super) fn insert(
    adapted: &AdaptedFrame,
    mut scoped: ScopedSteps,
    queues: &[Queue],
    crossings: &[Option<Crossing>],
) -> ChangedLayoutSteps {
    let mut candidates = candidates(adapted, &scoped.steps, queues, crossings);
    candidates.retain(|it| it.readers.iter().filter(|reads| **reads).count() > 1);
    candidates.sort_by_key(|it| (it.behind, it.change.subresource));
    let mut candidates = candidates.iter().peekable();
    let before = std::mem::take(&mut scoped.steps);
    let mut queues_with = Vec::with_capacity(before.len() + candidates.len());
    let mut changes = Vec::with_capacity(candidates.len());
    for ((step, queue), number) in before.into_iter().zip(queues).zip(0..) {
        scoped.steps.push(step);
        queues_with.push(*queue);
        let at = scoped.steps.len() as u32;
        while let Some(it) = candidates.next_if(|it| it.behind == number) {
            changes.push((at, it.change));
        }
        if changes.last().is_some_and(|(last, _)| *last == at) {
            scoped.steps.push(Step::BarriersOnly);
            queues_with.push(*queue);
        }
    }
    ChangedLayoutSteps { scoped, queues: queues_with, changes }
}

fn candidates(
    adapted: &AdaptedFrame,
    steps: &[Step],
    queues: &[Queue],
    crossings: &[Option<Crossing>],
) -> Vec<Candidate> {
    let mut subresources =
        vec![LastUse { layout: Layout::Undefined, written: None, change: None }; adapted.subresources as usize];
    let mut candidates: Vec<Candidate> = Vec::new();
    // The last step that writes each subresource, this one included.
    let mut writers: Vec<Option<u32>> = vec![None; adapted.subresources as usize];
    for ((step, at), queue) in steps.iter().zip(0..).zip(queues) {
        let crossed = |used: &&Use| crossings[used.resource as usize] == Some(Crossing::Image);
        for used in uses_of(adapted, step).filter(crossed).filter(|used| used.writes) {
            adapted.for_each_subresource(used, |index: SubresourceIndex| writers[index as usize] = Some(at));
        }
        for used in uses_of(adapted, step).filter(crossed) {
            let resource: PhysicalIndex = used.resource;
            adapted.for_each_subresource(used, |index: SubresourceIndex| {
                let subresource = &mut subresources[index as usize];
                if !used.writes && writers[index as usize] == Some(at) && subresource.written != Some(at) {
                    return;
                }
                if used.writes {
                    *subresource = LastUse { layout: used.layout, written: Some(at), change: None };
                } else if used.layout != subresource.layout {
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
