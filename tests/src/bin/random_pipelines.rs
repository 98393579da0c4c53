//! Executes random pipelines on drivers and compares every output with what the pipelines mean.

use clap::{Parser, ValueEnum};
use framewright_graph::compile::Order;
use framewright_graph::frame::Stereo;
use framewright_graph::vulkan::Sharing;
use framewright_tests::drivers::Driver;
use framewright_tests::random_pipelines::allowed::{Allowed, Kind, NOT_YET};
use framewright_tests::random_pipelines::judge::{Fault, Judge, expected, frames, options};
use framewright_tests::random_pipelines::pipeline::Pipeline;
use framewright_tests::random_pipelines::spoil::Spoil;
use framewright_tests::random_pipelines::{generate, passes, shrink};
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::atomic::{AtomicBool, Ordering};

/// Execute random pipelines, and compare every output with what they mean.
#[derive(Debug, Parser)]
#[command(name = "random_pipelines", after_help = EXIT_CODES)]
struct Line {
    /// Seed of the first pipeline.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How many pipelines, with seeds that follow each other.
    #[arg(long, default_value_t = 100)]
    count: u64,
    /// Driver; without it each software driver that is installed.
    #[arg(long, value_enum)]
    driver: Option<Driver>,
    /// Order of execution; without it all four.
    #[arg(long, value_enum)]
    order: Option<ChosenOrder>,
    /// Compile for three queues, however many the driver has: `shared` between them, or `handed-over` from one to another.
    #[arg(long, value_enum)]
    queues: Option<ThreeQueues>,
    /// Draw for two eyes so, which see the same: pipelines without buffers, which both would share.
    #[arg(long, value_parser = stereo)]
    stereo: Option<Stereo>,
    /// Most passes of a pipeline.
    #[arg(long, default_value_t = 24, value_name = "MAX", value_parser = clap::value_parser!(u32).range(1..=200))]
    passes: u32,
    /// Frames that each is executed for; without it as many as show all that it keeps from frame to frame.
    #[arg(long)]
    frames: Option<u32>,
    /// Stop after this number of failures.
    #[arg(long, default_value_t = 3)]
    failures: u64,
    /// Write what fails here, shrunk: the pipeline file, its shaders, and its Plan as text.
    #[arg(long, default_value = "target/random_pipelines", value_name = "FOLDER")]
    write: PathBuf,
    /// Print each pipeline.
    #[arg(long)]
    show: bool,
    /// Spoil each Plan before it is executed, to see that it is noticed.
    #[arg(long, hide = true, value_parser = spoiled)]
    spoil: Option<Spoil>,
    /// Stay in this process, with the driver that the environment offers, and note there what is being done.
    #[arg(long, hide = true)]
    notes: Option<PathBuf>,
}

fn spoiled(name: &str) -> Result<Spoil, String> {
    let all = [
        Spoil::Fill,
        Spoil::Clear,
        Spoil::Load,
        Spoil::Initial,
        Spoil::Blend,
        Spoil::Depth,
        Spoil::Stencil,
        Spoil::Pass,
    ];
    all.into_iter().find(|spoil| format!("{spoil:?}") == name).ok_or_else(|| format!("nothing is called {name}"))
}

fn stereo(name: &str) -> Result<Stereo, String> {
    Stereo::ALL.into_iter().find(|stereo| stereo.name() == name).ok_or_else(|| format!("nothing is called {name}"))
}

const EXIT_CODES: &str = "Exit codes:
  0    all outputs are what they should be
  1    one is not, or a valid pipeline failed in another way
  2    the command line is wrong
  3    there is no such driver, or no validation layer that is awake
  130  interrupted by Ctrl-C";

/// An order of execution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ChosenOrder {
    File,
    Default,
    LowMemory,
    Random,
}

impl ChosenOrder {
    const ALL: [ChosenOrder; 4] =
        [ChosenOrder::Default, ChosenOrder::LowMemory, ChosenOrder::File, ChosenOrder::Random];

