//! How far work on many things is: a bar on a terminal, anywhere else a line every so often.

use crate::system::text;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Work on many things, in words.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Words {
    /// Such as `checking`.
    pub(crate) doing: &'static str,
    /// Such as `checked`.
    pub(crate) done: &'static str,
    /// Such as `variants`.
    pub(crate) things: &'static str,
}

/// How far work is.
pub(crate) struct Progress {
    bar: ProgressBar,
    words: Words,
    /// How often a line is written.
    every: Duration,
    things: usize,
    begun: Instant,
    done: AtomicUsize,
    /// Lines that were due so far.
    lines: AtomicU64,
}

impl Progress {
    /// The progress of work on this number of things, which begins now.
    pub(crate) fn new(things: usize, words: Words, every: Duration) -> Progress {
        let bar = ProgressBar::new(things as u64);
        let template =
            format!("{} {{wide_bar}} {{pos}}/{{len}} {}, {{per_sec}}, {{eta}} left", words.doing, words.things);
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        let (done, lines) = (AtomicUsize::new(0), AtomicU64::new(0));
        Progress { bar, words, every, things, begun: Instant::now(), done, lines }
    }

    /// One more is done.
    pub(crate) fn done_one(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.bar.inc(1);
        if !self.bar.is_hidden() {
            return;
        }
        let elapsed = self.begun.elapsed();
        let due = elapsed.as_secs() / self.every.as_secs();
        if self.lines.fetch_max(due, Ordering::Relaxed) < due && done < self.things {
            text::say(&line(self.words, done, self.things, elapsed));
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// How far work is, how fast, and when it ends if it goes on like this.
#[allow(clippy::cast_precision_loss, reason = "the figures are rounded")]
fn line(words: Words, done: usize, things: usize, elapsed: Duration) -> String {
    let rate = done as f64 / elapsed.as_secs_f64();
    let left = (things - done) as f64 / rate;
    let rate = if rate < 10.0 { format!("{rate:.1}") } else { format!("{rate:.0}") };
    format!("note: {} {done} of {things} {}, {rate} a second, {} left", words.done, words.things, duration(left))
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
        let words = Words { doing: "checking", done: "checked", things: "variants" };
        for (checked, variants, seconds, expected) in [
            (500, 2000, 5, "note: checked 500 of 2000 variants, 100 a second, 15 s left"),
            (4, 1000, 5, "note: checked 4 of 1000 variants, 0.8 a second, 20 min 45 s left"),
            (1000, 1_000_000, 10, "note: checked 1000 of 1000000 variants, 100 a second, 2 h 46 min left"),
        ] {
            assert_eq!(line(words, checked, variants, Duration::from_secs(seconds)), expected);
        }
    }
}
