//! The queue of each step, and the waits between queues.

use super::clocks::{Clocks, EarlierStep};
use super::crossing::{Crossing, LayoutChange, OwnershipTransfer, QueueUses};
use super::number::Steps;
use crate::compile::model::{PhysicalIndex, SubresourceIndex};
use crate::compile::steps::of_step;
use crate::plan::{Queue, Wait};

/// The queue of each step, and what queues know of each other. By default all steps are on graphics.
#[derive(Debug, Clone, Default)]
pub(in crate::compile) struct Queues {
    /// The queue of each step; a step behind all of these is on graphics. Empty if all are.
    of: Vec<Queue>,
    /// For each physical resource how several queues share it, if they do, within a frame or from frame to frame.
    crossings: Vec<Option<Crossing>>,
    /// Steps that only change layouts, each with what they change, in order.
    changes: Vec<(u32, LayoutChange)>,
    clocks: Clocks,
    /// For each subresource how the queues use it, if it is crossed.
    uses: Vec<QueueUses>,
    /// For each barrier whether it must stand directly before its step.
    held: Vec<bool>,
    transfers: Vec<OwnershipTransfer>,
    /// Steps that come after steps of earlier frames.
    earlier: Vec<EarlierStep>,
}

impl Queues {
    /// Several queues.
    pub(super) fn new(
        of: Vec<Queue>,
        crossings: Vec<Option<Crossing>>,
        changes: Vec<(u32, LayoutChange)>,
        subresources: u32,
    ) -> Queues {
        let clocks = Clocks::new(of.len() as u32 + 1);
        Queues {
            of,
            crossings,
            changes,
            clocks,
            uses: vec![QueueUses::default(); subresources as usize],
            ..Queues::default()
        }
    }

    /// Whether all steps are on graphics.
    pub(in crate::compile) fn is_one(&self) -> bool {
        self.of.is_empty()
    }

    /// The queue of a step.
    pub(in crate::compile) fn queue(&self, step: u32) -> Queue {
        self.of.get(step as usize).copied().unwrap_or(Queue::Graphics)
    }

    /// The number of the queue of a step.
    pub(in crate::compile) fn queue_number(&self, step: u32) -> usize {
        self.queue(step) as usize
    }

    /// How several queues share a physical resource; `None` if only one uses it.
    pub(in crate::compile) fn crossing(&self, resource: PhysicalIndex) -> Option<Crossing> {
        self.crossings.get(resource as usize).copied().flatten()
    }

    /// Whether several queues use a physical resource.
    pub(in crate::compile) fn is_crossed(&self, resource: PhysicalIndex) -> bool {
        self.crossing(resource).is_some()
    }

    /// The changes of layout of a step that does nothing else.
    pub(in crate::compile) fn changes(&self, step: u32) -> &[(u32, LayoutChange)] {
        of_step(&self.changes, step, |(at, _)| *at)
    }

    /// How the queues use a crossed subresource.
    pub(in crate::compile) fn uses(&self, subresource: SubresourceIndex) -> &QueueUses {
        &self.uses[subresource as usize]
    }

    pub(in crate::compile) fn uses_mut(&mut self, subresource: SubresourceIndex) -> &mut QueueUses {
        &mut self.uses[subresource as usize]
    }

    /// Lets a step wait for these steps of other queues, as far as its queue doesn't know them to be done.
    pub(in crate::compile) fn require(&mut self, step: u32, required: Steps) {
        let queue = self.queue_number(step);
        self.clocks.require(step, queue, required);
    }

    /// The steps that are known to be done when a step begins, on its own queue too.
    pub(in crate::compile) fn known(&self, step: u32) -> Steps {
        self.clocks.known(step)
    }

    /// The steps that are known to be done after a wait for `step`.
    pub(in crate::compile) fn signal(&self, step: u32) -> Steps {
        self.clocks.signal(step)
    }

    /// Lets a barrier stand directly before its step, behind that step's waits.
    pub(in crate::compile) fn hold(&mut self, barrier: u32) {
        let least = barrier as usize + 1;
        if self.held.len() < least {
            self.held.resize(least, false);
        }
        self.held[barrier as usize] = true;
    }

    /// Whether a barrier must stand directly before its step.
    pub(in crate::compile) fn is_held(&self, barrier: u32) -> bool {
        self.held.get(barrier as usize).copied().unwrap_or(false)
    }

    /// Notes an ownership transfer.
    pub(in crate::compile) fn transfer(&mut self, transfer: OwnershipTransfer) {
        self.transfers.push(transfer);
    }

    /// All ownership transfers, in the order of the steps that acquire.
    pub(in crate::compile) fn transfers(&self) -> &[OwnershipTransfer] {
        &self.transfers
    }

    /// Lets a step come after step `of` on queue number `queue`, that many frames ago.
    pub(in crate::compile) fn require_earlier(&mut self, step: u32, queue: usize, of: u32, frames_ago: u32) {
        self.earlier.push(EarlierStep { frames_ago, step, queue, of });
    }

    /// Adds the waits for steps of earlier frames.
    pub(in crate::compile) fn wait_for_earlier_frames(&mut self) {
        let steps = self.of.len() as u32;
        if self.clocks.len() <= steps {
            self.require(steps, Steps::default());
        }
        self.earlier.sort_unstable();
        let queues: Vec<usize> = (0..=steps).map(|step| self.queue_number(step)).collect();
        let earlier = std::mem::take(&mut self.earlier);
        for same in earlier.chunk_by(|one, other| one.frames_ago == other.frames_ago) {
            // Within a frame, memory spans keep the owners of memory apart.
            if same[0].frames_ago > 0 {
                self.clocks.require_earlier(&queues, same);
            }
        }
    }

    /// The waits of a step.
    pub(in crate::compile) fn waits(&self, step: u32) -> Vec<Wait> {
        if self.is_one() { Vec::new() } else { self.clocks.waits(step) }
    }
}