    /// Its name, as the command line has it.
    const fn name(self) -> &'static str {
        match self {
            ChosenOrder::File => "file",
            ChosenOrder::Default => "default",
            ChosenOrder::LowMemory => "low-memory",
            ChosenOrder::Random => "random",
        }
    }

    const fn order(self, seed: u64) -> Order {
        match self {
            ChosenOrder::File => Order::File,
            ChosenOrder::Default => Order::Default,
            ChosenOrder::LowMemory => Order::LowMemory,
            ChosenOrder::Random => Order::Random(seed),
        }
    }
}

/// What three queues do with images.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ThreeQueues {
    Shared,
    HandedOver,
}

impl ThreeQueues {
    const fn sharing(self) -> Sharing {
        match self {
            ThreeQueues::Shared => Sharing::Concurrent,
            ThreeQueues::HandedOver => Sharing::Exclusive,
        }
    }

    /// Its name, as the command line has it.
    const fn name(self) -> &'static str {
        match self {
            ThreeQueues::Shared => "shared",
            ThreeQueues::HandedOver => "handed-over",
        }
    }
}

const FINE: u8 = 0;
const FAILED: u8 = 1;
const USAGE: u8 = 2;
const ENVIRONMENT: u8 = 3;
const INTERRUPTED: u8 = 130;
const CODES: [u8; 5] = [FINE, FAILED, USAGE, ENVIRONMENT, INTERRUPTED];

fn main() -> ExitCode {
    let line = match Line::try_parse() {
        Ok(line) => line,
        Err(error) => {
            // Help is an answer, on standard output; if nobody reads it there is nobody to tell.
            drop(error.print());
            return if error.use_stderr() { USAGE } else { FINE }.into();
        }
    };
    let outcome = match &line.notes {
        Some(notes) => here(&line, notes),
        None => on_drivers(&line),
    };
    outcome
        .unwrap_or_else(|error| {
            eprintln!("error: {error}");
            ENVIRONMENT
        })
        .into()
}

/// Runs each driver in a process of its own: it is chosen before the Vulkan loader looks, and may crash.
fn on_drivers(line: &Line) -> Result<u8, Box<dyn Error>> {
    let drivers = match line.driver {
        Some(driver) => vec![driver],
        None => Driver::SOFTWARE.into_iter().filter(|driver| driver.manifest().is_some()).collect(),
    };
    if drivers.is_empty() {
        return Err("neither lavapipe nor SwiftShader is installed".into());
    }
    let mut worst = FINE;
    for driver in drivers {
        let manifest = driver.manifest();
        if manifest.is_none() && driver != Driver::Gpu {
            return Err(format!("{} is not installed", driver.name()).into());
        }
        let notes = tempfile::NamedTempFile::new()?;
        let mut command = Command::new(std::env::current_exe()?);
        command.args(std::env::args_os().skip(1)).arg("--notes").arg(notes.path());
        if line.driver.is_none() {
            command.args(["--driver", driver.name()]);
        }
        if let Some(manifest) = manifest {
            command.env("VK_DRIVER_FILES", manifest).env("VK_ICD_FILENAMES", manifest);
        }
        // The distribution's layer misses hazards that the current one finds.
        if let Some(folder) = framewright_vulkan::layer::manifest_folder()? {
            command.env("VK_LAYER_PATH", folder);
        }
        let status = command.status()?;
        let code = status.code().and_then(|code| u8::try_from(code).ok());
        worst = worst.max(code.filter(|code| CODES.contains(code)).unwrap_or_else(|| {
            let last = std::fs::read_to_string(notes.path()).unwrap_or_default();
            println!("{} crashed ({status}) with {last}", driver.name());
            FAILED
        }));
        if worst == INTERRUPTED {
            break;
        }
    }
    Ok(worst)
}

static ASKED_TO_STOP: AtomicBool = AtomicBool::new(false);

