//! Crossed subresources: those that several queues use.
//!
//! A wait holds up the whole step, and makes all earlier writes visible. So an access after that of another queue takes no
//! barrier, unless the layout changes, or the owner of an exclusive image. An access after one of its own queue takes a
//! barrier, unless a wait says that the earlier one is done.

use super::subresource::{SubresourceAccess, SubresourceBarrier, SubresourceState};
use crate::compile::queues::{Crossing, OwnershipTransfer, QUEUES, QueueUse, QueueUses, Queues, Steps};
use crate::plan::Hazard;
use crate::vulkan::{Accesses, Stages};

/// Lets a step wait for the steps of other queues that its accesses come after.
pub(super) fn wait(subresources: &[SubresourceState], queues: &mut Queues, accesses: &[SubresourceAccess], step: u32) {
    let mut required = Steps::default();
    for access in accesses {
        if let Some(crossed) = CrossedSubresource::of(queues, access, step) {
            crossed.require(
                queues.uses(access.subresource),
                &subresources[access.subresource as usize],
                access,
                &mut required,
            );
        }
    }
    queues.require(step, required);
}

/// A crossed subresource, when one of its queues accesses it.
#[derive(Clone, Copy)]
pub(super) struct CrossedSubresource {
    crossing: Crossing,
    queue: usize,
}

impl CrossedSubresource {
    /// The subresource of an access, if it is crossed.
    pub(super) fn of(queues: &Queues, access: &SubresourceAccess, step: u32) -> Option<CrossedSubresource> {
        let crossing = queues.crossing(access.resource)?;
        Some(CrossedSubresource { crossing, queue: queues.queue_number(step) })
    }

    /// Whether an access is one more read beside the last ones, or behind a write that waits make visible.
    pub(super) fn joins(self, uses: &QueueUses, state: &SubresourceState, access: &SubresourceAccess) -> bool {
        match self.crossing {
            Crossing::Constant => true,
            Crossing::Buffer | Crossing::Image => state.has_layout_for_read(access),
            Crossing::Exclusive => state.has_layout_for_read(access) && !state.writes() && uses.begun.0 == self.queue,
        }
    }

    /// Adds the steps of other queues that an access comes after.
    fn require(self, uses: &QueueUses, state: &SubresourceState, access: &SubresourceAccess, required: &mut Steps) {
        let (queue, step) = uses.begun;
        if self.crossing == Crossing::Constant {
            return;
        }
        if !self.joins(uses, state, access) {
            for (other, used) in uses.by.iter().enumerate().filter(|(other, _)| *other != self.queue) {
                required[other] = required[other].max(used.until);
            }
        } else if uses.by[self.queue].until == 0 {
            required[queue] = required[queue].max(step + 1);
        }
    }

    /// How its own queue used it, unless a wait says that this is done.
    fn own(self, queues: &Queues, access: &SubresourceAccess, step: u32) -> Option<QueueUse> {
        let own = queues.uses(access.subresource).by[self.queue];
        Some(own).filter(|own| own.until > queues.known(step)[self.queue])
    }

    /// Whether an access takes an exclusive image over from another queue.
    fn changes_owner(self, uses: &QueueUses, state: &SubresourceState) -> bool {
        self.crossing == Crossing::Exclusive && state.is_used() && uses.begun.0 != self.queue
    }

    /// Whether it takes it over with its contents.
    pub(super) fn transfers(self, uses: &QueueUses, state: &SubresourceState, access: &SubresourceAccess) -> bool {
        self.changes_owner(uses, state) && access.keeps
    }

    /// The stages and writes of its own queue that the barrier before an access waits for; `None` if it takes no barrier.
    pub(super) fn source(
        self,
        queues: &Queues,
        state: &SubresourceState,
        access: &SubresourceAccess,
        step: u32,
    ) -> Option<(Stages, Accesses)> {
        let own = self.own(queues, access, step);
        let changes = access.layout != state.layout || self.changes_owner(queues.uses(access.subresource), state);
        let changes = changes && self.crossing != Crossing::Buffer;
        (own.is_some() || changes || !state.is_used())
            .then(|| own.map_or_else(Default::default, |own| (own.stages, own.accesses.writes())))
    }

    /// Lets the uses of the subresource begin anew with an access behind this barrier.
    pub(super) fn renew(
        self,
        queues: &mut Queues,
        state: &SubresourceState,
        access: &SubresourceAccess,
        (step, is_own_step): (u32, bool),
        barrier: Option<u32>,
    ) {
        if let Some(barrier) = barrier {
            let uses = *queues.uses(access.subresource);
            let elsewhere = (0..QUEUES).any(|other| other != self.queue && uses.by[other].until > 0);
            // A final state is waited for like a step in the next frame.
            if !is_own_step || state.is_used() && (elsewhere || self.own(queues, access, step).is_none()) {
                queues.hold(barrier);
            }
            if self.transfers(&uses, state, access) {
                let QueueUse { stages, accesses, until, .. } = uses.by[uses.begun.0];
                let from = until.saturating_sub(1);
                queues.transfer(OwnershipTransfer { barrier, from, stages, accesses: accesses.writes() });
            }
        }
        let mut by = [QueueUse::default(); QUEUES];
        by[self.queue] = QueueUse { stages: access.stages, accesses: access.accesses, until: step + 1, barrier };
        *queues.uses_mut(access.subresource) = QueueUses { by, begun: (self.queue, step), unread: access.writes() };
    }

    /// Adds a read. The barrier before the earlier reads of its queue serves it, or the queue's wait.
    pub(super) fn join(
        self,
        queues: &mut Queues,
        barriers: &mut Vec<SubresourceBarrier>,
        access: &SubresourceAccess,
        step: u32,
        is_own_step: bool,
    ) {
        if self.crossing == Crossing::Constant {
            return;
        }
        let (stages, accesses, until) = (access.stages, access.accesses, step + 1);
        let unwaited = self.own(queues, access, step);
        let uses = queues.uses_mut(access.subresource);
        let own = &mut uses.by[self.queue];
        if uses.unread && uses.begun.0 == self.queue {
            let barrier = unwaited.map(|written| {
                let source = ((written.stages, written.accesses.writes()), written.until - 1);
                let hazard = Hazard::ReadAfterWrite;
                barriers.push(SubresourceBarrier::before(access, step, source, access.layout, hazard));
                barriers.len() as u32 - 1
            });
            *own = QueueUse { stages, accesses, until, barrier };
            uses.unread = false;
            return;
        }
        if let Some(barrier) = own.barrier.and_then(|barrier| barriers.get_mut(barrier as usize)) {
            barrier.widen(stages, accesses);
        }
        own.stages |= stages;
        own.accesses |= accesses;
        // The step behind all others is there only for barriers and waits.
        if is_own_step || own.until == 0 {
            own.until = until;
        }
    }
}
