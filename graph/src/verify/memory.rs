//! Whether each transient image and buffer has its bytes to itself while it lives, and takes them over properly.
//!
//! **The rule of a hand-over.** An image takes its bytes with its first barrier from `UNDEFINED`, a buffer with its first
//! access in which it doesn't have them; they keep them until another one takes some of them. When B takes bytes of A, in
//! the same frame or with A's use in the frame before:
//! 1. no access of A in this frame may come before *and* another one after that: their uses don't interleave;
//! 2. the first barrier on each part of an image B must be execution-ordered after every last access of A; so must every
//!    access of the first step that uses a buffer B;
//! 3. A's last write must be available by then: by an image barrier on A, by a memory barrier in the batch of B's
//!    barrier or earlier, or by a semaphore. B's own barrier doesn't speak for A, with any source scope: an
//!    image barrier's memory scope is its own image. To the first accesses of a buffer B, which no barrier of its own
//!    protects, it must be visible as well.

use super::clocks::Clock;
use super::dependencies::{MissingPart, before_access, before_layout_change};
use super::findings::{Finding, name, role};
use super::owners::Owners;
use super::program::Access;
use super::scopes::PairSet;
use super::subresources::{Contents, LostContents, SubresourceState};
use super::violation::{Rule, StepName};
use super::walk::Walk;
use crate::plan::{Plan, Role, StepId};

/// The owners of the heaps' bytes. Images and buffers are numbered in one row.
#[derive(Debug)]
pub(super) struct Memory {
    owners: Owners,
    /// For each image and buffer: how it stands to its bytes.
    holders: Vec<Holder>,
    /// From whom bytes were taken, one taking after the other.
    predecessors: Vec<u32>,
}

/// How an image or buffer stands to its bytes.
#[derive(Debug, Clone, Copy, Default)]
struct Holder {
    /// How often it took them.
    generations: u32,
    /// Whether it still has all of them.
    held: bool,
    /// When it took them last.
    taken: u32,
    /// From whom it took them last: a part of [`Memory::predecessors`].
    predecessors: [u32; 2],
}

