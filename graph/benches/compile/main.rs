//! `cargo bench -p framewright-graph`: what compiling costs, on graphs built in memory, beside the goals of the project.
//!
//! Each figure is the least of many runs: other work on the machine only adds. Goals stand in brackets; they are
//! microseconds measured on two cores at 2.5 GHz: compare ratios, not machines. `-- chain` measures only what has this in
//! its name; `-- --short` runs everything once or twice, to see that it runs.
//!
//! glibc gives freed memory back to the system and asks for it again, at times for each frame. So that this isn't what is
//! measured, the bench starts itself again with `MALLOC_TRIM_THRESHOLD_`, `MALLOC_MMAP_THRESHOLD_` and `MALLOC_TOP_PAD_` set.

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

/// Environment variables for glibc's memory. The first one also marks a process that was started with them.
const MEMORY: [(&str, &str); 3] = [
    ("MALLOC_TRIM_THRESHOLD_", "4000000000"),
    ("MALLOC_MMAP_THRESHOLD_", "4000000000"),
    ("MALLOC_TOP_PAD_", "67108864"),
];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if std::env::var_os(MEMORY[0].0).is_none() {
        match started_again(&arguments) {
            Ok(status) => std::process::exit(status.code().unwrap_or(1)),
            Err(error) => println!("(glibc keeps its usual thresholds: {error})"),
        }
    }
    let short = arguments.iter().any(|argument| argument == "--short");
    let wanted: Vec<String> = arguments.into_iter().filter(|argument| !argument.starts_with('-')).collect();
    let timing = Timing { short, wanted };
    println!("Goals in brackets. {}", MEMORY.map(|(name, value)| format!("{name}={value}")).join(" "));
    table::run(&timing);
    recompiling::run(&timing);
    reading::run(&timing);
}

fn started_again(arguments: &[String]) -> std::io::Result<std::process::ExitStatus> {
    std::process::Command::new(std::env::current_exe()?).args(arguments).envs(MEMORY).status()
}
