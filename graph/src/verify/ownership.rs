//! Which queue may use an image or buffer that only one at a time may use.
//!
//! The first queue that uses it owns it. A barrier from `UNDEFINED` makes any queue its owner, since nothing is handed
//! over. Contents go to another queue by two barriers with the same queues, range and layouts: one among the releases of
//! a step on the first queue, one among the barriers of a step on the second; in between no queue may use it. In the first
//! frame a persistent resource belongs to no queue yet, and can be acquired without a release. Buffers are never handed over.

use super::program::Barrier;
use super::subresources::{Owner, SubresourceState};
use super::violation::{OwnershipFault, Rule};
use super::walk::Walk;
use crate::plan::{Queue, StepId};
use crate::vulkan::Layout;

impl<const Q: usize> Walk<'_, '_, Q> {
    /// A step on `queue` uses a part.
    pub(super) fn use_on(&mut self, step: StepId, queue: u8, resource: u32, index: usize) {
        if !self.program.used[resource as usize].exclusive {
            return;
        }
        let fault = match std::mem::replace(&mut self.subresources[index].owner, Owner::Queue(queue)) {
            Owner::Anyone => return,
            Owner::Queue(owner) if owner == queue => return,
            Owner::Queue(owner) => OwnershipFault::Elsewhere { owner: named(owner), user: named(queue) },
            Owner::Released(barrier) => OwnershipFault::NotAcquired { released: self.queues(barrier) },
        };
        self.report_owner(step, resource, index, fault);
    }

    /// A barrier before the work of a step concerns a part; whether it is the second half of a transfer.
    pub(super) fn own_by_barrier(
        &mut self,
        step: StepId,
        queue: u8,
        barrier: &Barrier,
        number: u32,
        index: usize,
    ) -> bool {
        let image = barrier.image;
        let owner = self.subresources[index].owner;
        let owned = Owner::Queue(barrier.ownership.map_or(queue, |[_, to]| to));
        let fault = match (barrier.ownership, owner) {
            (None, Owner::Released(release)) if barrier.old == Layout::Undefined => {
                OwnershipFault::NeverAcquired { released: self.queues(release) }
            }
            (None, _) if barrier.old == Layout::Undefined => {
                self.subresources[index].owner = owned;
                return false;
            }
            (None, _) => {
                self.use_on(step, queue, image, index);
                return false;
            }
            (Some(_), Owner::Released(release))
                if self.is_other_half(&self.program.barriers[release as usize], barrier) =>
            {
                self.subresources[index].owner = owned;
                return true;
            }
            (Some(_), Owner::Anyone) if self.frame == 0 => {
                // The owner before the first frame has released it, in the layout in which the frame finds it.
                let state = &mut self.subresources[index];
                *state = SubresourceState {
                    owner: owned,
                    layout: state.layout,
                    contents: state.contents,
                    ..SubresourceState::FRESH
                };
                return false;
            }
            (Some(_), Owner::Released(release)) => {
                OwnershipFault::Unequal { released: self.queues(release), acquired: self.queues(number) }
            }
            (Some(_), _) => OwnershipFault::NotReleased { acquired: self.queues(number) },
        };
        self.subresources[index].owner = owned;
        self.report_owner(step, image, index, fault);
        // Its layouts are those of the other half, or wrong for the reason that was just given.
        barrier.ownership.is_some()
    }

    /// Reports a release without acquire at the end of the frame. Not for resources that go on to the next frame.
    pub(super) fn check_acquired(&mut self, step: StepId, resource: u32, index: usize) {
        if let Owner::Released(barrier) = self.subresources[index].owner {
            let fault = OwnershipFault::NeverAcquired { released: self.queues(barrier) };
            self.report_owner(step, resource, index, fault);
        }
    }

    /// Whether `acquire` matches `release`. Images that become each other pass on a release: only their numbers may differ.
    fn is_other_half(&self, release: &Barrier, acquire: &Barrier) -> bool {
        let range = |barrier: &Barrier| self.program.ranges.get(barrier.range);
        (release.ownership, release.old, release.new) == (acquire.ownership, acquire.old, acquire.new)
            && range(release) == range(acquire)
    }

    fn queues(&self, barrier: u32) -> [Queue; 2] {
        self.program.barriers[barrier as usize].ownership.map_or([Queue::Graphics; 2], |queues| queues.map(named))
    }

    fn report_owner(&mut self, step: StepId, resource: u32, index: usize, fault: OwnershipFault) {
        let last = self.subresources[index].last();
        self.subresources[index].excused = true;
        self.report(step, resource, index, Rule::Ownership { fault }, last);
    }
}

/// The queue with a number.
fn named(queue: u8) -> Queue {
    match queue {
        0 => Queue::Graphics,
        1 => Queue::Compute,
        _ => Queue::Transfer,
    }
}
