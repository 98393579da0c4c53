//! What was recorded for a frame.

use super::frame_resources::HeldResources;
use std::time::{Duration, Instant};

/// A recorded frame.
#[derive(Default)]
pub(crate) struct RecordedFrame {
    /// By pass.
    pub(crate) counts: Vec<Counts>,
    /// The steps that were left out.
    pub(super) left_out: Vec<usize>,
    pub(super) kept: HeldResources,
    /// By pass of the scope that is recorded: whether its draws come in secondary command buffers.
    pub(super) secondary: Vec<bool>,
    /// When that began.
    pub(crate) began: Option<Instant>,
    /// How long it took.
    pub(crate) took: Duration,
}

impl RecordedFrame {
    /// Begins another frame, which finds the memory of this one. The device must be done with the frame.
    pub(crate) fn begin(&mut self) {
        self.counts.clear();
        self.left_out.clear();
        self.kept.begin();
    }

    /// Ends the frame, which was begun then.
    pub(crate) fn end(&mut self, began: Instant) {
        self.kept.end();
        (self.began, self.took) = (Some(began), began.elapsed());
    }
}

/// Draws and culled objects that were recorded for a pass.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counts {
    /// As in [`super::PassReport`].
    pub(crate) draws: u32,
    /// As in [`super::PassReport`].
    pub(crate) culled: u32,
}
