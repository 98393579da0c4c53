//! How far work on many things is: a bar on a terminal, anywhere else a line every so often.

use crate::system::text;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::JoinHandle;
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

/// How far work is. While it goes on, a thread of its own writes lines, however long a single thing takes.
pub(crate) struct Progress {
    bar: ProgressBar,
    work: Arc<Work>,
    /// Ends the lines as soon as it is dropped.
    lines: Option<(Sender<()>, JoinHandle<()>)>,
}

/// Work that goes on.
struct Work {
    words: Words,
    things: usize,
    /// Steps of each thing before it is done.
    steps: usize,
    begun: Instant,
    done: AtomicUsize,
    /// Steps that are done, of all things.
    steps_done: AtomicUsize,
    /// Thousandths of the present thing that are done, where one thing is worked on at a time.
    thousandths: AtomicUsize,
}

impl Progress {
    /// The progress of work on this number of things, which begins now. Each has some steps before it is done.
    pub(crate) fn new(things: usize, steps: usize, words: Words, every: Duration) -> Progress {
        let bar = ProgressBar::new(things as u64);
        let template =
            format!("{} {{wide_bar}} {{pos}}/{{len}} {}, {{per_sec}}, {{eta}} left", words.doing, words.things);
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        let work = Arc::new(Work::begun(things, steps, words));
        let lines = bar.is_hidden().then(|| written(&work, every, text::say));
        Progress { bar, work, lines }
    }

    /// One more step of a thing is done.
    pub(crate) fn step(&self) {
        self.work.steps_done.fetch_add(1, Ordering::Relaxed);
    }

    /// Tells how far the present thing is: `part` of `of`.
    pub(crate) fn within(&self, part: usize, of: usize) {
        self.work.thousandths.store(1000 * part / of.max(1), Ordering::Relaxed);
    }

    /// One more thing is done.
    pub(crate) fn done_one(&self) {
        self.work.thousandths.store(0, Ordering::Relaxed);
        self.work.done.fetch_add(1, Ordering::Relaxed);
        self.bar.inc(1);
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((end, thread)) = self.lines.take() {
            drop(end);
            drop(thread.join());
        }
    }
}

/// Writes a line every so often, until the sender is dropped.
fn written(work: &Arc<Work>, every: Duration, say: impl Fn(&str) + Send + 'static) -> (Sender<()>, JoinHandle<()>) {
    let (end, ended) = mpsc::channel::<()>();
    let work = Arc::clone(work);
    let lines = std::thread::spawn(move || {
        while ended.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
            if work.done.load(Ordering::Relaxed) < work.things {
                say(&work.line(work.begun.elapsed()));
            }
        }
    });
    (end, lines)
}

impl Work {
    fn begun(things: usize, steps: usize, words: Words) -> Work {
        let [done, steps_done, thousandths] = [0; 3].map(AtomicUsize::new);
        Work { words, things, steps, begun: Instant::now(), done, steps_done, thousandths }
    }

    /// How far it is, how fast, and when it ends if it goes on like this.
    #[allow(clippy::cast_precision_loss, reason = "the figures are rounded")]
    fn line(&self, elapsed: Duration) -> String {
        let Work { words, things, steps, .. } = self;
        let done = self.done.load(Ordering::Relaxed);
        // A thing that is done is one more step.
        let steps_done = self.steps_done.load(Ordering::Relaxed) + done;
        let begun = self.thousandths.load(Ordering::Relaxed) as f64 / 1000.0;
        let part = (steps_done as f64 + begun) / (things * (steps + 1)) as f64;
        let so_far = format!("note: {} {done} of {things} {}", words.done, words.things);
        if part == 0.0 {
            return so_far;
        }
        let left = duration(elapsed.as_secs_f64() * (1.0 - part) / part);
        let rate = done as f64 / elapsed.as_secs_f64();
        if *steps > 0 || rate < 0.1 {
            return format!("{so_far}, {:.0} % of all work, {left} left", 100.0 * part);
        }
        let rate = if rate < 10.0 { format!("{rate:.1}") } else { format!("{rate:.0}") };
        format!("{so_far}, {rate} a second, {left} left")
    }
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

    fn work(steps: usize, things: usize, [steps_done, done]: [usize; 2]) -> Work {
        let words = Words { doing: "checking", done: "checked", things: "variants" };
        let [done, steps_done] = [done, steps_done].map(AtomicUsize::new);
        Work { done, steps_done, ..Work::begun(things, steps, words) }
    }

    #[test]
    fn a_line_says_how_many_how_fast_and_how_long_it_goes_on() {
        for (checked, variants, seconds, expected) in [
            (0, 2000, 5, "note: checked 0 of 2000 variants"),
            (500, 2000, 5, "note: checked 500 of 2000 variants, 100 a second, 15 s left"),
            (4, 1000, 5, "note: checked 4 of 1000 variants, 0.8 a second, 20 min 45 s left"),
            (1000, 1_000_000, 10, "note: checked 1000 of 1000000 variants, 100 a second, 2 h 46 min left"),
        ] {
            assert_eq!(work(0, variants, [0, checked]).line(Duration::from_secs(seconds)), expected);
        }
    }

    #[test]
    fn steps_count_before_anything_is_done() {
        let line = |done| work(9, 8, done).line(Duration::from_secs(60));
        assert_eq!(line([20, 0]), "note: checked 0 of 8 variants, 25 % of all work, 3 min 0 s left");
        assert_eq!(line([36, 4]), "note: checked 4 of 8 variants, 50 % of all work, 1 min 0 s left");
    }

    #[test]
    fn a_part_of_a_thing_counts_until_the_thing_is_done() {
        let progress = Progress::new(4, 0, work(0, 4, [0, 0]).words, Duration::from_secs(3600));
        let line = || progress.work.line(Duration::from_secs(60));
        progress.within(8, 16);
        assert_eq!(line(), "note: checked 0 of 4 variants, 12 % of all work, 7 min 0 s left");
        progress.done_one();
        assert_eq!(line(), "note: checked 1 of 4 variants, 25 % of all work, 3 min 0 s left");
    }

    #[test]
    fn lines_are_written_while_a_single_thing_takes_long() {
        let (sender, said) = mpsc::channel();
        let say = move |line: &str| drop(sender.send(line.to_owned()));
        let (end, lines) = written(&Arc::new(work(9, 8, [0, 0])), Duration::from_millis(1), say);
        let line = said.recv_timeout(Duration::from_secs(60));
        assert_eq!(line.as_deref(), Ok("note: checked 0 of 8 variants"));
        drop(end);
        lines.join().expect("it ends");
    }
}
