//! Initial barriers: the barriers before the first access to each subresource.
//!
//! Each waits for the state in which the frame finds the subresource, or for the accesses of the resource that had its memory
//! before. In the latter case the barrier names the *stages* of those accesses, and a memory barrier (`aliasing_barriers`)
//! names their writes. The first owner of memory in a frame comes after the last owner in the frame before.
//!
//! What outlives the frame, such as a history, is found in its state `before`. The backend brings it there once, before the first frame.

use super::aliasing_barriers::{AliasedWrite, Source};
use super::last_accesses::LastAccess;
use super::subresource::SubresourceBarrier;
use super::timeline::{AccessTimeline, States};
use crate::compile::history_ring;
use crate::compile::memory::AliasEdge;
use crate::compile::model::{AdaptedFrame, Kind, PhysicalIndex, SubresourceIndex};
use crate::compile::queues::{QUEUES, QueueUse, Queues};
use crate::compile::steps::NEVER;
use std::ops::Range;

/// All barriers and waits.
pub(super) struct CompleteBarriers {
    pub(super) barriers: Vec<SubresourceBarrier>,
    pub(super) queues: Queues,
    /// Writes that memory barriers have to name.
    pub(super) aliased: Vec<AliasedWrite>,
}

/// Completes `barriers`, which are those of the timeline.
pub(super) fn complete(
    adapted: &AdaptedFrame,
    timeline: &AccessTimeline,
    barriers: Vec<SubresourceBarrier>,
    aliasing: &[AliasEdge],
) -> CompleteBarriers {
    let initial = CompleteBarriers { barriers, queues: timeline.queues.clone(), aliased: Vec::new() };
    let plain = adapted.buffers == 0 && adapted.is_uncut();
    let mut completing = BarrierCompletion { adapted, timeline, plain, initial, accesses: Vec::new() };
    for (at, states) in (0..).zip(&timeline.states) {
        match states {
            Some(states) if timeline.queues.is_crossed(at) => completing.find_crossed(at, states),
            Some(states) => completing.find(at, states),
            None => {}
        }
    }
    aliasing.iter().for_each(|edge| completing.take_over(edge));
    let mut initial = completing.initial;
    if !initial.queues.is_one() {
        follow_waits(adapted, &mut initial);
        initial.queues.wait_for_earlier_frames();
    }
    initial
}

struct BarrierCompletion<'c> {
    adapted: &'c AdaptedFrame,
    timeline: &'c AccessTimeline,
    /// Whether each resource is an image of one subresource. Most are: then few of them are looked at.
    plain: bool,
    initial: CompleteBarriers,
    /// The last accesses of the previous owner of memory.
    accesses: Vec<LastAccess>,
}

