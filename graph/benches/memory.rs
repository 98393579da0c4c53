//! `cargo bench -p framewright-graph --bench memory`: what compiling and checking allocate, by a counting allocator. It
//! counts every allocation, so times are measured by another bench.

#[allow(dead_code, reason = "the other bench uses more of it")]
#[path = "../tests/suite/testing/graphs.rs"]
mod graphs;
#[path = "../tests/suite/testing/parts.rs"]
mod parts;

use framewright_graph::compile::{Compiler, Options, compile};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::Frame;
use framewright_graph::verify::verify;
use std::sync::Arc;

fn main() {
    let device = Arc::new(graphs::device());
    println!(
        "Goals in brackets.\n{:<14}{:>22}{:>22}{:>22}{:>28}{:>30}",
        "",
        "most bytes a pass",
        "Plan, bytes a pass",
        "allocations a pass",
        "allocations, same again",
        "verify, most bytes a pass"
    );
    let frames: [(&str, Frame); 6] = [
        ("deferred 25", graphs::deferred()),
        ("chain 1000", graphs::chain(1_000)),
        ("chain 10000", graphs::chain(10_000)),
        ("wide 1000", graphs::wide(1_000)),
        ("wide 10000", graphs::wide(10_000)),
        ("local 10000", graphs::local(10_000)),
    ];
    for (name, frame) in frames {
        let passes = frame.passes.len() as f64;
        let mut plan = None;
        let once = allocation_counter::measure(|| {
            plan = compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default()).ok();
        });
        let checked = allocation_counter::measure(|| {
            let _ = plan.as_ref().map(verify);
        });
        let frame = Arc::new(frame);
        let mut compiler = Compiler::new();
        let mut again = || compiler.compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default()).is_ok();
        again();
        let again = allocation_counter::measure(|| {
            again();
        });
        let goal = if frame.passes.len() == 10_000 { " (1024)" } else { "" };
        println!(
            "{name:<14}{:>22}{:>22.0}{:>22.2}{:>28}{:>30.0}",
            format!("{:.0}{goal}", once.bytes_max as f64 / passes),
            once.bytes_current as f64 / passes,
            once.count_total as f64 / passes,
            format!("{} (0)", again.count_total),
            checked.bytes_max as f64 / passes,
        );
    }
}
