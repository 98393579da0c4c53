//! Sums over a Plan.

use super::{Cause, Pass, Resource, Step, Work};
use serde::{Deserialize, Serialize};

/// Sums over a Plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Totals {
    /// Passes that the file says and the Plan runs.
    pub passes: u32,
    /// Passes that the compiler inserted.
    pub inserted_passes: u32,
    /// Rendering scopes.
    pub scopes: u32,
    /// Resolves, folded into a scope and standalone.
    pub resolves: u32,
    /// Resolves folded into a scope.
    pub folded_resolves: u32,
    /// Copies and blits.
    pub copies: u32,
    /// Fills.
    pub fills: u32,
    /// Waits for other queues.
    pub waits: u32,
    /// Calls of `vkCmdPipelineBarrier2`. Up to three per step: memory barriers and image barriers before its work, releases after it.
    /// One more for each image or buffer that an outside owner gives or gets. Local barriers of passes are not counted.
    pub barrier_calls: u32,
    /// Image barriers, released ones and those of outside owners too.
    pub image_barriers: u32,
    /// Memory barriers, and buffer barriers of outside owners.
    pub memory_barriers: u32,
    /// Bytes of all transient images and buffers, if each had memory of its own.
    pub transient_bytes: u64,
    /// Bytes of the heaps.
    pub placed_bytes: u64,
    /// Largest total of transient images and buffers alive at one step: no placement can need less.
    pub live_peak_bytes: u64,
    /// Bytes of images and buffers that outlive the frame.
    pub kept_bytes: u64,
}

impl Totals {
    /// Everything that the steps alone tell. Bytes are left at 0: they take images, heaps and memory needs.
    #[must_use]
    pub fn count(steps: &[Step]) -> Totals {
        let mut totals = Totals::default();
        steps.iter().for_each(|step| totals.add(step));
        totals
    }

    /// Counts one more step.
    pub(crate) fn add(&mut self, step: &Step) {
        self.barriers(step);
        match &step.work {
            Work::Render(scope) => {
                self.scopes += 1;
                scope.passes.iter().for_each(|pass| self.pass(pass));
                let folded = scope.attachments.iter().filter(|target| target.resolve.is_some()).count();
                self.folded_resolves += length(folded);
                self.resolves += length(folded);
            }
            Work::Dispatch(pass) | Work::Custom(pass) => self.pass(pass),
            Work::Resolve(_) => self.resolves += 1,
            Work::Copy(transfer) | Work::Blit(transfer) => {
                self.copies += 1;
                self.passes += u32::from(transfer.name.is_some());
            }
            Work::Fill(fill) => {
                self.fills += 1;
                self.passes += u32::from(fill.name.is_some());
            }
            Work::Export => {}
        }
    }

    fn barriers(&mut self, step: &Step) {
        self.waits += length(step.waits.len());
        self.image_barriers += length(step.image_barriers.len() + step.releases.len());
        self.memory_barriers += length(step.memory_barriers.len());
        for transfer in &step.outside {
            match transfer.resource {
                Resource::Image(_) => self.image_barriers += 1,
                Resource::Buffer(_) => self.memory_barriers += 1,
            }
        }
        let calls = [step.memory_barriers.is_empty(), step.image_barriers.is_empty(), step.releases.is_empty()];
        self.barrier_calls += length(calls.iter().filter(|empty| !**empty).count() + step.outside.len());
    }

    fn pass(&mut self, pass: &Pass) {
        match pass.cause {
            Cause::Written(_) => self.passes += 1,
            Cause::Inserted(_) => self.inserted_passes += 1,
        }
    }
}

/// Lists as long as 2³² don't fit into memory.
fn length(entries: usize) -> u32 {
    u32::try_from(entries).unwrap_or(u32::MAX)
}
