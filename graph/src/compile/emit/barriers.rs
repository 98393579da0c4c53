//! Barriers of each step: those of parts that belong together become one.

use super::{Parts, resource};
use crate::compile::batch::Batched;
use crate::compile::parts::join;
use crate::compile::synchronise::{NEVER, Pending};
use crate::plan::{BufferHazard, BufferId, Hazard, ImageBarrier, ImageId, MemoryBarrier, StepId, Subresources};
use crate::vulkan::Accesses;

/// Hands out the barriers step by step.
pub(super) struct Barriers<'p, 'a> {
    parts: &'p Parts<'a>,
    batched: &'p [Batched],
    memory: usize,
}

impl<'p, 'a> Barriers<'p, 'a> {
    pub(super) fn new(parts: &'p Parts<'a>) -> Barriers<'p, 'a> {
        Barriers { parts, batched: parts.batched, memory: 0 }
    }

    /// The barriers of step number `step`; steps are asked for in order.
    pub(super) fn of(&mut self, step: u32) -> (Vec<MemoryBarrier>, Vec<ImageBarrier>) {
        let here = self.batched.iter().take_while(|it| it.at == step).count();
        let (here, rest) = self.batched.split_at(here);
        self.batched = rest;
        let mut memory = Vec::new();
        if let Some((at, scopes)) = self.parts.memory.get(self.memory)
            && *at == step
        {
            self.memory += 1;
            let stores = &self.parts.adapted.stores;
            let hand_overs = scopes.hand_overs.iter();
            memory.push(MemoryBarrier {
                src_stages: scopes.src_stages,
                src_accesses: scopes.src_accesses,
                dst_stages: scopes.dst_stages,
                dst_accesses: Accesses::empty(),
                hand_overs: hand_overs.map(|pair| pair.map(|store| resource(&stores[store as usize]))).collect(),
                buffers: Vec::new(),
            });
        }
        let mut images = Vec::with_capacity(here.len());
        let mut buffers: Option<MemoryBarrier> = None;
        for it in here {
            let pending = &self.parts.pending[it.barrier as usize];
            let subject = &self.parts.subjects[pending.store as usize];
            if !subject.is_image {
                add_buffer(&mut buffers, pending, subject.id);
                continue;
            }
            if pending.hazard == Hazard::Ownership {
                // Its other half has to be the same: see `queues`.
                continue;
            }
            let range = if subject.is_cut { self.part(pending) } else { subject.all };
            add(&mut images, image_barrier(pending, subject.id, range));
        }
        memory.extend(buffers);
        (memory, images)
    }

    /// The part of its image that a barrier is about.
    fn part(&self, pending: &Pending) -> Subresources {
        let store = &self.parts.adapted.stores[pending.store as usize];
        let grid = store.grid(self.parts.grids);
        grid.map_or(store.all(), |grid| grid.range(pending.cell - store.first_cell))
    }
}

fn after(pending: &Pending) -> Option<StepId> {
    (pending.after != NEVER).then_some(StepId(pending.after))
}

/// What the frame leaves in a state is needed by whatever comes after it.
fn needed_by(pending: &Pending) -> Option<StepId> {
    (pending.hazard != Hazard::Export).then_some(StepId(pending.step))
}

fn image_barrier(pending: &Pending, image: u32, range: Subresources) -> ImageBarrier {
    ImageBarrier {
        image: ImageId(image),
        range,
        src_stages: pending.src_stages,
        src_accesses: pending.src_accesses,
        dst_stages: pending.dst_stages,
        dst_accesses: pending.dst_accesses,
        old_layout: pending.old_layout,
        new_layout: pending.new_layout,
        ownership: None,
        hazard: pending.hazard,
        after: after(pending),
        needed_by: needed_by(pending),
    }
}

/// Adds a barrier, joined with those before it that differ from it only in their part of the image.
fn add(barriers: &mut Vec<ImageBarrier>, mut new: ImageBarrier) {
    while let Some(last) = barriers.last()
        && last.image == new.image
        && (ImageBarrier {
            range: new.range,
            after: new.after,
            needed_by: new.needed_by,
            hazard: new.hazard,
            ..last.clone()
        }) == new
        && let Some(range) = join(last.range, new.range)
    {
        let needed_by = [last.needed_by, new.needed_by].into_iter().flatten().min();
        new = ImageBarrier { range, after: last.after.max(new.after), needed_by, ..new };
        barriers.pop();
    }
    barriers.push(new);
}

/// All buffers of a step share one memory barrier.
fn add_buffer(barrier: &mut Option<MemoryBarrier>, pending: &Pending, buffer: u32) {
    let barrier = barrier.get_or_insert_with(|| MemoryBarrier {
        src_stages: pending.src_stages,
        src_accesses: pending.src_accesses,
        dst_stages: pending.dst_stages,
        dst_accesses: pending.dst_accesses,
        hand_overs: Vec::new(),
        buffers: Vec::new(),
    });
    barrier.src_stages |= pending.src_stages;
    barrier.src_accesses |= pending.src_accesses;
    barrier.dst_stages |= pending.dst_stages;
    barrier.dst_accesses |= pending.dst_accesses;
    let (buffer, after, needed_by) = (BufferId(buffer), after(pending), needed_by(pending));
    barrier.buffers.push(BufferHazard { buffer, hazard: pending.hazard, after, needed_by });
}