impl BarrierCompletion<'_> {
    fn subresources(&self, resource: PhysicalIndex) -> Range<SubresourceIndex> {
        // Each then has the number of its subresource.
        if self.plain { resource..resource + 1 } else { self.adapted.resources[resource as usize].subresources() }
    }

    /// Completes the initial barriers of a resource that outlives the frame, from its state before the frame.
    fn find(&mut self, resource: PhysicalIndex, states: &States) {
        let barriers = &mut self.initial.barriers;
        for subresource in self.adapted.resources[resource as usize].subresources() {
            let known = &self.timeline.subresources[subresource as usize];
            let Some(barrier) = barriers.get_mut(known.first_barrier as usize) else { continue };
            complete_from_state(barrier, states, known.second_barrier == NEVER);
            let is_needed = barrier.step != NEVER;
            // Without it, nothing else waits for earlier reads.
            if let Some(next) = barriers.get_mut(known.second_barrier as usize).filter(|_| !is_needed) {
                next.src_stages |= states.before.stages;
            }
        }
    }

    /// Completes those of a resource that several queues use, from its last uses in earlier frames.
    fn find_crossed(&mut self, resource: PhysicalIndex, states: &States) {
        let first_subresource = self.adapted.resources[resource as usize].first_subresource;
        for subresource in self.subresources(resource) {
            let number = self.timeline.subresources[subresource as usize].first_barrier;
            let (frames_ago, used) = self.last_uses(resource, subresource - first_subresource);
            let CompleteBarriers { barriers, queues, .. } = &mut self.initial;
            let Some(barrier) = barriers.get_mut(number as usize) else { continue };
            let queue = queues.queue_number(barrier.step);
            let own = used[queue];
            let mut own_is_known = false;
            for (other, used) in used.iter().enumerate().filter(|(other, used)| *other != queue && used.until > 0) {
                queues.require_earlier(barrier.step, other, used.until - 1, frames_ago);
                own_is_known |= queues.signal(used.until - 1)[queue] >= own.until;
            }
            let own = if own_is_known { QueueUse::default() } else { own };
            (barrier.src_stages, barrier.src_accesses) = (own.stages, own.accesses.writes());
            if barrier.keeps {
                barrier.old_layout = states.before.layout;
            }
            queues.hold(number);
            if own.until == 0 && barrier.old_layout == barrier.new_layout {
                barrier.step = NEVER;
            }
        }
    }

    /// How queues used a part of a resource in the last frame that did, and how many frames ago that was.
    fn last_uses(&self, resource: PhysicalIndex, part: u32) -> (u32, [QueueUse; QUEUES]) {
        let subresource = |resource: PhysicalIndex| self.adapted.resources[resource as usize].first_subresource + part;
        let mut earlier =
            history_ring::earlier(self.adapted, resource).map(|(ago, resource)| (ago, subresource(resource)));
        let used = earlier.find(|(_, subresource)| self.timeline.subresources[*subresource as usize].is_used());
        used.map_or_else(
            || (1, Default::default()),
            |(ago, subresource)| (ago, self.timeline.queues.uses(subresource).by),
        )
    }

    /// Completes those of a resource that takes over memory, from the last accesses of the memory's previous owner.
    fn take_over(&mut self, edge: &AliasEdge) {
        let (before, subresources) = (self.subresources(edge.from), self.subresources(edge.resource));
        if self.initial.queues.is_one() && (before.len(), subresources.len()) == (1, 1) {
            self.follow_one(edge, before.start, subresources.start);
        } else if edge.resource == edge.from {
            // A resource that had its memory in the frame before too waits subresource by subresource.
            subresources
                .for_each(|subresource| self.follow(edge, subresource..subresource + 1, subresource..subresource + 1));
        } else {
            self.follow(edge, before, subresources);
        }
    }

    /// Whether the barriers of a resource that takes over memory cover the memory itself. A buffer's barriers do; an image's
    /// cover only the image.
    fn covers(&self, AliasEdge { resource, from, .. }: &AliasEdge) -> bool {
        resource == from || !self.plain && self.adapted.resources[*resource as usize].image().is_none()
    }

    /// As [`BarrierCompletion::follow`], for two subresources on one queue: mostly there are no others.
    fn follow_one(&mut self, edge: &AliasEdge, before: SubresourceIndex, subresource: SubresourceIndex) {
        let covers = self.covers(edge);
        let BarrierCompletion { timeline, initial: CompleteBarriers { barriers, aliased, .. }, .. } = self;
        let number = timeline.subresources[subresource as usize].first_barrier;
        if let Some(access) = LastAccess::of_state(&timeline.subresources[before as usize], 0)
            && let Some(barrier) = barriers.get_mut(number as usize)
        {
            aliased.extend(wait_for(barrier, number, &access, edge, covers));
        }
    }

    /// Lets the initial barriers of `subresources` wait for the last accesses to the subresources `before` of the memory's
    /// previous owner.
    fn follow(&mut self, edge: &AliasEdge, before: Range<SubresourceIndex>, subresources: Range<SubresourceIndex>) {
        let covers = self.covers(edge);
        let BarrierCompletion { timeline, initial: CompleteBarriers { barriers, queues, aliased }, accesses, .. } =
            self;
        find_last_accesses(timeline, edge.from, before, accesses);
        for subresource in &timeline.subresources[subresources.start as usize..subresources.end as usize] {
            let number = subresource.first_barrier;
            let Some(barrier) = barriers.get_mut(number as usize) else { continue };
            let queue = queues.queue_number(barrier.step);
            for access in &*accesses {
                if access.queue == queue {
                    aliased.extend(wait_for(barrier, number, access, edge, covers));
                } else {
                    come_after(barrier, access.last, edge);
                    queues.require_earlier(barrier.step, access.queue, access.last, u32::from(!edge.this_frame));
                    queues.hold(number);
                }
            }
        }
    }
}