/// An event that takes memory.
#[derive(Debug, Clone, Copy)]
pub(super) enum MemoryEvent<'t, const Q: usize> {
    /// An image barrier, with the clock of all that comes before it. It makes available only the writes of its own image.
    Barrier(&'t Clock<Q>),
    /// An access to a buffer, on the queue of this number.
    Access(u8, &'t Access),
}

impl Memory {
    pub(super) fn new(plan: &Plan) -> Memory {
        let resources = plan.images.len() + plan.buffers.len();
        let placements = (0..resources as u32).filter_map(|resource| match role(plan, resource) {
            Role::Transient(placement) => Some((resource, placement)),
            Role::Persistent { .. } | Role::External { .. } => None,
        });
        Memory {
            owners: Owners::new(plan.heaps.len(), resources, placements),
            holders: vec![Holder::default(); resources],
            predecessors: Vec::new(),
        }
    }

    /// How often the memory of an image has changed hands.
    pub(super) fn generation(&self, resource: u32) -> u32 {
        self.holders[resource as usize].generations
    }
}

impl<const Q: usize> Walk<'_, '_, Q> {
    /// An image or buffer takes its bytes, unless it has them.
    pub(super) fn alias(&mut self, step: StepId, resource: u32) {
        if self.program.used[resource as usize].outlives {
            return;
        }
        let now = self.now(step);
        let holder = &mut self.memory.holders[resource as usize];
        if std::mem::replace(&mut holder.held, true) {
            return;
        }
        holder.generations += 1;
        holder.taken = now;
        let first = self.memory.predecessors.len();
        self.memory.owners.take(resource, &mut self.memory.predecessors);
        let mut kept = first;
        for at in first..self.memory.predecessors.len() {
            let owner = self.memory.predecessors[at];
            if let Some(last) = self.needs_until(owner, step) {
                self.found.push(Finding {
                    rule: Rule::Overlap { with: name(self.plan, owner).clone() },
                    step,
                    other: Some(StepName::new(self.plan, last, 0)),
                    resource,
                    range: self.first_range(resource),
                    bytes: self.shared_bytes(resource, owner),
                });
            } else {
                self.memory.predecessors[kept] = owner;
                kept += 1;
                self.lose_bytes(owner, resource, now);
            }
        }
        self.memory.predecessors.truncate(kept);
        self.memory.holders[resource as usize].predecessors = [first as u32, kept as u32];
    }

    fn lose_bytes(&mut self, owner: u32, to: u32, now: u32) {
        self.memory.holders[owner as usize].held = false;
        let frame_start = self.frame_start();
        let mut part = self.parts.whole(owner);
        while let Some(index) = self.parts.next(&mut part) {
            let state = &mut self.subresources[index];
            state.layout = crate::vulkan::Layout::Undefined;
            state.contents = match state.contents {
                Contents::Defined if state.filled > frame_start => Contents::Lost(LostContents::Taken(to), now),
                Contents::Defined => Contents::Unwritten,
                lost => lost,
            };
        }
    }

    /// A step accesses a buffer: if it is transient, it may have to take its bytes.
    pub(super) fn alias_buffer(&mut self, step: StepId, queue: u8, access: &Access) {
        let resource = access.resource;
        let before = self.memory.generation(resource);
        self.alias(step, resource);
        let holder = self.memory.holders[resource as usize];
        if holder.generations != before {
            // The accesses before the buffer lost its bytes don't count here: the next owner of the bytes had to wait for them.
            let mut part = self.parts.whole(resource);
            while let Some(index) = self.parts.next(&mut part) {
                let contents = self.subresources[index].contents;
                self.subresources[index] =
                    SubresourceState { contents, owner: self.subresources[index].owner, ..SubresourceState::FRESH };
            }
        }
        if holder.taken == self.now(step) {
            self.check_hand_over(step, resource, None, MemoryEvent::Access(queue, access));
        }
    }

    /// The last step that accesses `resource` in a frame, if `step` lies between its first and its last.
    fn needs_until(&self, resource: u32, step: StepId) -> Option<StepId> {
        let [first, last] = self.program.used[resource as usize].steps()?;
        (first..=last).contains(&step).then_some(last)
    }

    /// Rules 2 and 3 for one part of an image or for a buffer.
    pub(super) fn check_hand_over(
        &mut self,
        step: StepId,
        resource: u32,
        index: Option<usize>,
        taking: MemoryEvent<'_, Q>,
    ) {
        let [first, end] = self.memory.holders[resource as usize].predecessors;
        for at in first..end {
            let from = self.memory.predecessors[at as usize];
            let mut part = self.parts.whole(from);
            let mut missing = None;
            while let (None, Some(index)) = (missing, self.parts.next(&mut part)) {
                let state = &self.subresources[index];
                missing = match taking {
                    MemoryEvent::Barrier(before) => before_layout_change(state, before, PairSet::default()),
                    MemoryEvent::Access(queue, access) => {
                        before_access(state, &self.clocks, queue, access.stages, access.pairs)
                    }
                };
            }
            if let Some(gap) = missing {
                let name = name(self.plan, from).clone();
                let waited = gap.missing != MissingPart::Execution;
                self.found.push(Finding {
                    rule: Rule::HandOver { from: name, earlier: gap.earlier, waited },
                    step,
                    other: self.name_at(gap.time, from),
                    resource,
                    range: index.and_then(|index| self.range(resource, index)),
                    bytes: self.shared_bytes(resource, from),
                });
            }
        }
    }

    fn first_range(&self, resource: u32) -> Option<crate::vulkan::Subresources> {
        let mut part = self.parts.whole(resource);
        self.parts.next(&mut part).and_then(|index| self.range(resource, index))
    }

    fn shared_bytes(&self, one: u32, other: u32) -> Option<[u64; 2]> {
        match (role(self.plan, one), role(self.plan, other)) {
            (Role::Transient(one), Role::Transient(other)) => {
                let end = (one.offset + one.bytes).min(other.offset + other.bytes);
                Some([one.offset.max(other.offset), end])
            }
            _ => None,
        }
    }
}
