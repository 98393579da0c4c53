//! `cull`: keeps the passes whose results reach an output, the next frame or a side effect.

use super::cadence;
use super::link::{self, FrameLinks};
use super::validate;
use crate::base::Diagnostic;
use crate::frame::Frame;
use crate::frame::tracked_parts::{Grids, Parts};

/// Which passes stay.
#[derive(Debug)]
pub(super) struct LivePasses {
    /// Indices of the passes that stay, in frame order.
    pub(super) passes: Vec<u32>,
    /// Indices of the passes that go.
    pub(super) culled: Vec<u32>,
}

/// Validates a frame and culls its passes.
pub(super) fn live(frame: &Frame) -> Result<(Grids, LivePasses), Vec<Diagnostic>> {
    validate::check(frame)?;
    let grids = Grids::new(&frame.images, frame.passes.iter());
    let parts = Parts::new(&frame.images, frame.buffers.len(), &grids);
    let linked = link::link(frame, &parts)?;
    cadence::check(frame, &parts)?;
    debug_assert!(
        frame.passes.iter().any(|pass| !pass.run.is_always())
            || linked.all_are_needed == cull(frame, &parts, &linked).culled.is_empty()
    );
    let live = match linked.all_are_needed {
        true => LivePasses { passes: (0..frame.passes.len() as u32).collect(), culled: Vec::new() },
        false => cull(frame, &parts, &linked),
    };
    Ok((grids, live))
}

fn cull(frame: &Frame, parts: &Parts<'_>, linked: &FrameLinks) -> LivePasses {
    let mut needed = vec![false; parts.len()];
    linked.kept.iter().for_each(|kept| needed[kept.clone()].fill(true));
    let (mut passes, mut culled) = (Vec::with_capacity(frame.passes.len()), Vec::new());
    let (mut read, mut written) = (Vec::new(), Vec::new());
    for (number, pass) in frame.passes.iter().enumerate().rev() {
        let number = number as u32;
        read.clear();
        written.clear();
        parts.for_each_access(pass, |_, part, reads, writes| {
            read.extend(reads.then_some(part as usize));
            written.extend(writes.then_some(part as usize));
        });
        if !written.iter().any(|part| needed[*part]) && !pass.side_effect {
            culled.push(number);
            continue;
        }
        passes.push(number);
        // In other frames what was there before is needed.
        if pass.run.is_always() {
            written.iter().for_each(|part| needed[*part] = false);
        }
        read.iter().for_each(|part| needed[*part] = true);
    }
    passes.reverse();
    culled.reverse();
    LivePasses { passes, culled }
}
