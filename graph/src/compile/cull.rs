//! `cull`: keeps the passes whose results reach an output, the next frame or a side effect.

use super::link::{self, Linked};
use super::parts::Grids;
use super::validate;
use crate::base::Diagnostic;
use crate::frame::Frame;

/// Which passes stay.
#[derive(Debug)]
pub(super) struct Live {
    /// Indices of the passes that stay, in frame order.
    pub(super) passes: Vec<u32>,
    /// Indices of the passes that go.
    pub(super) culled: Vec<u32>,
}

/// Validates a frame and culls its passes.
pub(super) fn live(frame: &Frame) -> Result<(Grids, Live), Vec<Diagnostic>> {
    validate::check(frame)?;
    let grids = Grids::new(frame);
    let live = cull(frame, &link::link(frame, &grids)?);
    Ok((grids, live))
}

fn cull(frame: &Frame, linked: &Linked) -> Live {
    let mut needed = linked.needed.clone();
    let (mut passes, mut culled) = (Vec::with_capacity(frame.passes.len()), Vec::new());
    for (number, pass) in frame.passes.iter().enumerate().rev() {
        let uses = linked.uses(number);
        let number = number as u32;
        if !uses.iter().any(|used| used.writes() && needed[used.part()]) && !pass.side_effect {
            culled.push(number);
            continue;
        }
        passes.push(number);
        uses.iter().filter(|used| used.writes()).for_each(|used| needed[used.part()] = false);
        uses.iter().filter(|used| used.reads()).for_each(|used| needed[used.part()] = true);
    }
    passes.reverse();
    culled.reverse();
    Live { passes, culled }
}
