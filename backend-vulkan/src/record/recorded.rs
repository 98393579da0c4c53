//! What recording a frame leaves.

use super::recorder::HeldResources;
use super::timing::Counts;
use std::time::Duration;

/// A recorded frame.
#[derive(Default)]
pub(crate) struct Recorded {
    /// By pass.
    pub(crate) counts: Vec<Counts>,
    pub(crate) kept: HeldResources,
    /// How long that took.
    pub(crate) took: Duration,
}

impl Recorded {
    /// Makes it empty for the next frame, which finds the memory of this one. The device must be done with the frame.
    pub(crate) fn clear(&mut self) {
        self.counts.clear();
        self.kept.clear();
    }
}
