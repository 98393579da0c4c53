//! Images that change hands: the two halves of queue family ownership transfers, which name the same part.

use super::Queues;
use crate::compile::model::{Adapted, CellIndex, StoreIndex};
use crate::compile::parts::{Grids, join};
use crate::compile::synchronise::Pending;
use crate::plan::{Hazard, ImageBarrier, ImageId, StepId};
use crate::vulkan::{Accesses, Stages};

/// A cell that one queue takes over from another one with its contents.
#[derive(Debug, Clone, Copy)]
pub(in crate::compile) struct HandOff {
    /// The barrier that takes it over.
    pub(in crate::compile) barrier: u32,
    /// The last step that uses it on the queue before.
    pub(in crate::compile) from: u32,
    /// How that queue uses it.
    pub(in crate::compile) stages: Stages,
    pub(in crate::compile) accesses: Accesses,
}

/// Both halves of a transfer, each with its step.
#[derive(Debug)]
pub(in crate::compile) struct Release {
    pub(in crate::compile) from: u32,
    pub(in crate::compile) release: ImageBarrier,
    pub(in crate::compile) to: u32,
    pub(in crate::compile) acquire: ImageBarrier,
}

impl Release {
    /// Lets it be about `other` too, if that differs only in its part of the image.
    fn join(&self, other: &Release) -> Option<Release> {
        let range = join(self.release.range, other.release.range)?;
        let with = |barrier: &ImageBarrier| ImageBarrier { range, ..barrier.clone() };
        let same = (self.from, self.to) == (other.from, other.to)
            && with(&self.release) == with(&other.release)
            && with(&self.acquire) == with(&other.acquire);
        same.then(|| Release { release: with(&self.release), acquire: with(&self.acquire), ..*self })
    }
}

/// All of them, in the order of the steps that take over.
pub(in crate::compile) fn releases(
    grids: &Grids,
    adapted: &Adapted,
    queues: &Queues,
    pending: &[Pending],
) -> Vec<Release> {
    let mut releases: Vec<Release> = Vec::new();
    for hand_off in &queues.hand_offs {
        let mut new = release(grids, adapted, queues, hand_off, &pending[hand_off.barrier as usize]);
        while let Some(joined) = releases.last().and_then(|last| last.join(&new)) {
            new = joined;
            releases.pop();
        }
        releases.push(new);
    }
    releases
}

fn release(grids: &Grids, adapted: &Adapted, queues: &Queues, hand_off: &HandOff, pending: &Pending) -> Release {
    let store: StoreIndex = pending.store;
    let cell: CellIndex = pending.cell;
    let described = &adapted.stores[store as usize];
    let range = match described.grid(grids) {
        None => described.all(),
        Some(grid) => grid.range(cell - described.first_cell),
    };
    let barrier = |after, src: (Stages, Accesses), dst: (Stages, Accesses)| ImageBarrier {
        image: ImageId(described.id),
        range,
        src_stages: src.0,
        src_accesses: src.1,
        dst_stages: dst.0,
        dst_accesses: dst.1,
        old_layout: pending.old_layout,
        new_layout: pending.new_layout,
        ownership: Some([queues.of(hand_off.from), queues.of(pending.step)]),
        hazard: Hazard::Ownership,
        after,
        needed_by: Some(StepId(pending.step)),
    };
    let nothing = (Stages::empty(), Accesses::empty());
    Release {
        from: hand_off.from,
        release: barrier(Some(StepId(hand_off.from)), (hand_off.stages, hand_off.accesses), nothing),
        to: pending.step,
        acquire: barrier(
            Some(StepId(hand_off.from)),
            (pending.src_stages, Accesses::empty()),
            (pending.dst_stages, pending.dst_accesses),
        ),
    }
}
