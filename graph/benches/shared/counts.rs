//! Counts of instructions beside committed ones: the guard that fails where something takes more.
//!
//! A file of figures holds the committed ones. Its first line names the tools that they depend on: the compiler, the C
//! library (its allocator is counted too), valgrind and the processor's architecture. With other tools the figures can't be
//! compared, which is said. That fails only where `CI` is set. The figures are written only if they are accepted.

use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::{Command, ExitCode};

/// The share by which a figure may differ from the committed one.
const TOLERANCE: f64 = 0.03;
/// The argument before the name of the only row to run, within valgrind.
const ONLY: &str = "--only";

/// A file of committed figures.
pub(crate) struct Guard {
    /// The file.
    pub(crate) figures: &'static str,
    /// The command that accepts new figures.
    pub(crate) accept: &'static str,
}

impl Guard {
    /// Counts what each row runs within [`counted`], and judges all. Within valgrind it runs the one row that the arguments name.
    pub(crate) fn run_rows(&self, rows: &[(&str, fn())], code: Code) -> Result<ExitCode, Box<dyn Error>> {
        let arguments: Vec<String> = std::env::args().skip(1).collect();
        if let [mark, name] = &arguments[..]
            && mark == ONLY
        {
            let (_, run) = rows.iter().find(|(row, _)| row == name).ok_or("no row has this name")?;
            run();
            return Ok(ExitCode::SUCCESS);
        }
        let program = std::env::current_exe()?;
        self.run(rows.iter().map(|(name, _)| *name), |name| {
            instructions(Command::new(&program).args([ONLY, name]), code)
        })
    }

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

    /// Whether the environment names the folder whose figures are accepted.
    fn is_accepted(&self) -> bool {
        let folder = Path::new(self.figures).ancestors().nth(2).and_then(Path::file_name);
        folder.is_some() && std::env::var_os("FRAMEWRIGHT_ACCEPT").as_deref() == folder
    }

    /// Says how the figures differ from the committed ones, and writes them where they are accepted.
    fn judge(&self, committed: &Figures, now: &Figures) -> Result<ExitCode, Box<dyn Error>> {
        let accept = self.accept;
        let is_set = |variable: &str| std::env::var_os(variable).is_some_and(|value| !value.is_empty());
        if self.is_accepted() {
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

/// The code whose instructions count.
#[derive(Clone, Copy)]
pub(crate) enum Code {
    /// All of a program, and no process that it starts.
    Program,
    /// The code that runs within [`counted`], libraries included.
    Counted,
    /// The same without the shared libraries that the program calls.
    CountedOwn,
}

/// Callgrind counts what happens within this function, which it knows by name, whatever the benchmark is called.
#[inline(never)]
pub(crate) fn counted<T>(run: impl FnOnce() -> T) -> T {
    black_box(run())
}

/// The instructions of `program` that callgrind counts.
pub(crate) fn instructions(program: &Command, code: Code) -> Result<u64, Box<dyn Error>> {
    let profile = std::env::temp_dir().join(format!("framewright-instructions-{}", std::process::id()));
    let mut valgrind = Command::new("valgrind");
    valgrind.arg("--tool=callgrind").arg(format!("--callgrind-out-file={}", profile.display()));
    if let Code::Counted | Code::CountedOwn = code {
        valgrind.args(["--collect-atstart=no", "--toggle-collect=*instructions::counts::counted*"]);
    }
    let run = valgrind.arg(program.get_program()).args(program.get_args()).output();
    let run = run.map_err(|error| format!("valgrind: {error}"))?;
    let written = std::fs::read_to_string(&profile);
    let _ = std::fs::remove_file(&profile);
    let said = String::from_utf8_lossy(&run.stderr);
    let count = match code {
        Code::CountedOwn => written.ok().map(|written| in_program(&written, Path::new(program.get_program()))),
        Code::Program | Code::Counted => {
            said.lines().find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok())
        }
    };
    match count {
        Some(count) if run.status.success() && count > 0 => Ok(count),
        _ => Err(format!("valgrind counted nothing of {program:?}:\n{said}").into()),
    }
}

/// The instructions of a profile that belong to `program` itself, and not to libraries.
///
/// A line `ob=(1) path`, later `ob=(1)`, says to which file belongs what follows. Lines of positions and counts begin with a
/// digit or a sign. The one behind a line `calls=` counts what was called, which has lines of its own.
fn in_program(profile: &str, program: &Path) -> u64 {
    let (mut own, mut is_own, mut called) = (None, false, false);
    let mut sum = 0;
    for line in profile.lines() {
        if let Some(object) = line.strip_prefix("ob=").or_else(|| line.strip_prefix("cob=")) {
            let (number, path) = object.split_once(' ').unwrap_or((object, ""));
            if Path::new(path) == program {
                own = Some(number.to_owned());
            }
            if line.starts_with("ob=") {
                is_own = own.as_deref() == Some(number);
            }
        } else if line.starts_with("calls=") {
            called = true;
        } else if line.starts_with(|first: char| first.is_ascii_digit() || "+-*".contains(first)) {
            let count = line.rsplit(' ').next().and_then(|count| count.parse::<u64>().ok());
            sum += count.filter(|_| is_own && !called).unwrap_or(0);
            called = false;
        }
    }
    sum
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
