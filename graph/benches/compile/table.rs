//! Compiling: time, barriers, memory and what checking costs, by graph; and how they grow.

use crate::graphs;
use crate::timing::{Timing, beside, microseconds};
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::frame::Frame;
use framewright_graph::plan::Plan;
use framewright_graph::verify::verify;
use std::hint::black_box;

/// One line of the table.
struct Row {
    name: &'static str,
    passes: u32,
    compile: f64,
    verify: f64,
    goals: Goals,
    plan: Plan,
}

/// Goals of the project, where it has set them: microseconds a pass, image barriers, calls.
#[derive(Clone, Copy, Default)]
struct Goals {
    compile: Option<f64>,
    barriers: Option<u32>,
    calls: Option<u32>,
}

/// A kind of graph of any size.
struct Family {
    name: &'static str,
    graph: fn(u32) -> Frame,
    /// Goals for 25, 100, 1,000, 10,000 and 100,000 passes, microseconds a pass.
    goals: [Option<f64>; 5],
    /// The slope of time over passes, both in logarithms: 1 is linear.
    slope: f64,
}

const SIZES: [u32; 5] = [25, 100, 1_000, 10_000, 100_000];

const FAMILIES: [Family; 3] = [
    Family {
        name: "chain",
        graph: graphs::chain,
        goals: [Some(0.40), Some(0.40), Some(0.45), Some(0.50), Some(0.60)],
        slope: 1.10,
    },
    Family {
        name: "wide",
        graph: graphs::wide,
        goals: [Some(0.40), Some(0.40), Some(0.70), Some(0.90), Some(1.20)],
        slope: 1.20,
    },
    Family { name: "local", graph: graphs::local, goals: [None; 5], slope: 1.10 },
];

pub(crate) fn run(timing: &Timing) {
    let device = graphs::device();
    let mut rows = Vec::new();
    if timing.wants("deferred 25") {
        let goals = Goals { compile: Some(0.40), barriers: Some(54), calls: Some(21) };
        rows.push(measure(timing, "deferred", &graphs::deferred(), &device, goals));
    }
    for Family { name, graph, goals, .. } in FAMILIES {
        for (passes, compile) in SIZES.into_iter().zip(goals) {
            if timing.wants(&format!("{name} {passes}")) && !(timing.short && passes > 10_000) {
                let barriers = match (name, passes) {
                    ("chain", 100) => Some(199),
                    ("wide", 100) => Some(173),
                    _ => None,
                };
                let calls = (name == "wide" && passes == 100).then_some(17);
                rows.push(measure(timing, name, &graph(passes), &device, Goals { compile, barriers, calls }));
            }
        }
    }
    println!(
        "\n{:<14}{:>15}{:>19}{:>15}{:>11}{:>12}{:>15}",
        "", "µs a pass", "verify/compile", "barriers", "calls", "MiB", "of live peak"
    );
    rows.iter().for_each(print);
    growth(&rows);
    if timing.wants("low memory") {
        low_memory(&device);
    }
}

fn print(row: &Row) {
    let (goals, totals) = (row.goals, &row.plan.totals);
    let share = totals.placed_bytes as f64 / totals.live_peak_bytes as f64;
    println!(
        "{:<14}{:>15}{:>19}{:>15}{:>11}{:>12}{:>15}",
        format!("{} {}", row.name, row.passes),
        beside(format!("{:.3}", row.compile), goals.compile.map(|goal| format!("{goal:.2}"))),
        beside(format!("{:.2}", row.verify / row.compile), Some("1".to_owned())),
        beside(totals.image_barriers.to_string(), goals.barriers.map(|goal| goal.to_string())),
        beside(totals.barrier_calls.to_string(), goals.calls.map(|goal| goal.to_string())),
        format!("{:.1}", totals.placed_bytes as f64 / f64::from(1 << 20)),
        beside(format!("{share:.3}"), Some("1.02".to_owned())),
    );
}

/// How the total grows from 1,000 to 100,000 passes.
fn growth(rows: &[Row]) {
    for Family { name, slope, .. } in FAMILIES {
        let at = |passes| rows.iter().find(|row| row.name == name && row.passes == passes);
        if let (Some(few), Some(many)) = (at(1_000), at(100_000)) {
            let of = |figure: fn(&Row) -> f64| 1.0 + (figure(many) / figure(few)).log(100.0);
            let (compile, verify) = (of(|row| row.compile), of(|row| row.verify));
            println!("growth of {name}: compile {compile:.2} ({slope:.2}), verify {verify:.2}");
        }
    }
}

/// The order that saves memory.
fn low_memory(device: &Profile) {
    let options = Options { order: Order::LowMemory, ..Options::default() };
    let plan = compile(&graphs::wide(1000), device, &mut MemoryEstimate(device), &options).expect("the graph is valid");
    let share = plan.totals.placed_bytes as f64 / plan.totals.transient_bytes as f64;
    println!("low memory, wide 1000: {share:.3} of the sum of all images (0.381)");
}

fn measure(timing: &Timing, name: &'static str, frame: &Frame, device: &Profile, goals: Goals) -> Row {
    let compiled = || {
        compile(frame, device, &mut MemoryEstimate(device), &Options::default()).expect("the measured graphs are valid")
    };
    let plan = compiled();
    let passes = frame.passes.len() as u32;
    let compile = microseconds(timing.least(|| black_box(compiled()))) / f64::from(passes);
    let verify = microseconds(timing.least(|| black_box(verify(black_box(&plan))))) / f64::from(passes);
    Row { name, passes, compile, verify, goals, plan }
}
