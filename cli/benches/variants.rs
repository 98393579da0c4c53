//! `cargo bench --package framewright-cli`: how many variants of `forward` are checked in a second, beside the project's goal.
//!
//! The measured program is the command as a user runs it, on as many threads as there are processors. Each time is the least of
//! many runs: other work on the machine only adds. A run is mostly its beginning, in which the shaders are compiled; so the
//! time of one variant is told too, and the rate that is left without it. `-- --short` runs everything twice, to see that it
//! runs.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Variants a second that the project wants on two processors.
const GOAL: f64 = 25_000.0;

fn main() {
    let runs = if std::env::args().any(|argument| argument == "--short") { 2 } else { 20 };
    let all: &[&str] = &["--all-variants", "--device", "all"];
    let variants = variants(all);
    let [one, every] = [&[][..], all].map(|words| (0..runs).map(|_| time(words)).min().unwrap_or_default());
    let rate = |time: Duration| variants / time.as_secs_f64();
    println!("forward has {variants} variants on the shipped devices; goal: {GOAL} a second");
    for (what, time) in [("the whole command", every), ("without the time for one variant", every.saturating_sub(one))]
    {
        let (milliseconds, rate) = (time.as_secs_f64() * 1e3, rate(time));
        println!("{what}: {milliseconds:.1} ms, {rate:.0} variants a second, {:.1} times the goal", rate / GOAL);
    }
}

fn command(words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_framewright"));
    command.args(["check", "forward"]).args(words).stdin(Stdio::null()).stderr(Stdio::null());
    command
}

fn time(words: &[&str]) -> Duration {
    let mut command = command(words);
    let start = Instant::now();
    let status = command.stdout(Stdio::null()).status().expect("the command starts");
    let time = start.elapsed();
    assert!(status.success(), "forward is fine in every variant");
    time
}

fn variants(words: &[&str]) -> f64 {
    let output = command(words).args(["--format", "json"]).output().expect("the command starts");
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    answer["checked"].as_f64().expect("a count")
}