/// Lets a barrier stand behind the step `last`, if that is one of this frame.
fn come_after(barrier: &mut SubresourceBarrier, last: u32, edge: &AliasEdge) {
    if edge.this_frame {
        barrier.after = if barrier.after == NEVER { last } else { barrier.after.max(last) };
    }
}

/// Lets barrier number `number` wait for a last access, on its own queue, to the memory that is taken over. Returns the write
/// that a memory barrier has to name, if there is one: where the access wrote and the barrier doesn't cover the memory.
#[inline]
fn wait_for(
    barrier: &mut SubresourceBarrier,
    number: u32,
    access: &LastAccess,
    edge: &AliasEdge,
    covers: bool,
) -> Option<AliasedWrite> {
    let LastAccess { stages, writes, last, .. } = *access;
    let AliasEdge { resource, from, this_frame } = *edge;
    come_after(barrier, last, edge);
    barrier.src_stages |= stages;
    if covers {
        barrier.src_accesses |= writes;
        return None;
    }
    let source = Source { stages, accesses: writes };
    let write = AliasedWrite { resources: [from, resource], source, written: last, this_frame, barrier: number };
    (!writes.is_empty()).then_some(write)
}

/// Puts the last accesses to some subresources of a resource into `accesses`.
fn find_last_accesses(
    timeline: &AccessTimeline,
    resource: PhysicalIndex,
    subresources: Range<SubresourceIndex>,
    accesses: &mut Vec<LastAccess>,
) {
    let queues = &timeline.queues;
    let is_crossed = queues.is_crossed(resource);
    accesses.clear();
    for (known, subresource) in
        timeline.subresources[subresources.start as usize..subresources.end as usize].iter().zip(subresources.start..)
    {
        if is_crossed {
            for (queue, used) in queues.uses(subresource).by.iter().enumerate().filter(|(_, used)| used.until > 0) {
                LastAccess { queue, stages: used.stages, writes: used.accesses.writes(), last: used.until - 1 }
                    .add_to(accesses);
            }
        } else if let Some(access) = LastAccess::of_state(known, queues.queue_number(known.last)) {
            access.add_to(accesses);
        }
    }
}

/// Completes the barrier before the first access to a resource that outlives frames. `is_last`: there is no other barrier.
fn complete_from_state(barrier: &mut SubresourceBarrier, States { before, after }: &States, is_last: bool) {
    let covers = before.layout == barrier.new_layout
        && before.stages.contains(barrier.dst_stages)
        && before.accesses.contains(barrier.dst_accesses);
    let reads = (barrier.dst_accesses | before.accesses).writes().is_empty();
    barrier.src_stages = before.stages;
    barrier.src_accesses = before.accesses.writes();
    if barrier.keeps {
        barrier.old_layout = before.layout;
        // The next frame must wait for earlier readers too, if nothing in this one does.
        let waits_later = !is_last || after.stages.contains(before.stages);
        if covers && reads && waits_later {
            barrier.step = NEVER;
        }
    }
}

/// Lets barriers without a first scope come after the waits of their steps.
///
/// Without one, a barrier wouldn't come after the semaphore. So it names the stages that it holds up, which the wait holds up
/// too. A buffer takes no barrier beside the wait.
fn follow_waits(adapted: &AdaptedFrame, CompleteBarriers { barriers, queues, .. }: &mut CompleteBarriers) {
    for (barrier, number) in barriers.iter_mut().zip(0..) {
        if barrier.src_stages.is_empty() && queues.is_held(number) {
            match adapted.resources[barrier.resource as usize].kind {
                Kind::Image(_) => barrier.src_stages = barrier.dst_stages,
                Kind::Buffer(_) => barrier.step = NEVER,
            }
        }
    }
}