/// Runs all pipelines on the driver that the environment offers.
fn here(line: &Line, notes: &Path) -> Result<u8, Box<dyn Error>> {
    // A panic of the compiler is reported as a fault, and may come a hundred times while it is shrunk.
    std::panic::set_hook(Box::new(|_| ()));
    ctrlc::set_handler(|| ASKED_TO_STOP.store(true, Ordering::Relaxed))?;
    let judge = Judge::new()?;
    let mut judge = match line.queues {
        Some(queues) => judge.with_three_queues(queues.sharing()),
        None => judge,
    };
    let allowed = match line.stereo {
        None => Allowed::today(),
        Some(stereo) => {
            judge = judge.for_two_eyes(stereo)?;
            Allowed::without(&[NOT_YET, &[Kind::Buffers]].concat())
        }
    };
    judge.spoil = line.spoil;
    let driver = line.driver.map_or("?", Driver::name);
    let orders = line.order.map_or(ChosenOrder::ALL.to_vec(), |order| vec![order]);
    let bar =
        ProgressBar::new(line.count).with_style(ProgressStyle::with_template("{prefix} {bar:30} {pos}/{len} {msg}")?);
    bar.set_prefix(driver);
    let (mut failures, mut executed, mut done) = (0, 0, 0);
    for seed in (line.seed..).take(usize::try_from(line.count)?) {
        if ASKED_TO_STOP.load(Ordering::Relaxed) || failures == line.failures {
            break;
        }
        let pipeline = generate::pipeline(seed, passes(seed, line.passes), &allowed);
        bar.set_message(format!("seed {seed}, {} passes", pipeline.passes.len()));
        if line.show {
            bar.suspend(|| println!("seed {seed}:\n{pipeline}"));
        }
        let expected = expected(&pipeline, line.frames.unwrap_or_else(|| frames(&pipeline)));
        for order in &orders {
            let replay = replay(line, seed, driver, *order);
            std::fs::write(notes, &replay)?;
            if let Err(fault) = judge.judge(&pipeline, &expected, &options(order.order(seed), seed)) {
                failures += 1;
                bar.suspend(|| println!("seed {seed} on {}, {} order: {fault}", judge.device(), order.name()));
                let (smallest, fault) = smaller(line, &mut judge, seed, *order, &pipeline, fault);
                let folder = line.write.join(format!("{seed}-{driver}-{}", order.name()));
                judge.write(&smallest, &options(order.order(seed), seed), &folder)?;
                bar.suspend(|| {
                    println!("shrunk to:\n{smallest}of which {fault}\nwritten to {}", folder.display());
                    println!("replay it with: {replay}\n");
                });
                break;
            }
            executed += 1;
        }
        done += 1;
        bar.inc(1);
    }
    bar.finish_and_clear();
    println!("{driver}: {done} pipelines, {executed} Plans executed, {failures} failures");
    Ok(if failures > 0 {
        FAILED
    } else if ASKED_TO_STOP.load(Ordering::Relaxed) {
        INTERRUPTED
    } else {
        FINE
    })
}

/// The smallest pipeline that fails alike, and how it fails.
fn smaller(
    line: &Line,
    judge: &mut Judge,
    seed: u64,
    order: ChosenOrder,
    pipeline: &Pipeline,
    fault: Fault,
) -> (Pipeline, Fault) {
    let mut last = fault.clone();
    let smallest = shrink::shrink(pipeline, |smaller| {
        if ASKED_TO_STOP.load(Ordering::Relaxed) {
            return false;
        }
        let judged = judge.judge(
            smaller,
            &expected(smaller, line.frames.unwrap_or_else(|| frames(smaller))),
            &options(order.order(seed), seed),
        );
        let Some(same) = judged.err().filter(|other| other.is_like(&fault)) else { return false };
        last = same;
        true
    });
    (smallest, last)
}

/// The command that does one pipeline again.
fn replay(line: &Line, seed: u64, driver: &str, order: ChosenOrder) -> String {
    let frames = line.frames.map_or(String::new(), |frames| format!(" --frames {frames}"));
    let queues = line.queues.map_or(String::new(), |queues| format!(" --queues {}", queues.name()));
    let stereo = line.stereo.map_or(String::new(), |stereo| format!(" --stereo {}", stereo.name()));
    format!(
        "cargo run -p framewright-tests --bin random_pipelines -- --seed {seed} --count 1 --passes {}{frames}{queues}{stereo} \
         --driver {driver} --order {}",
        line.passes,
        order.name()
    )
}
