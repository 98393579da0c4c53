//! Redundant barriers: those before first accesses that wait for earlier frames, for what other barriers wait for too.
//!
//! - A memory barrier of buffers, of the same call or of an earlier one, covers all that the barrier says.
//! - It waits for reads alone. A persistent resource may be written again several frames after it was read. The barriers of the
//!   frames in between may form an execution dependency chain from those reads to that write. The write before those reads must be
//!   visible to the new access too: by the barrier that made it visible to them. That of a buffer serves all buffers of its call.

use super::batches::BarrierAtStep;
use super::initial_barriers::CompleteBarriers;
use super::subresource::SubresourceBarrier;
use super::timeline::AccessTimeline;
use crate::compile::history_ring;
use crate::compile::model::{AdaptedFrame, MemorySource, PhysicalIndex};
use crate::compile::steps::NEVER;
use crate::plan::Hazard;
use crate::vulkan::{Accesses, Stages};

/// Takes redundant barriers out of the calls. With `poison`, barriers stay where an image gives up what it held: there it is poisoned.
pub(super) fn take_out(
    adapted: &AdaptedFrame,
    timeline: &AccessTimeline,
    poison: bool,
    initial: &mut CompleteBarriers,
    batched: &mut Vec<BarrierAtStep>,
) {
    // Barriers that make others redundant. They stay.
    let mut needed: Vec<u32> = Vec::new();
    let mut at = 0;
    while let Some(it) = batched.get(at).copied() {
        let barrier = &initial.barriers[it.barrier as usize];
        let may_go = waits_alone(timeline, barrier)
            && (barrier.keeps || !poison)
            && !initial.queues.is_crossed(barrier.resource)
            && !initial.queues.is_held(it.barrier)
            && !needed.contains(&it.barrier);
        let others = may_go.then(|| Calls { adapted, timeline, initial, batched }.make_redundant(it)).flatten();
        if let Some(others) = others {
            needed.extend(others);
            initial.barriers[it.barrier as usize].step = NEVER;
            batched.remove(at);
        } else {
            at += 1;
        }
    }
}

/// Whether a barrier does nothing but wait for earlier frames: it leaves the layout as it is.
fn waits_alone(timeline: &AccessTimeline, barrier: &SubresourceBarrier) -> bool {
    let found = || timeline.states[barrier.resource as usize].map(|states| states.before.layout);
    barrier.hazard == Hazard::FirstUse
        && barrier.after == NEVER
        && !barrier.src_stages.is_empty()
        && (barrier.old_layout == barrier.new_layout || !barrier.keeps && found() == Some(barrier.new_layout))
}

/// Reads of an earlier frame.
struct Reads {
    /// The barrier between the write before these reads and the reads, if the write was in the same frame.
    behind_write: Option<u32>,
    stages: Stages,
    /// The last step that reads.
    step: u32,
    frames_ago: u32,
}

/// The barriers of all calls.
struct Calls<'c> {
    adapted: &'c AdaptedFrame,
    timeline: &'c AccessTimeline,
    initial: &'c CompleteBarriers,
    batched: &'c [BarrierAtStep],
}

