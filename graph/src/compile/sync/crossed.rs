//! Crossed cells: those that several queues use.
//!
//! A wait holds up the whole step, and makes all earlier writes visible. So an access after that of another queue takes no
//! barrier, unless the layout changes, or the owner of an exclusive image. An access after one of its own queue takes a
//! barrier, unless a wait says that the earlier one is done.

use super::cell::{CellAccess, CellBarrier, CellState};
use crate::compile::queues::{Crossing, OwnershipTransfer, QUEUES, QueueUse, QueueUses, Queues, Steps};
use crate::plan::Hazard;
use crate::vulkan::{Accesses, Stages};

/// Lets a step wait for the steps of other queues that its accesses come after.
pub(super) fn wait(cells: &[CellState], queues: &mut Queues, accesses: &[CellAccess], step: u32) {
    let mut required = Steps::default();
    for access in accesses {
        if let Some(crossed) = Crossed::of(queues, access, step) {
            crossed.require(queues.uses(access.cell), &cells[access.cell as usize], access, &mut required);
        }
    }
    queues.require(step, required);
}

/// A crossed cell, when one of its queues accesses it.
#[derive(Clone, Copy)]
pub(super) struct Crossed {
    crossing: Crossing,
    queue: usize,
}

impl Crossed {
    /// The cell of an access, if it is crossed.
    pub(super) fn of(queues: &Queues, access: &CellAccess, step: u32) -> Option<Crossed> {
        let crossing = queues.crossing(access.store)?;
        Some(Crossed { crossing, queue: queues.at(step) })
    }

    /// Whether an access is one more read beside the last ones, or behind a write that waits make visible.
    pub(super) fn joins(self, uses: &QueueUses, cell: &CellState, access: &CellAccess) -> bool {
        match self.crossing {
            Crossing::Constant => true,
            Crossing::Buffer | Crossing::Image => cell.is_read_on(access),
            Crossing::Exclusive => cell.is_read_on(access) && !cell.writes() && uses.begun.0 == self.queue,
        }
    }

    /// Adds the steps of other queues that an access comes after.
    fn require(self, uses: &QueueUses, cell: &CellState, access: &CellAccess, required: &mut Steps) {
        let (queue, step) = uses.begun;
        if self.crossing == Crossing::Constant {
            return;
        }
        if !self.joins(uses, cell, access) {
            for (other, used) in uses.by.iter().enumerate().filter(|(other, _)| *other != self.queue) {
                required[other] = required[other].max(used.until);
            }
        } else if uses.by[self.queue].until == 0 {
            required[queue] = required[queue].max(step + 1);
        }
    }

    /// How its own queue used it, unless a wait says that this is done.
    fn own(self, queues: &Queues, access: &CellAccess, step: u32) -> Option<QueueUse> {
        let own = queues.uses(access.cell).by[self.queue];
        Some(own).filter(|own| own.until > queues.known(step)[self.queue])
    }

    /// Whether an access takes an exclusive image over from another queue.
    fn changes_owner(self, uses: &QueueUses, cell: &CellState) -> bool {
        self.crossing == Crossing::Exclusive && cell.is_touched() && uses.begun.0 != self.queue
    }

    /// Whether it takes it over with its contents.
    pub(super) fn transfers(self, uses: &QueueUses, cell: &CellState, access: &CellAccess) -> bool {
        self.changes_owner(uses, cell) && access.keeps
    }

    /// The stages and writes of its own queue that the barrier before an access waits for; `None` if it takes no barrier.
    pub(super) fn source(
        self,
        queues: &Queues,
        cell: &CellState,
        access: &CellAccess,
        step: u32,
    ) -> Option<(Stages, Accesses)> {
        let own = self.own(queues, access, step);
        let changes = access.layout != cell.layout || self.changes_owner(queues.uses(access.cell), cell);
        let changes = changes && self.crossing != Crossing::Buffer;
        (own.is_some() || changes || !cell.is_touched())
            .then(|| own.map_or_else(Default::default, |own| (own.stages, own.accesses.writes())))
    }

    /// Lets the uses of the cell begin anew with an access behind this barrier.
    pub(super) fn renew(
        self,
        queues: &mut Queues,
        cell: &CellState,
        access: &CellAccess,
        (step, lasts): (u32, bool),
        barrier: Option<u32>,
    ) {
        if let Some(barrier) = barrier {
            let uses = *queues.uses(access.cell);
            let elsewhere = (0..QUEUES).any(|other| other != self.queue && uses.by[other].until > 0);
            // A final state is waited for like a step in the next frame.
            if !lasts || cell.is_touched() && (elsewhere || self.own(queues, access, step).is_none()) {
                queues.hold(barrier);
            }
            if self.transfers(&uses, cell, access) {
                let QueueUse { stages, accesses, until, .. } = uses.by[uses.begun.0];
                let from = until.saturating_sub(1);
                queues.transfer(OwnershipTransfer { barrier, from, stages, accesses: accesses.writes() });
            }
        }
        let mut by = [QueueUse::default(); QUEUES];
        by[self.queue] = QueueUse { stages: access.stages, accesses: access.accesses, until: step + 1, barrier };
        *queues.uses_mut(access.cell) = QueueUses { by, begun: (self.queue, step), unread: access.writes() };
    }

    /// Adds a read. The barrier before the earlier reads of its queue serves it, or the queue's wait.
    pub(super) fn join(
        self,
        queues: &mut Queues,
        barriers: &mut Vec<CellBarrier>,
        access: &CellAccess,
        step: u32,
        lasts: bool,
    ) {
        if self.crossing == Crossing::Constant {
            return;
        }
        let (stages, accesses, until) = (access.stages, access.accesses, step + 1);
        let unwaited = self.own(queues, access, step);
        let uses = queues.uses_mut(access.cell);
        let own = &mut uses.by[self.queue];
        if uses.unread && uses.begun.0 == self.queue {
            let barrier = unwaited.map(|written| {
                let source = ((written.stages, written.accesses.writes()), written.until - 1);
                let hazard = Hazard::ReadAfterWrite;
                barriers.push(CellBarrier::before(access, step, source, access.layout, hazard));
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
        if lasts || own.until == 0 {
            own.until = until;
        }
    }
}
