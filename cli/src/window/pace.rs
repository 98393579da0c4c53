//! How fast frames are shown.

use std::time::{Duration, Instant};

/// It is told this often.
const TOLD: Duration = Duration::from_millis(500);

/// Counts frames and their times.
pub(super) struct Pace {
    since: Instant,
    frames: u32,
    /// The time of the last frame that is done.
    milliseconds: f64,
}

/// How fast frames were shown lately.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Speed {
    /// Time of a frame on the device.
    pub(super) milliseconds: f64,
    /// Frames in a second.
    pub(super) each_second: f64,
}

impl Pace {
    pub(super) fn new() -> Pace {
        Pace { since: Instant::now(), frames: 0, milliseconds: 0.0 }
    }

    /// A frame was shown.
    pub(super) fn count(&mut self) {
        self.frames += 1;
    }

    /// The device took so long for a frame.
    pub(super) fn took(&mut self, milliseconds: f64) {
        self.milliseconds = milliseconds;
    }

    /// The speed since it was told last, if it is time to tell it again.
    pub(super) fn told(&mut self) -> Option<Speed> {
        let elapsed = self.since.elapsed();
        if elapsed < TOLD {
            return None;
        }
        let each_second = f64::from(self.frames) / elapsed.as_secs_f64();
        (self.since, self.frames) = (Instant::now(), 0);
        Some(Speed { milliseconds: self.milliseconds, each_second })
    }
}
