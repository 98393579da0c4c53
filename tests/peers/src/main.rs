//! Framewright beside other render graphs: the same graphs, on the same machine, in the same minutes.
//!
//! ```text
//! export VK_DRIVER_FILES=/usr/share/vulkan/icd.d/lvp_icd.x86_64.json
//! cargo run --release --manifest-path tests/peers/Cargo.toml
//! ```
//!
//! Add `-- wide` to measure only what has this in its name, `-- --short` to see that it runs, and `-- --format json` for a
//! program that reads the figures. vulkano-taskgraph and vk-graph need a Vulkan device; nothing is executed on it but one
//! frame of vk-graph that draws nothing.
//!
//! Each figure is the least of many runs, in microseconds a pass: time on the processor, which other work on the machine
//! interrupts but doesn't lengthen much. The systems take turns of some milliseconds, so that such work disturbs all of them.
//! A run has two parts, and freeing what came out belongs to neither:
//!
//! - **build**: the graph is described in the system's own words. Framewright's part makes the graph and its names. The peers'
//!   parts read a list of accesses that was made before.
//! - **compile**: the description becomes an order and barriers. [`systems`] says of each system where this begins and ends, and
//!   what it does and doesn't do.
//!
//! Passes are compute-style: sampled reads and storage writes of images with one mip level and one layer. Each system sees the
//! same images and the same accesses. vulkano-taskgraph visits the graph by recursion: everything runs on a thread with a
//! large stack.

mod accesses;
#[path = "../../../graph/benches/compile/allocator.rs"]
mod allocator;
#[path = "../../../graph/tests/suite/testing/graphs.rs"]
mod graphs;
mod measure;
#[path = "../../../graph/tests/suite/testing/parts.rs"]
mod parts;
mod report;
mod systems;

use accesses::Accesses;
use clap::{Parser, ValueEnum};
use framewright_graph::frame::Frame;
use report::Row;
use std::error::Error;

const STACK_BYTES: usize = 1 << 30;

/// Compiles the same graphs with Framewright and with other render graphs.
#[derive(Parser)]
struct Arguments {
    /// Parts of names of graphs; none: all graphs.
    graphs: Vec<String>,
    /// Runs everything twice, and no graph of more than 1,000 passes.
    #[arg(long)]
    short: bool,
    /// The form of the figures.
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    /// For people.
    Table,
    /// For programs.
    Json,
}

/// A graph of any size.
#[derive(Clone, Copy)]
struct Graph {
    family: &'static str,
    passes: u32,
    make: fn(u32) -> Frame,
}

impl Graph {
    fn name(self) -> String {
        format!("{} {}", self.family, self.passes)
    }

    fn frame(self) -> Frame {
        (self.make)(self.passes)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    if let Err(error) = allocator::with_settings() {
        eprintln!("glibc keeps its usual thresholds: {error}");
    }
    let arguments = Arguments::parse();
    let on_a_deep_stack = std::thread::Builder::new().stack_size(STACK_BYTES).spawn(move || run(&arguments))?;
    let result = on_a_deep_stack.join().map_err(|_| "the measuring thread panicked")?;
    Ok(result?)
}

fn run(arguments: &Arguments) -> Result<(), String> {
    let devices = systems::Devices::find();
    let most_passes = if arguments.short { 1_000 } else { 10_000 };
    let mut rows = Vec::new();
    for graph in graphs() {
        let name = graph.name();
        let wanted = arguments.graphs.is_empty() || arguments.graphs.iter().any(|part| name.contains(part));
        if !wanted || graph.passes > most_passes {
            continue;
        }
        let accesses = Accesses::of(&graph.frame());
        let found = measure::least(systems::candidates(graph, &accesses, &devices), arguments.short);
        rows.extend(Row::of(graph, found));
    }
    match arguments.format {
        Format::Table => report::print_table(&devices, &rows),
        Format::Json => report::print_json(&devices, &rows).map_err(|error| error.to_string())?,
    }
    Ok(())
}

fn graphs() -> Vec<Graph> {
    let of = |family, make: fn(u32) -> Frame| [100, 1_000, 10_000].map(|passes| Graph { family, passes, make });
    let deferred = Graph { family: "deferred", passes: 25, make: |_| graphs::deferred() };
    let families = [of("chain", graphs::chain), of("wide", graphs::wide), of("local", graphs::local)];
    std::iter::once(deferred).chain(families.into_iter().flatten()).collect()
}
