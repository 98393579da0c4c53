//! How far a check of many variants is: a bar on a terminal, anywhere else a line every few seconds.

use crate::system::text;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// How often a line is written.
const EVERY: Duration = Duration::from_secs(5);

/// How far a check is.
pub(super) struct Progress {
    bar: ProgressBar,
    variants: usize,
    begun: Instant,
    checked: AtomicUsize,
    /// Lines that were due so far.
    lines: AtomicU64,
}

impl Progress {
    /// The progress of a check of this number of variants, which begins now.
    pub(super) fn new(variants: usize) -> Progress {
        let bar = ProgressBar::new(variants as u64);
        if let Ok(style) =
            ProgressStyle::with_template("checking {wide_bar} {pos}/{len} variants, {per_sec}, {eta} left")
        {
            bar.set_style(style);
        }
        Progress { bar, variants, begun: Instant::now(), checked: AtomicUsize::new(0), lines: AtomicU64::new(0) }
    }

    /// One more variant was checked.
    pub(super) fn checked_one(&self) {
        let checked = self.checked.fetch_add(1, Ordering::Relaxed) + 1;
        self.bar.inc(1);
        if !self.bar.is_hidden() {
            return;
        }
        let elapsed = self.begun.elapsed();
        let due = elapsed.as_secs() / EVERY.as_secs();
        if self.lines.fetch_max(due, Ordering::Relaxed) < due && checked < self.variants {
            text::say(&line(checked, self.variants, elapsed));
        }
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// How far a check is, how fast, and when it ends if it goes on like this.
#[allow(clippy::cast_precision_loss, reason = "the figures are rounded")]
fn line(checked: usize, variants: usize, elapsed: Duration) -> String {
    let rate = checked as f64 / elapsed.as_secs_f64();
    let left = (variants - checked) as f64 / rate;
    let rate = if rate < 10.0 { format!("{rate:.1}") } else { format!("{rate:.0}") };
    format!("note: checked {checked} of {variants} variants, {rate} a second, {} left", duration(left))
}

/// Seconds in the units that people expect.
fn duration(seconds: f64) -> String {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rounded, and a cast saturates")]
    let seconds = seconds.ceil() as u64;
    match (seconds / 3600, seconds / 60 % 60, seconds % 60) {
        (0, 0, seconds) => format!("{seconds} s"),
        (0, minutes, seconds) => format!("{minutes} min {seconds} s"),
        (hours, minutes, _) => format!("{hours} h {minutes} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_how_many_how_fast_and_how_long_it_goes_on() {
        for (checked, variants, seconds, expected) in [
            (500, 2000, 5, "note: checked 500 of 2000 variants, 100 a second, 15 s left"),
            (4, 1000, 5, "note: checked 4 of 1000 variants, 0.8 a second, 20 min 45 s left"),
            (1000, 1_000_000, 10, "note: checked 1000 of 1000000 variants, 100 a second, 2 h 46 min left"),
        ] {
            assert_eq!(line(checked, variants, Duration::from_secs(seconds)), expected);
        }
    }
}
