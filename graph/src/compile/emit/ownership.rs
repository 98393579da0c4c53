//! Queue family ownership transfers: their two halves, release and acquire, name the same subresources.

use super::stage_results::StageResults;
use crate::compile::queues::OwnershipTransfer;
use crate::frame::tracked_parts::join;
use crate::plan::{Hazard, ImageBarrier, ImageId, StepId};
use crate::vulkan::{Accesses, Stages};

/// Both halves of a transfer, each with its step.
#[derive(Debug)]
pub(super) struct Transfer {
    pub(super) from: u32,
    pub(super) release: ImageBarrier,
    pub(super) to: u32,
    pub(super) acquire: ImageBarrier,
}

impl Transfer {
    /// Joins it with another one that differs only in its subresources.
    fn join(&self, other: &Transfer) -> Option<Transfer> {
        let range = join(self.release.range, other.release.range)?;
        let with = |barrier: &ImageBarrier| ImageBarrier { range, ..barrier.clone() };
        let same = (self.from, self.to) == (other.from, other.to)
            && with(&self.release) == with(&other.release)
            && with(&self.acquire) == with(&other.acquire);
        same.then(|| Transfer { release: with(&self.release), acquire: with(&self.acquire), ..*self })
    }
}

/// All ownership transfers, in the order of the steps that acquire.
pub(super) fn transfers(results: &StageResults<'_>) -> Vec<Transfer> {
    let mut transfers: Vec<Transfer> = Vec::new();
    for of_subresource in results.sync.queues.transfers() {
        let mut new = transfer(results, of_subresource);
        while let Some(joined) = transfers.last().and_then(|last| last.join(&new)) {
            new = joined;
            transfers.pop();
        }
        transfers.push(new);
    }
    transfers
}

fn transfer(results: &StageResults<'_>, of_subresource: &OwnershipTransfer) -> Transfer {
    let (queues, acquiring) = (&results.sync.queues, &results.sync.barriers[of_subresource.barrier as usize]);
    let image = ImageId(results.adapted.resources[acquiring.resource as usize].id);
    let range = results.subresources(acquiring.resource, acquiring.subresource);
    let barrier = |after, src: (Stages, Accesses), dst: (Stages, Accesses)| ImageBarrier {
        image,
        range,
        src_stages: src.0,
        src_accesses: src.1,
        dst_stages: dst.0,
        dst_accesses: dst.1,
        old_layout: acquiring.old_layout,
        new_layout: acquiring.new_layout,
        ownership: Some([queues.queue(of_subresource.from), queues.queue(acquiring.step)]),
        hazard: Hazard::Ownership,
        after,
        needed_by: Some(StepId(acquiring.step)),
    };
    let nothing = (Stages::empty(), Accesses::empty());
    Transfer {
        from: of_subresource.from,
        release: barrier(Some(StepId(of_subresource.from)), (of_subresource.stages, of_subresource.accesses), nothing),
        to: acquiring.step,
        acquire: barrier(
            Some(StepId(of_subresource.from)),
            (acquiring.src_stages, Accesses::empty()),
            (acquiring.dst_stages, acquiring.dst_accesses),
        ),
    }
}
