//! Aliasing barriers: memory barriers where an image takes over memory that was written.
//!
//! An image barrier's memory scope covers its own image only. So the write of the resource that had the memory before must be
//! named by a memory barrier, in a call before that of the image barrier (docs/synchronization.md). Such a barrier covers
//! *all* memory: it serves every later image barrier that comes after it, directly or through others in between.

use super::batches::BarrierAtStep;
use super::subresource::SubresourceBarrier;
use crate::compile::model::PhysicalIndex;
use crate::compile::queues::{QUEUES, Queues};
use crate::compile::steps::of_step;
use crate::vulkan::{Accesses, Stages};

/// A write to memory that an image takes over.
#[derive(Debug, Clone, Copy)]
pub(super) struct AliasedWrite {
    /// The previous and the next owner of the memory.
    pub(super) resources: [PhysicalIndex; 2],
    /// Stages and writes of the previous owner's last use.
    pub(super) source: Source,
    /// The step of that use.
    pub(super) written: u32,
    /// Whether that was in this frame, or in the one before.
    pub(super) this_frame: bool,
    /// The next owner's first barrier.
    pub(super) barrier: u32,
}

/// A memory barrier between the owners of memory.
#[derive(Debug, Clone, Default)]
pub(in crate::compile) struct AliasingBarrier {
    pub(in crate::compile) src_stages: Stages,
    pub(in crate::compile) src_accesses: Accesses,
    pub(in crate::compile) dst_stages: Stages,
    /// Pairs of a previous and a next owner.
    pub(in crate::compile) resources: Vec<[PhysicalIndex; 2]>,
}

/// The first half of a memory barrier: the writes that it makes available.
///
/// An earlier barrier needs no more than that to serve: the layout change that the next owner begins with needs earlier
/// writes to be available, and is made visible by its own barrier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Source {
    pub(super) stages: Stages,
    pub(super) accesses: Accesses,
}

impl Source {
    fn covers(self, other: Source) -> bool {
        self.stages.contains(other.stages) && self.accesses.contains(other.accesses)
    }
}

/// A memory barrier that the walk through the frame has passed.
struct PassedBarrier {
    source: Source,
    /// When, counted over two frames.
    time: usize,
    /// Stages in which all later work comes after it.
    reach: Stages,
}

/// An aliased write with the step before which it must be available, and the stages that wait for it there.
struct DueWrite<'a> {
    at: u32,
    write: &'a AliasedWrite,
    waits: Stages,
}

/// The memory barriers that aliased writes take, each with its step, in the order of steps.
///
/// First those that the frame itself needs; then, in a second frame after the first, those that only the frame before
/// makes necessary. Each queue has barriers of its own.
pub(super) fn memory_barriers(
    queues: &Queues,
    aliased: &[AliasedWrite],
    barriers: &[SubresourceBarrier],
    batched: &[BarrierAtStep],
    steps: usize,
) -> Vec<(u32, AliasingBarrier)> {
    if aliased.is_empty() {
        return Vec::new();
    }
    let mut at = vec![0_u32; barriers.len()];
    batched.iter().for_each(|it| at[it.barrier as usize] = it.at);
    let mut due = Vec::with_capacity(aliased.len());
    for write in aliased {
        let number = write.barrier as usize;
        due.push(DueWrite { at: at[number], write, waits: barriers[number].src_stages.and_earlier() });
    }
    due.sort_by_key(|due| (due.at, due.write.resources));
    let mut memory: Vec<Option<AliasingBarrier>> = vec![None; steps];
    let mut passed: [Vec<PassedBarrier>; QUEUES] = Default::default();
    for time in 0..2 * steps {
        let (step, second_frame) = (time % steps, time >= steps);
        let passed = &mut passed[queues.queue_number(step as u32)];
        let here = of_step(&due, step as u32, |due| due.at);
        let is_now = |due: &&DueWrite<'_>| due.write.this_frame != second_frame && !done(passed, due);
        let now: Vec<&AliasedWrite> = here.iter().filter(is_now).map(|due| due.write).collect();
        add(&mut memory[step], &now);
        let images = of_step(batched, step as u32, |it| it.at).iter().map(|it| &barriers[it.barrier as usize]);
        pass(passed, time, memory[step].as_ref(), images);
    }
    (0..).zip(memory).filter_map(|(step, barrier)| Some((step, barrier?))).collect()
}

/// Whether a barrier since the write serves already. All writes are in the first frame that is walked.
fn done(passed: &[PassedBarrier], DueWrite { write, waits, .. }: &DueWrite<'_>) -> bool {
    passed.iter().any(|barrier| {
        barrier.time > write.written as usize && barrier.source.covers(write.source) && waits.intersects(barrier.reach)
    })
}

fn add(barrier: &mut Option<AliasingBarrier>, writes: &[&AliasedWrite]) {
    for AliasedWrite { resources, source, .. } in writes {
        let barrier = barrier.get_or_insert_default();
        barrier.src_stages |= source.stages;
        barrier.src_accesses |= source.accesses;
        // The image barrier, a call later, waits for the same stages.
        barrier.dst_stages |= source.stages;
        if !barrier.resources.contains(resources) {
            barrier.resources.push(*resources);
        }
    }
}

/// Passes the barriers of one step: its memory barrier, then its image barriers, which don't order each other.
fn pass<'p>(
    passed: &mut Vec<PassedBarrier>,
    time: usize,
    memory: Option<&AliasingBarrier>,
    images: impl Iterator<Item = &'p SubresourceBarrier>,
) {
    if let Some(memory) = memory {
        lead_on(passed, &[(memory.src_stages, memory.dst_stages)]);
        let source = Source { stages: memory.src_stages, accesses: memory.src_accesses };
        // A later barrier of at least the same source and reach serves all that an earlier one could, so few are kept.
        let reach = memory.dst_stages.and_later();
        passed.retain(|barrier| !(source.covers(barrier.source) && reach.contains(barrier.reach)));
        passed.push(PassedBarrier { source, time, reach });
    }
    let scopes: Vec<(Stages, Stages)> = images.map(|it| (it.src_stages, it.dst_stages)).collect();
    lead_on(passed, &scopes);
}

/// Extends execution dependency chains by the barriers of one call.
fn lead_on(passed: &mut [PassedBarrier], scopes: &[(Stages, Stages)]) {
    for barrier in passed {
        let follows = |(src, _): &&(Stages, Stages)| src.and_earlier().intersects(barrier.reach);
        let next = scopes.iter().filter(follows).fold(barrier.reach, |reach, (_, dst)| reach | dst.and_later());
        barrier.reach = next;
    }
}
