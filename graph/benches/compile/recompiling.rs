//! Compiling again: the same frame, an equal one, other values.

use crate::changed::with_values;
use crate::graphs;
use crate::timing::{Timing, beside, microseconds};
use framewright_graph::compile::{Compiler, Options, Reuse};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::Frame;
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

pub(crate) fn run(timing: &Timing) {
    println!("\n{:<14}{:>16}{:>12}{:>18}", "again", "same, µs", "equal, µs", "other values");
    let frames = [
        ("deferred 25", graphs::deferred()),
        ("chain 100", graphs::chain(100)),
        ("wide 100", graphs::wide(100)),
        ("wide 1000", graphs::wide(1000)),
    ];
    for (name, frame) in frames.into_iter().filter(|(name, _)| timing.wants(name)) {
        row(timing, name, &frame);
    }
}

fn row(timing: &Timing, name: &str, frame: &Frame) {
    let frame = Arc::new(frame.clone());
    let equal = Arc::new(Frame::clone(&frame));
    let values = Arc::new(with_values(&frame));
    let full = alternate(timing, [&frame, &values], Reuse::Nothing, true);
    let same = alternate(timing, [&frame, &frame], Reuse::Everything, false);
    let compared = alternate(timing, [&frame, &equal], Reuse::Everything, false);
    let values = alternate(timing, [&frame, &values], Reuse::Decisions, false);
    let share = 100.0 * values.as_secs_f64() / full.as_secs_f64();
    println!(
        "{name:<14}{:>16}{:>12.2}{:>18}",
        beside(format!("{:.3}", microseconds(same)), Some("1".to_owned())),
        microseconds(compared),
        beside(format!("{share:.0} %"), Some("5".to_owned())),
    );
}

/// The least time for one of two frames after the other, if as much of that serves as expected; `anew`: with a compiler
/// that remembers nothing.
fn alternate(timing: &Timing, frames: [&Arc<Frame>; 2], expected: Reuse, anew: bool) -> Duration {
    let (device, options) = (Arc::new(graphs::device()), Options::default());
    let mut compiler = Compiler::new();
    let mut least = Duration::MAX;
    let mut at = 0;
    timing.least(|| {
        if anew {
            compiler = Compiler::new();
        }
        let start = Instant::now();
        let compiled = compiler.compile(frames[at], &device, &mut MemoryEstimate(&device), &options);
        let time = start.elapsed();
        black_box(&compiled).as_ref().expect("the graph is valid");
        // The first of all has nothing to follow.
        if compiler.reuse() >= expected {
            least = least.min(time);
        }
        at = 1 - at;
    });
    least
}
