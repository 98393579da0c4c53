//! The least time of many runs.

use std::time::{Duration, Instant};

/// How long to measure, and what.
pub(crate) struct Timing {
    pub(crate) short: bool,
    /// Parts of names; none: everything.
    pub(crate) wanted: Vec<String>,
}

impl Timing {
    pub(crate) fn wants(&self, name: &str) -> bool {
        self.wanted.is_empty() || self.wanted.iter().any(|wanted| name.contains(wanted.as_str()))
    }

    /// The least time of one run, over at least five and about half a second. Freeing what came out is not part of it.
    ///
    /// Runs of many milliseconds are interrupted by other work on the machine. For them the mean time on the processor counts,
    /// where the system tells, if that is less.
    pub(crate) fn least<T>(&self, mut run: impl FnMut() -> T) -> Duration {
        const LONG: Duration = Duration::from_millis(5);
        let (fewest, while_below) = if self.short { (2, Duration::ZERO) } else { (8, Duration::from_millis(500)) };
        let begin = Instant::now();
        let (mut least, mut on_processor) = (Duration::MAX, Some(Duration::ZERO));
        let mut runs = 0;
        while runs < fewest || begin.elapsed() < while_below {
            let before = time_on_processor();
            let start = Instant::now();
            let made = run();
            least = least.min(start.elapsed());
            let after = time_on_processor();
            drop(made);
            on_processor = on_processor.zip(before).zip(after).map(|((sum, before), after)| sum + (after - before));
            runs += 1;
        }
        match on_processor {
            Some(sum) if least > LONG && !self.short => least.min(sum / runs),
            _ => least,
        }
    }
}

/// How long this thread has run, as Linux counts it.
fn time_on_processor() -> Option<Duration> {
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(Duration::from_nanos(counted.split_whitespace().next()?.parse().ok()?))
}

pub(crate) fn microseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e6
}

/// A figure with its goal in brackets.
pub(crate) fn beside(figure: String, goal: Option<String>) -> String {
    match goal {
        Some(goal) => format!("{figure} ({goal})"),
        None => figure,
    }
}
