//! `cargo bench -p framewright-graph --bench instructions`: the instructions that compiling and checking take, beside the
//! committed ones. It fails if a graph takes 3 % more, and names the command that accepts the new figures. It needs
//! valgrind. With `--workspace --profile test` it counts those of the program that tests build anyway, which no build waits for.
//!
//! Valgrind's callgrind counts what happens within [`counted`] alone: neither building the graph nor a first run, which fills
//! the allocator's lists, is part of it. The C library is counted too: its allocator takes much of a short compilation.
//!
//! `instructions.txt` holds the committed figures of what is shipped, `dev_instructions.txt` those of what tests build.

#[path = "compile/changed.rs"]
mod changed;
#[allow(dead_code, reason = "each bench uses a part of it")]
#[path = "shared/counts.rs"]
mod counts;
#[path = "compile/files.rs"]
mod files;
#[path = "../tests/suite/testing/graphs.rs"]
mod graphs;
#[path = "../tests/suite/testing/parts.rs"]
mod parts;
#[allow(dead_code, reason = "tests use all of it")]
#[path = "../tests/suite/testing/pipelines.rs"]
mod pipelines;
#[path = "../tests/suite/testing/table.rs"]
mod table;

use counts::{Code, Guard, counted};
use framewright_graph::compile::{Compiler, Options, Reuse};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::Frame;
use framewright_graph::verify::verify;
use std::error::Error;
use std::hint::black_box;
use std::process::ExitCode;
use std::sync::Arc;

/// The figures, and how new ones are accepted.
const GUARD: Guard = if cfg!(debug_assertions) {
    Guard {
        figures: concat!(env!("CARGO_MANIFEST_DIR"), "/benches/dev_instructions.txt"),
        accept: "FRAMEWRIGHT_ACCEPT=graph cargo bench --workspace --profile test --bench instructions --bench dev_instructions",
    }
} else {
    Guard {
        figures: concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.txt"),
        accept: "FRAMEWRIGHT_ACCEPT=graph cargo bench -p framewright-graph --bench instructions",
    }
};

/// A row of the table, and what is run for it.
const ROWS: [(&str, fn()); 16] = [
    ("deferred", || compile(&graphs::deferred())),
    ("chain 100", || compile(&graphs::chain(100))),
    ("chain 1000", || compile(&graphs::chain(1_000))),
    ("chain 10000", || compile(&graphs::chain(10_000))),
    ("wide 100", || compile(&graphs::wide(100))),
    ("wide 1000", || compile(&graphs::wide(1_000))),
    ("wide 10000", || compile(&graphs::wide(10_000))),
    ("local 1000", || compile(&graphs::local(1_000))),
    ("wide 1000, other values", compile_again),
    ("deferred, verify", || check(&graphs::deferred())),
    ("chain 1000, verify", || check(&graphs::chain(1_000))),
    ("wide 1000, verify", || check(&graphs::wide(1_000))),
    ("forward.ron", || compile(&shipped("forward.ron"))),
    ("reading 1000", || read(files::written_out(1_000))),
    ("expanding 1000", || read(files::of_fragments(1_000))),
    ("expanding 1000, other value", expand_again),
];

fn main() -> Result<ExitCode, Box<dyn Error>> {
    GUARD.run_rows(&ROWS, Code::Counted)
}

fn compile(frame: &Frame) {
    let device = graphs::device();
    let compile =
        || framewright_graph::compile::compile(frame, &device, &mut MemoryEstimate(&device), &Options::default());
    black_box(compile()).expect("the graph is valid");
    counted(compile).expect("the graph is valid");
}

/// The frame of a shipped pipeline, over an unknown scene.
fn shipped(name: &str) -> Frame {
    pipelines::right(&pipelines::shipped(name), &pipelines::INPUTS)
}

/// Compiles a frame after one with other values.
fn compile_again() {
    let device = Arc::new(graphs::device());
    let frame = Arc::new(graphs::wide(1_000));
    let changed = Arc::new(changed::with_values(&frame));
    let mut compiler = Compiler::new();
    let mut compile = |frame| {
        let compiled = compiler.compile(frame, &device, &mut MemoryEstimate(&device), &Options::default());
        black_box(compiled).expect("the graph is valid");
    };
    compile(&frame);
    compile(&changed);
    counted(|| compile(&frame));
    assert_eq!(compiler.reuse(), Reuse::Decisions);
}

/// Puts a pipeline together after one with another value of a setting.
fn expand_again() {
    let mut expand = files::with_other_gains(files::of_setting(1_000));
    black_box(expand(0.5));
    black_box(expand(1.5));
    counted(|| expand(0.5));
}

/// Checks the Plan of a frame.
fn check(frame: &Frame) {
    let device = graphs::device();
    let compiled =
        framewright_graph::compile::compile(frame, &device, &mut MemoryEstimate(&device), &Options::default());
    let plan = compiled.expect("the graph is valid");
    black_box(verify(&plan));
    black_box(counted(|| verify(&plan)));
}

/// Reads a file, and puts its passes together with their shaders' interfaces.
fn read(text: String) {
    black_box(files::frame(text.clone()));
    counted(|| files::frame(text));
}
