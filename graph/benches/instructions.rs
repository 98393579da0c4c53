//! `cargo bench -p framewright-graph --bench instructions`: the instructions that compiling takes, beside the committed
//! ones. It fails if a graph takes 3 % more, and names the command that accepts the new figures. It needs valgrind.
//!
//! Instructions are counted because time on a busy machine says nothing about a few per cent. Valgrind's callgrind runs
//! this program once for each row and counts what happens within [`counted`] alone: neither building the graph nor a first
//! compilation, which fills the allocator's lists, is part of it.
//!
//! `instructions.txt` holds the committed figures. Its first line names the tools that they depend on: the compiler, the
//! C library (its allocator is counted too), valgrind and the processor's architecture. With other tools the figures can't
//! be compared, which is said. That fails only where `CI` is set. The figures are written only if they are accepted.

#[path = "compile/changed.rs"]
mod changed;
#[path = "compile/files.rs"]
mod files;
#[path = "../tests/suite/testing/graphs.rs"]
mod graphs;
#[path = "../tests/suite/testing/parts.rs"]
mod parts;

use framewright_graph::compile::{Compiler, Options, Reuse};
use framewright_graph::device::Estimated;
use framewright_graph::frame::Frame;
use framewright_graph::verify::verify;
use std::error::Error;
use std::hint::black_box;
use std::process::{Command, ExitCode};
use std::sync::Arc;

const ACCEPT: &str = "FRAMEWRIGHT_ACCEPT=1 cargo bench -p framewright-graph --bench instructions";
const FIGURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.txt");
/// The share by which a figure may differ from the committed one.
const TOLERANCE: f64 = 0.03;
/// The argument before the name of the only row to run, within valgrind.
const ONLY: &str = "--only";

/// A row of the table, and what is run for it.
const ROWS: [(&str, fn()); 13] = [
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
    ("reading 1000", || read(files::written_out(1_000))),
    ("expanding 1000", || read(files::of_fragments(1_000))),
];

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [mark, name] = &arguments[..]
        && mark == ONLY
    {
        let (_, run) = ROWS.iter().find(|(row, _)| row == name).ok_or("no row has this name")?;
        run();
        return Ok(ExitCode::SUCCESS);
    }
    let committed = Figures::read()?;
    let mut now = Figures { tools: tools()?, counts: Vec::new() };
    println!("{:<24}{:>12}{:>12}", "instructions", "committed", "now");
    for (name, _) in ROWS {
        now.counts.push((name.to_owned(), instructions(name)?));
        let before = committed.of(name).map_or("none".to_owned(), |count| count.to_string());
        let count = now.of(name).unwrap_or_default();
        let more = match committed.tools == now.tools {
            true => format!("{:>+8.1} %", 100.0 * now.growth(name, &committed)),
            false => String::new(),
        };
        println!("{name:<24}{before:>12}{count:>12}{more}");
    }
    judge(&committed, &now)
}

/// Says how the figures differ from the committed ones, and writes them where they are accepted.
fn judge(committed: &Figures, now: &Figures) -> Result<ExitCode, Box<dyn Error>> {
    let is_set = |variable: &str| std::env::var_os(variable).is_some_and(|value| !value.is_empty());
    if is_set("FRAMEWRIGHT_ACCEPT") {
        now.write()?;
        println!("accepted: {FIGURES}");
        return Ok(ExitCode::SUCCESS);
    }
    if committed.tools != now.tools {
        let is_ci = is_set("CI");
        eprintln!(
            "{}: the figures can't be compared, since they were counted with other tools; renew them with {ACCEPT}\n  \
             committed: {}\n  now:       {}",
            if is_ci { "error" } else { "note" },
            committed.tools,
            now.tools
        );
        return Ok(if is_ci { ExitCode::FAILURE } else { ExitCode::SUCCESS });
    }
    let names = |wanted: fn(f64) -> bool| {
        let rows = ROWS.iter().map(|(name, _)| *name).filter(|name| wanted(now.growth(name, committed)));
        rows.collect::<Vec<_>>().join("; ")
    };
    let (worse, better) = (names(|growth| growth > TOLERANCE), names(|growth| growth < -TOLERANCE));
    if !better.is_empty() {
        println!("better by more than 3 %: {better}; commit the gain: {ACCEPT}");
    }
    if worse.is_empty() {
        return Ok(ExitCode::SUCCESS);
    }
    eprintln!("error: worse by more than 3 %, or not committed: {worse}; accept with {ACCEPT}");
    Ok(ExitCode::FAILURE)
}

/// Callgrind counts what happens within this function, which it knows by name.
#[inline(never)]
fn counted<T>(run: impl FnOnce() -> T) -> T {
    black_box(run())
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

/// Reads a file, and puts its passes together with their shaders' interfaces.
fn read(text: String) {
    black_box(files::frame(text.clone()));
    counted(|| files::frame(text));
}

/// The instructions that callgrind counts for a row.
fn instructions(name: &str) -> Result<u64, Box<dyn Error>> {
    let run = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"])
        .arg("--toggle-collect=instructions::counted*")
        .arg(std::env::current_exe()?)
        .args([ONLY, name])
        .output()
        .map_err(|error| format!("valgrind: {error}"))?;
    let said = String::from_utf8_lossy(&run.stderr);
    let collected = said.lines().find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok());
    match collected {
        Some(count) if run.status.success() && count > 0 => Ok(count),
        _ => Err(format!("valgrind counted nothing of {name}:\n{said}").into()),
    }
}

/// Everything outside this repository that decides how many instructions there are.
fn tools() -> Result<String, Box<dyn Error>> {
    let said = |program: &str, argument: &str| -> Result<String, Box<dyn Error>> {
        let run = Command::new(program).arg(argument).output().map_err(|error| format!("{program}: {error}"))?;
        Ok(String::from_utf8(run.stdout)?.trim().to_owned())
    };
    let compiler = said("rustc", "--version")?;
    let library = said("getconf", "GNU_LIBC_VERSION")?;
    Ok(format!("{compiler}, {library}, {}, {}", said("valgrind", "--version")?, std::env::consts::ARCH))
}

/// The contents of `instructions.txt`.
struct Figures {
    tools: String,
    counts: Vec<(String, u64)>,
}

impl Figures {
    /// A line without a count, as a merge leaves it, is a row that isn't committed.
    fn read() -> Result<Figures, Box<dyn Error>> {
        let text = std::fs::read_to_string(FIGURES).map_err(|error| format!("{FIGURES}: {error}"))?;
        let (tools, rows) = text.split_once('\n').unwrap_or((&text, ""));
        let row = |row: &str| {
            let (name, count) = row.rsplit_once(' ')?;
            Some((name.trim().to_owned(), count.parse().ok()?))
        };
        Ok(Figures { tools: tools.to_owned(), counts: rows.lines().filter_map(row).collect() })
    }

    fn write(&self) -> std::io::Result<()> {
        let rows = self.counts.iter().map(|(name, count)| format!("{name:<24}{count:>12}\n"));
        std::fs::write(FIGURES, format!("{}\n{}", self.tools, rows.collect::<String>()))
    }

    fn of(&self, name: &str) -> Option<u64> {
        self.counts.iter().find(|(row, _)| row == name).map(|(_, count)| *count)
    }

    /// How much more a row takes than in `committed`, as a share of that; infinitely more, if it isn't there.
    fn growth(&self, name: &str, committed: &Figures) -> f64 {
        match (self.of(name), committed.of(name)) {
            (Some(now), Some(before)) => now as f64 / before as f64 - 1.0,
            _ => f64::INFINITY,
        }
    }
}
