//! `cargo bench -p framewright-graph --bench instructions`: the instructions that compiling takes, beside the committed
//! ones. It fails if a graph takes 3 % more, and names the command that accepts the new figures. It needs valgrind.
//!
//! Valgrind's callgrind counts what happens within [`counted`] alone: neither building the graph nor a first compilation, which
//! fills the allocator's lists, is part of it.
//!
//! `instructions.txt` holds the committed figures. The C library is counted too: its allocator takes much of a short compilation.

#[path = "compile/changed.rs"]
mod changed;
#[path = "instructions/counts.rs"]
mod counts;
#[path = "../tests/suite/testing/graphs.rs"]
mod graphs;
#[path = "../tests/suite/testing/parts.rs"]
mod parts;

use counts::{Code, Guard, counted};
use framewright_graph::compile::{Compiler, Options, Reuse};
use framewright_graph::device::Estimated;
use framewright_graph::frame::Frame;
use framewright_graph::verify::verify;
use std::error::Error;
use std::hint::black_box;
use std::process::ExitCode;
use std::sync::Arc;

/// The figures and how they are counted.
const GUARD: Guard = Guard {
    accept: "FRAMEWRIGHT_ACCEPT=1 cargo bench -p framewright-graph --bench instructions",
    figures: concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.txt"),
    rows: &ROWS,
    code: Code::All,
};

/// A row of the table, and what is run for it.
const ROWS: [(&str, fn()); 11] = [
    ("deferred", || compile(&graphs::deferred())),
    ("chain 100", || compile(&graphs::chain(100))),
    ("chain 1000", || compile(&graphs::chain(1_000))),
    ("chain 10000", || compile(&graphs::chain(10_000))),
    ("wide 100", || compile(&graphs::wide(100))),
    ("wide 1000", || compile(&graphs::wide(1_000))),
    ("wide 10000", || compile(&graphs::wide(10_000))),
    ("local 1000", || compile(&graphs::local(1_000))),
    ("wide 1000, other values", || compile_again(changed::with_values, Reuse::Placement)),
    ("wide 1000, other sizes", || compile_again(changed::with_sizes, Reuse::Structure)),
    ("wide 1000, verify", verify_plan),
];

fn main() -> Result<ExitCode, Box<dyn Error>> {
    counts::run(&GUARD)
}

fn compile(frame: &Frame) {
    let device = graphs::device();
    let compile = || framewright_graph::compile::compile(frame, &device, &mut Estimated(&device), &Options::default());
    black_box(compile()).expect("the graph is valid");
    counted(compile).expect("the graph is valid");
}

/// Compiles a frame after the `changed` one, of which as much serves as `expected`.
fn compile_again(changed: fn(&Frame) -> Frame, expected: Reuse) {
    let device = Arc::new(graphs::device());
    let frame = Arc::new(graphs::wide(1_000));
    let changed = Arc::new(changed(&frame));
    let mut compiler = Compiler::new();
    let mut compile = |frame| {
        let compiled = compiler.compile(frame, &device, &mut Estimated(&device), &Options::default());
        black_box(compiled).expect("the graph is valid");
    };
    compile(&frame);
    compile(&changed);
    counted(|| compile(&frame));
    assert!(compiler.reuse() >= expected, "{expected:?} was to be reused, not {:?}", compiler.reuse());
}

fn verify_plan() {
    let device = graphs::device();
    let frame = graphs::wide(1_000);
    let compiled = framewright_graph::compile::compile(&frame, &device, &mut Estimated(&device), &Options::default());
    let plan = compiled.expect("the graph is valid");
    black_box(verify(&plan));
    black_box(counted(|| verify(&plan)));
}
