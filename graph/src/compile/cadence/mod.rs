//! Passes that don't run in every frame: what they write stays for the frames in which they don't.
//!
//! `check` refuses frames whose readers would find something else where a pass is left out. `keep` gives memory of its own to what is
//! read in other frames than it is written.

mod check;
mod keep;

use super::model::AdaptedFrame;
use crate::frame::Cadence;

pub(super) use check::check;
pub(super) use keep::keep;

impl AdaptedFrame {
    /// In which frames operation number `op` runs.
    pub(super) fn cadence(&self, op: u32) -> &Cadence {
        self.cadences.get(op as usize).unwrap_or(&Cadence::Always)
    }
}
