//! `cargo bench -p framewright-tests`: what compiling a frame of each shipped pipeline costs.
//!
//! Each pipeline is measured under the settings with which it has the most steps. The time is the least of many runs: other
//! work on the machine only adds. `-- --short` runs each once, to see that it runs.

use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile, SHIPPED_PROFILES};
use framewright_graph::plan::Plan;
use framewright_tests::shipped::{self, ShippedFrame};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

fn main() {
    let short = std::env::args().any(|argument| argument == "--short");
    let (device, text) = SHIPPED_PROFILES[0];
    let profile = Profile::from_ron(text).expect("shipped profiles are read");
    let compiled = |shipped: &ShippedFrame| -> Plan {
        let plan = compile(&shipped.frame, &profile, &mut MemoryEstimate(&profile), &Options::default());
        plan.expect("shipped pipelines compile")
    };
    let mut longest: BTreeMap<&str, (usize, &ShippedFrame)> = BTreeMap::new();
    for shipped in shipped::frames([1920, 1080]) {
        let pipeline = shipped.how.split_whitespace().next().unwrap_or_default();
        let steps = compiled(shipped).steps.len();
        let known = longest.entry(pipeline).or_insert((steps, shipped));
        if steps > known.0 {
            *known = (steps, shipped);
        }
    }
    println!("{device}, 1920×1080\n\n| pipeline | passes | steps | µs | µs a pass |\n|---|---|---|---|---|");
    for (pipeline, (steps, shipped)) in longest {
        let runs = if short { 1 } else { 3_000 };
        let least = (0..runs).map(|_| time(|| compiled(shipped))).min().unwrap_or_default();
        let (passes, least) = (shipped.frame.passes.len(), least.as_secs_f64() * 1e6);
        println!("| {pipeline} | {passes} | {steps} | {least:.1} | {:.2} |", least / passes as f64);
    }
}

/// How long a run takes; freeing what it made is not part of it.
fn time<T>(run: impl FnOnce() -> T) -> Duration {
    let start = Instant::now();
    let made = run();
    let taken = start.elapsed();
    drop(made);
    taken
}