impl Calls<'_> {
    fn barrier(&self, it: &BarrierAtStep) -> &SubresourceBarrier {
        &self.initial.barriers[it.barrier as usize]
    }

    /// Other barriers that make this one redundant, if there are such.
    fn make_redundant(&self, it: BarrierAtStep) -> Option<Vec<u32>> {
        let barrier = self.barrier(&it);
        let by_reads = || barrier.src_accesses.is_empty().then(|| self.lead_on(it, barrier)).flatten();
        self.cover(it, barrier).or_else(by_reads)
    }

    /// The barriers of a call whose memory barrier, without this barrier, says all that it says.
    fn cover(&self, it: BarrierAtStep, barrier: &SubresourceBarrier) -> Option<Vec<u32>> {
        let queues = &self.initial.queues;
        let comes_before = |call: &[BarrierAtStep]| {
            call[0].at <= it.at && queues.queue_number(call[0].at) == queues.queue_number(it.at)
        };
        let mut calls = self.batched.chunk_by(|one, other| one.at == other.at).filter(|call| comes_before(call));
        calls.find_map(|call| {
            let others = call.iter().filter(|other| other.barrier != it.barrier);
            let of_buffers = others.filter(|other| self.is_buffer(self.barrier(other).resource));
            enough(of_buffers.map(|other| other.barrier).collect(), |parts| self.say(parts, barrier))
        })
    }

    /// Whether barriers, taken together, say all that a barrier says.
    fn say(&self, parts: &[u32], barrier: &SubresourceBarrier) -> bool {
        let (mut src, mut dst) = ((Stages::empty(), Accesses::empty()), (Stages::empty(), Accesses::empty()));
        for part in parts.iter().map(|part| &self.initial.barriers[*part as usize]) {
            src = (src.0 | part.src_stages, src.1 | part.src_accesses);
            dst = (dst.0 | part.dst_stages, dst.1 | part.dst_accesses);
        }
        !parts.is_empty()
            && src.0.contains(barrier.src_stages)
            && src.1.contains(barrier.src_accesses)
            && dst.0.contains(barrier.dst_stages)
            && dst.1.contains(barrier.dst_accesses)
    }

    fn is_buffer(&self, resource: PhysicalIndex) -> bool {
        self.adapted.resources[resource as usize].image().is_none()
    }

    /// Barriers that form a chain from the reads that this one waits for to the access behind it, if there are such: with those that
    /// make the write before the reads visible.
    fn lead_on(&self, it: BarrierAtStep, barrier: &SubresourceBarrier) -> Option<Vec<u32>> {
        let reads = self.earlier_reads(barrier);
        let known = reads.iter().fold(Stages::empty(), |all, reads| all | reads.stages);
        let behind_write = reads.last().and_then(|reads| reads.behind_write);
        if known != barrier.src_stages {
            return None;
        }
        let mut needed = self.showing(behind_write?, barrier)?;
        for reads in &reads {
            for stage in reads.stages.iter() {
                needed.extend(self.following(it, reads, stage)?);
            }
        }
        Some(needed)
    }

    /// The reads of a subresource since it was written last, in earlier frames.
    fn earlier_reads(&self, barrier: &SubresourceBarrier) -> Vec<Reads> {
        let resources = &self.adapted.resources;
        let MemorySource::Persistent { .. } = resources[barrier.resource as usize].memory else { return Vec::new() };
        let part = barrier.subresource - resources[barrier.resource as usize].first_subresource;
        let mut reads = Vec::new();
        for (frames_ago, from) in history_ring::earlier(self.adapted, barrier.resource) {
            let subresource = &self.timeline.subresources[(resources[from as usize].first_subresource + part) as usize];
            if !subresource.is_used() {
                continue;
            }
            if !subresource.writes() {
                let shows = self.initial.barriers.get(subresource.second_barrier as usize);
                let behind_write =
                    shows.filter(|it| it.hazard == Hazard::ReadAfterWrite).map(|_| subresource.second_barrier);
                reads.push(Reads { behind_write, stages: subresource.stages, step: subresource.last, frames_ago });
            }
            if subresource.writes() || subresource.second_barrier != NEVER {
                break;
            }
        }
        reads
    }

    /// Barrier number `shows`, with those that form a memory barrier with it, if it makes the same write visible to the access behind
    /// `barrier`.
    fn showing(&self, shows: u32, barrier: &SubresourceBarrier) -> Option<Vec<u32>> {
        let one = self.batched.iter().find(|it| it.barrier == shows)?;
        let of_call = self.batched.iter().filter(|it| it.at == one.at && self.is_buffer(self.barrier(it).resource));
        let others: Vec<u32> = match self.is_buffer(barrier.resource) {
            true => of_call.map(|it| it.barrier).filter(|it| *it != shows).collect(),
            false => Vec::new(),
        };
        let shown = |others: &[u32]| {
            let parts = others.iter().chain([&shows]).map(|part| &self.initial.barriers[*part as usize]);
            let (stages, accesses) = parts.fold((Stages::empty(), Accesses::empty()), |(stages, accesses), it| {
                (stages | it.dst_stages, accesses | it.dst_accesses)
            });
            stages.contains(barrier.dst_stages) && accesses.contains(barrier.dst_accesses)
        };
        let mut needed = enough(others, shown)?;
        needed.push(shows);
        Some(needed)
    }

    /// Barriers that form a chain from reads in `stage` to the stages before which the barrier `it` stands, if there are such.
    fn following(&self, it: BarrierAtStep, reads: &Reads, stage: Stages) -> Option<Vec<u32>> {
        let links = self.links(it, reads, stage, |_| true)?;
        enough(links, |links| self.links(it, reads, stage, |other| links.contains(&other)).is_some())
    }

    /// Those of some barriers that lead on from reads in `stage`, if they lead to the stages before which the barrier `it` stands.
    fn links(
        &self,
        it: BarrierAtStep,
        reads: &Reads,
        stage: Stages,
        is_among: impl Fn(u32) -> bool,
    ) -> Option<Vec<u32>> {
        let queues = &self.initial.queues;
        let mut reach = Stages::empty();
        let mut links = Vec::new();
        for frames_ago in (0..=reads.frames_ago).rev() {
            let comes_between = |other: &&BarrierAtStep| {
                other.barrier != it.barrier
                    && is_among(other.barrier)
                    && queues.queue_number(other.at) == queues.queue_number(it.at)
                    && (frames_ago < reads.frames_ago || other.at > reads.step)
                    && (frames_ago > 0 || other.at < it.at)
            };
            for call in self.batched.chunk_by(|one, other| one.at == other.at) {
                let waits = |other: &&BarrierAtStep| {
                    let from = self.barrier(other).src_stages.and_earlier();
                    from.contains(stage) || from.intersects(reach)
                };
                let of_call: Vec<&BarrierAtStep> = call.iter().filter(comes_between).filter(waits).collect();
                links.extend(of_call.iter().map(|other| other.barrier));
                reach = of_call.iter().fold(reach, |reach, other| reach | self.barrier(other).dst_stages.and_later());
            }
        }
        links.sort_unstable();
        links.dedup();
        reach.contains(self.barrier(&it).dst_stages).then_some(links)
    }
}

/// At most this many barriers are tried one by one, which takes their square. If there are more, all stay that a proof could
/// rest on.
const MOST_TRIED: usize = 32;

/// Those of some barriers that are enough for a proof. It can do without none of them if they were few. `None`: all of them aren't enough.
fn enough(mut barriers: Vec<u32>, prove: impl Fn(&[u32]) -> bool) -> Option<Vec<u32>> {
    if !prove(&barriers) {
        return None;
    }
    if barriers.len() > MOST_TRIED {
        return Some(barriers);
    }
    for at in (0..barriers.len()).rev() {
        let left_out = barriers.remove(at);
        if !prove(&barriers) {
            barriers.insert(at, left_out);
        }
    }
    Some(barriers)
}
