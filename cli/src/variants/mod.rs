//! `framewright check --all-variants`: every combination of settings, facts of the scene and devices.
//!
//! ```text
//! files ─► axes (mentions) ─► space (cover) ─► run: judge, judge, … on all processors ─► causes (minimise) ─► report
//! ```

mod axes;
mod causes;
mod cover;
mod facts;
mod identity;
mod judge;
mod mentions;
mod minimise;
mod progress;
mod report;
mod run;
mod shaders;
mod space;
mod words;

use crate::args::{Check, CheckFormat};
use crate::error::{Error, Exit};
use crate::planning::{self, Loaded};
use crate::{check, interrupt, profiles, text};
use axes::Axes;
use framewright_graph::base::{self, ReadFiles};
use framewright_graph::device::Profile;
use judge::{Judge, Subject};
use progress::Progress;
use report::Report;
use shaders::Shared;
use space::Space;
use std::ffi::OsStr;
use std::num::NonZero;
use std::sync::{Arc, Mutex};

/// Checks all variants of a pipeline.
///
/// # Errors
/// In the form for people what is wrong whatever the variant; in the form for programs the mistakes of the pipeline are its
/// answer. If there are too many variants.
pub(crate) fn check(arguments: &Check) -> Result<Exit, Error> {
    let report = match report(arguments) {
        Err(Error::Wrong { wrong }) if arguments.format == CheckFormat::Json && wrong.exit != Exit::Usage => {
            Report { diagnostics: base::to_json(&wrong.sources, &wrong.diagnostics), ..Report::of_nothing(arguments) }
        }
        report => report?,
    };
    let answer = match arguments.format {
        CheckFormat::Human => words::human(&report),
        CheckFormat::Json => text::json(&report)?,
    };
    text::print(&answer).map_err(Error::Print)?;
    Ok(match (report.interrupted, report.fine) {
        (true, _) => Exit::Interrupted,
        (false, true) => Exit::Fine,
        (false, false) => Exit::Found,
    })
}

fn report(arguments: &Check) -> Result<Report, Error> {
    let devices = devices(arguments)?;
    let loaded = planning::load(&arguments.pipeline, &ReadFiles::default())?;
    let view = check::view(arguments);
    loaded.check_command_line(view)?;
    let Loaded { pipeline, sources, shaders, set, stereo, .. } = loaded;
    let (names, devices): (Vec<String>, _) = devices.into_iter().unzip();
    let axes = Axes::of(&pipeline, &sources, &set, &names);
    let sizes = axes.sizes();
    let presets = axes.variants_of_presets();
    let space = if arguments.pairwise { Space::pairwise(&sizes, presets)? } else { Space::all(sizes, presets)? };
    let subject = Subject {
        pipeline: &pipeline,
        sources: &sources,
        view,
        axes,
        devices,
        options: arguments.planning.options(),
        stereo,
    };
    // Until here nothing is lost when the system ends the program.
    interrupt::watch();

    let library = Mutex::new(shaders);
    let threads = arguments.threads.map_or_else(processors, usize::from);
    let progress = Progress::new(space.len());
    let mut found = run::run(&subject, &space, &library, threads, &progress);
    progress.finish();
    let failures = std::mem::take(&mut found.failures);
    let distinct = failures.len();
    let causes = causes::find(failures, &space, &mut Judge::new(&subject, Shared::new(&library)));
    let further = distinct - causes.len();
    Ok(Report { further_failures: further, ..Report::new(arguments, &subject, &space, found, causes) })
}

/// The devices that `--device` names.
fn devices(arguments: &Check) -> Result<Vec<(String, Arc<Profile>)>, Error> {
    let device = arguments.device.as_deref();
    if device == Some(OsStr::new(profiles::ALL)) {
        let all = profiles::all()?;
        return Ok(all.into_iter().map(|(name, profile)| (name.to_owned(), Arc::new(profile))).collect());
    }
    let profile = profiles::choose(device, &ReadFiles::default())?;
    let name = device.map_or_else(|| profile.name.clone(), |name| name.to_string_lossy().into_owned());
    Ok(vec![(name, Arc::new(profile))])
}

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, NonZero::get)
}
