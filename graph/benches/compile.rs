//! `cargo bench`: what compiling costs, on graphs built in memory, beside the goals of the project.
//!
//! Each figure is the least of several runs: other work on the machine only adds. Goals are microseconds a pass measured
//! on two cores at 2.5 GHz; compare ratios, not machines. Goals for barriers leave out the one that brings the output into
//! its promised state; memory is to stay within 1.02 of the live peak. In `wide` and `local` the last pass reads what nobody
//! else does, so that all passes stay. Growth is the slope of time over passes, both in logarithms:
//! 1 is linear.

#[path = "../tests/graphs/mod.rs"]
mod graphs;

use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{Estimated, Profile};
use framewright_graph::frame::Frame;
use framewright_graph::plan::Plan;
use framewright_graph::verify::verify;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// One line of the table.
struct Row {
    name: String,
    passes: u32,
    compile: f64,
    verify: f64,
    goals: Goals,
    plan: Plan,
}

/// What the project wants, where it has said so: microseconds a pass, image barriers, calls.
#[derive(Clone, Copy, Default)]
struct Goals {
    compile: Option<f64>,
    barriers: Option<u32>,
    calls: Option<u32>,
}

fn main() {
    let device = graphs::device();
    let deferred = Goals { compile: Some(0.40), barriers: Some(54), calls: Some(21) };
    // `cargo bench -- chain` measures only what has this in its name.
    let wanted: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|wanted| name.contains(wanted));
    let mut rows = Vec::new();
    if is_wanted("deferred 25") {
        rows.push(measure("deferred", &graphs::deferred(), &device, deferred));
    }
    type Graph = fn(u32) -> Frame;
    let families: [(&str, Graph, [Option<f64>; 4]); 3] = [
        ("chain", graphs::chain, [Some(0.40), Some(0.40), Some(0.45), Some(0.50)]),
        ("wide", graphs::wide, [Some(0.40), Some(0.40), Some(0.70), Some(0.90)]),
        ("local", graphs::local, [None; 4]),
    ];
    for (name, graph, goals) in families {
        for (passes, compile) in [25, 100, 1_000, 10_000].into_iter().zip(goals) {
            if !is_wanted(&format!("{name} {passes}")) {
                continue;
            }
            let barriers = (name == "chain" && passes == 100).then_some(199);
            let calls = (name == "wide" && passes == 100).then_some(17);
            rows.push(measure(name, &graph(passes), &device, Goals { compile, barriers, calls }));
        }
    }
    println!("(goals in brackets)");
    println!("graph                 µs a pass     verify µs         barriers       calls  placed MiB  / live peak");
    for row in &rows {
        let totals = &row.plan.totals;
        let (goals, passes) = (row.goals, row.passes);
        println!(
            "{:<14} {:>16} {:>13.3} {:>16} {:>11} {:>11.1} {:>12}",
            format!("{} {passes}", row.name),
            beside(format!("{:.3}", row.compile), goals.compile.map(|goal| format!("{goal:.2}"))),
            row.verify,
            beside(totals.image_barriers.to_string(), goals.barriers.map(|goal| goal.to_string())),
            beside(totals.barrier_calls.to_string(), goals.calls.map(|goal| goal.to_string())),
            totals.placed_bytes as f64 / f64::from(1 << 20),
            beside(
                format!("{:.3}", totals.placed_bytes as f64 / totals.live_peak_bytes as f64),
                Some("1.02".to_owned())
            ),
        );
    }
    for (name, ..) in families {
        let at = |passes| rows.iter().find(|row| row.name == name && row.passes == passes).map(|row| row.compile);
        if let (Some(few), Some(many)) = (at(1_000), at(10_000)) {
            println!("growth of {name} from 1,000 to 10,000 passes: {:.2} (goal ≤ 1.20)", 1.0 + (many / few).log10());
        }
    }
}

/// A figure with its goal in brackets.
fn beside(figure: String, goal: Option<String>) -> String {
    goal.map_or_else(|| figure.clone(), |goal| format!("{figure} ({goal})"))
}

fn measure(name: &str, frame: &Frame, device: &Profile, goals: Goals) -> Row {
    let compiled =
        || compile(frame, device, &mut Estimated(device), &Options::default()).expect("the measured graphs are legal");
    let plan = compiled();
    let passes = frame.passes.len() as u32;
    let a_pass = |time: Duration| time.as_secs_f64() * 1e6 / f64::from(passes);
    // Freeing what came out is not part of either.
    let compile = a_pass(least(|| black_box(compiled())));
    let verify = a_pass(least(|| black_box(verify(black_box(&plan)))));
    Row { name: name.to_owned(), passes, compile, verify, goals, plan }
}

/// The least time of one run, over at least five and about a third of a second.
fn least<T>(mut run: impl FnMut() -> T) -> Duration {
    let begin = Instant::now();
    let mut least = Duration::MAX;
    let mut runs = 0;
    while runs < 5 || begin.elapsed() < Duration::from_millis(300) {
        let start = Instant::now();
        let made = run();
        least = least.min(start.elapsed());
        drop(made);
        runs += 1;
    }
    least
}
