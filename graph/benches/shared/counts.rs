//! Counts of instructions beside committed ones: the guard that fails where something takes more.
//!
//! A file of figures holds the committed ones. Its first line names the tools that they depend on: the compiler, the C
//! library (its allocator is counted too), valgrind and the processor's architecture. With other tools the figures can't be
//! compared, which is said. That fails only where `CI` is set. The figures are written only if they are accepted.

use std::error::Error;
use std::process::{Command, ExitCode};

/// The share by which a figure may differ from the committed one.
const TOLERANCE: f64 = 0.03;

/// A file of committed figures.
pub(crate) struct Guard {
    /// The file.
    pub(crate) figures: &'static str,
    /// The command that accepts new figures.
    pub(crate) accept: &'static str,
}

impl Guard {
    /// Counts each row, prints it beside the committed count, and judges all.
    pub(crate) fn run<'r>(
        &self,
        rows: impl IntoIterator<Item = &'r str>,
        count: impl Fn(&str) -> Result<u64, Box<dyn Error>>,
    ) -> Result<ExitCode, Box<dyn Error>> {
        let committed = Figures::read(self.figures)?;
        let mut now = Figures { tools: tools()?, counts: Vec::new() };
        println!("{:<24}{:>12}{:>12}", "instructions", "committed", "now");
        for name in rows {
            let count = count(name)?;
            now.counts.push((name.to_owned(), count));
            let before = committed.of(name).map_or("none".to_owned(), |count| count.to_string());
            let more = match committed.tools == now.tools {
                true => format!("{:>+8.1} %", 100.0 * now.growth(name, &committed)),
                false => String::new(),
            };
            println!("{name:<24}{before:>12}{count:>12}{more}");
        }
        self.judge(&committed, &now)
    }

    /// Says how the figures differ from the committed ones, and writes them where they are accepted.
    fn judge(&self, committed: &Figures, now: &Figures) -> Result<ExitCode, Box<dyn Error>> {
        let accept = self.accept;
        let is_set = |variable: &str| std::env::var_os(variable).is_some_and(|value| !value.is_empty());
        if is_set("FRAMEWRIGHT_ACCEPT") {
            now.write(self.figures)?;
            println!("accepted: {}", self.figures);
            return Ok(ExitCode::SUCCESS);
        }
        if committed.tools != now.tools {
            let is_ci = is_set("CI");
            eprintln!(
                "{}: the figures can't be compared, since they were counted with other tools; renew them with {accept}\n  \
                 committed: {}\n  now:       {}",
                if is_ci { "error" } else { "note" },
                committed.tools,
                now.tools
            );
            return Ok(if is_ci { ExitCode::FAILURE } else { ExitCode::SUCCESS });
        }
        let names = |wanted: fn(f64) -> bool| {
            let rows = now.counts.iter().map(|(name, _)| &**name).filter(|name| wanted(now.growth(name, committed)));
            rows.collect::<Vec<_>>().join("; ")
        };
        let (worse, better) = (names(|growth| growth > TOLERANCE), names(|growth| growth < -TOLERANCE));
        if !better.is_empty() {
            println!("better by more than 3 %: {better}; commit the gain: {accept}");
        }
        if worse.is_empty() {
            return Ok(ExitCode::SUCCESS);
        }
        eprintln!("error: worse by more than 3 %, or not committed: {worse}; accept with {accept}");
        Ok(ExitCode::FAILURE)
    }
}

/// The instructions that callgrind counts in all of a program, or in one function of it, and in no process that it starts.
pub(crate) fn instructions(program: &mut Command, function: Option<&str>) -> Result<u64, Box<dyn Error>> {
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]);
    if let Some(function) = function {
        valgrind.arg("--collect-atstart=no").arg(format!("--toggle-collect={function}"));
    }
    valgrind.arg(program.get_program()).args(program.get_args());
    let run = valgrind.output().map_err(|error| format!("valgrind: {error}"))?;
    let said = String::from_utf8_lossy(&run.stderr);
    let collected = said.lines().find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok());
    match collected {
        Some(count) if run.status.success() && count > 0 => Ok(count),
        _ => Err(format!("valgrind counted nothing of {program:?}:\n{said}").into()),
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

/// The contents of a file of figures.
struct Figures {
    tools: String,
    counts: Vec<(String, u64)>,
}

impl Figures {
    /// A line without a count, as a merge leaves it, is a row that isn't committed.
    fn read(path: &str) -> Result<Figures, Box<dyn Error>> {
        let text = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
        let (tools, rows) = text.split_once('\n').unwrap_or((&text, ""));
        let row = |row: &str| {
            let (name, count) = row.rsplit_once(' ')?;
            Some((name.trim().to_owned(), count.parse().ok()?))
        };
        Ok(Figures { tools: tools.to_owned(), counts: rows.lines().filter_map(row).collect() })
    }

    fn write(&self, path: &str) -> std::io::Result<()> {
        let rows = self.counts.iter().map(|(name, count)| format!("{name:<24}{count:>12}\n"));
        std::fs::write(path, format!("{}\n{}", self.tools, rows.collect::<String>()))
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
