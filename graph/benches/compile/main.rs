//! `cargo bench -p framewright-graph`: what compiling costs, on graphs built in memory, beside the goals of the project.
//!
//! Each figure is the least of many runs: other work on the machine only adds. Goals stand in brackets; they are
//! microseconds measured on two cores at 2.5 GHz: compare ratios, not machines. `-- chain` measures only what has this in
//! its name; `-- --short` runs everything once or twice, to see that it runs.

mod allocator;
mod changed;
mod files;
#[path = "../../tests/suite/testing/graphs.rs"]
mod graphs;
#[path = "../../tests/suite/testing/parts.rs"]
mod parts;
mod reading;
mod recompiling;
mod table;
mod timing;

use timing::Timing;

fn main() {
    if let Err(error) = allocator::with_settings() {
        println!("(glibc keeps its usual thresholds: {error})");
    }
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let short = arguments.iter().any(|argument| argument == "--short");
    let wanted: Vec<String> = arguments.into_iter().filter(|argument| !argument.starts_with('-')).collect();
    let timing = Timing { short, wanted };
    println!("Goals in brackets. {}", allocator::MEMORY.map(|(name, value)| format!("{name}={value}")).join(" "));
    table::run(&timing);
    recompiling::run(&timing);
    reading::run(&timing);
}
