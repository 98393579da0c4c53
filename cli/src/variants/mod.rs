//! `framewright check --all-variants`: every combination of settings, facts of the scene and devices.
//!
//! ```text
//! files ─► axes (mentions) ─► space (cover) ─► run: judge, judge, … on all processors ─► causes (minimise) ─► report
//! ```
//!
//! Variants that agree on all settings and facts that are read share one verdict (`decisions`).

mod axes;
mod axis;
mod causes;
mod checker;
mod decisions;
mod facts;
mod identity;
mod minimise;
mod report;
mod run;
mod shaders;
mod space;
mod summary;

use crate::budget;
use crate::command_line::args::{CheckArguments, CheckFormat};
use crate::error::Error;
use crate::findings;
use crate::planning::{self, device};
use crate::system::counted_work::{Progress, Words};
use crate::system::{Exit, interrupt, text};
use axes::Axes;
use checker::{CheckedPipeline, VariantChecker};
use decisions::SharedDecisions;
use framewright::Pipeline;
use framewright_graph::base::{self, ReadFiles};
use framewright_graph::device::Profile;
use report::Report;
use shaders::SharedShaders;
use space::{MOST_VARIANTS, Space};
use std::ffi::OsStr;
use std::num::NonZero;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Checks all variants of a pipeline.
///
/// # Errors
/// Mistakes that every variant has; in the form for programs those are the answer. If there are too many pairs of values.
pub(crate) fn check(arguments: &CheckArguments) -> Result<Exit, Error> {
    let report = match report(arguments) {
        Err(Error::Mistakes { mistakes }) if arguments.format != CheckFormat::Human && mistakes.exit != Exit::Usage => {
            Report {
                diagnostics: base::to_json(&mistakes.sources, &mistakes.diagnostics),
                ..Report::of_nothing(arguments)
            }
        }
        report => report?,
    };
    let answer = match arguments.format {
        CheckFormat::Human => summary::human(&report),
        CheckFormat::Json => text::json(&report)?,
        format => findings::shown(format, &report.pipeline, &summary::cases(&report))?.unwrap_or_default(),
    };
    text::print(&answer).map_err(Error::Print)?;
    Ok(match (report.interrupted, report.fine) {
        (true, _) => Exit::Interrupted,
        (false, true) => Exit::Fine,
        (false, false) => Exit::Found,
    })
}

fn report(arguments: &CheckArguments) -> Result<Report, Error> {
    let devices = devices(arguments)?;
    let mut loaded = planning::load(&arguments.pipeline, &ReadFiles::default())?;
    let budget = budget::read(arguments.budget.as_deref(), &mut loaded)?;
    let choices = planning::choices(&arguments.pipeline, arguments.size, arguments.planning.rotate);
    loaded.check([&choices])?;
    let Pipeline { document, sources, assets, .. } = loaded;
    let (names, devices): (Vec<String>, _) = devices.into_iter().unzip();
    let axes = Axes::of(&document, &sources, &choices.set, &names);
    let sizes = axes.sizes();
    let presets = axes.variants_of_presets();
    let (space, beyond) = match arguments.pairwise {
        true => (Space::pairwise(&sizes, presets)?, None),
        false => Space::all_or_pairwise(sizes, presets)?,
    };
    if let Some(combinations) = beyond {
        text::say(&format!(
            "note: there are {combinations} combinations, and of more than {MOST_VARIANTS} each pair of values is checked, as by `--pairwise`; \
             settings that `--set` chooses don't vary"
        ));
    }
    let subject = CheckedPipeline {
        pipeline: &document,
        sources: &sources,
        choices,
        axes,
        devices,
        options: arguments.planning.options(),
        budget: &budget,
    };
    // Until here nothing is lost when the system ends the program.
    interrupt::watch();

    let library = Mutex::new(assets.shaders);
    let decisions = SharedDecisions::of(subject.devices.len());
    let threads = arguments.threads.map_or_else(processors, usize::from);
    let words = Words { doing: "checking", done: "checked", things: "variants" };
    let progress = Progress::new(space.len(), 0, words, Duration::from_secs(5));
    let mut found = run::run(&subject, &space, &library, &decisions, threads, &progress);
    progress.finish();
    let failures = std::mem::take(&mut found.failures);
    let distinct = failures.len();
    let mut checker = VariantChecker::new(&subject, SharedShaders::new(&library), &decisions);
    let causes = causes::find(failures, &space, &mut checker);
    let further = distinct - causes.len();
    Ok(Report { further_failures: further, ..Report::new(arguments, &subject, &space, found, causes) })
}

/// The devices that `--device` names.
fn devices(arguments: &CheckArguments) -> Result<Vec<(String, Arc<Profile>)>, Error> {
    let device = arguments.device.as_deref();
    if device == Some(OsStr::new(device::ALL)) {
        let all = device::all()?;
        return Ok(all.into_iter().map(|(name, profile)| (name.to_owned(), Arc::new(profile))).collect());
    }
    let profile = device::choose(device, &ReadFiles::default())?;
    let name = device.map_or_else(|| profile.name.clone(), |name| name.to_string_lossy().into_owned());
    Ok(vec![(name, Arc::new(profile))])
}

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, NonZero::get)
}
