//! `framewright check`: whether a pipeline is right, without a GPU.

use crate::args::{Check, CheckFormat};
use crate::error::{Error, Exit};
use crate::planning::{self, View};
use crate::values::DEFAULT_SIZE;
use crate::{every_device, notes, profiles, progress, text, variants};
use framewright_graph::base::{self, ReadFiles};
use framewright_graph::device::{Estimated, Profile};
use framewright_graph::plan::{Note, Plan, Totals};
use serde::Serialize;
use std::ffi::OsStr;

/// The answer for programs.
#[derive(Debug, Serialize)]
struct Answer {
    format_version: u32,
    pipeline: String,
    #[serde(flatten)]
    verdict: Verdict,
}

/// What comes of a pipeline on one device.
#[derive(Debug, Serialize)]
pub(crate) struct Verdict {
    /// The device's own name.
    pub(crate) device: String,
    /// Whether nothing is wrong.
    pub(crate) fine: bool,
    /// What is wrong with the pipeline, its settings or its shaders, or what the device can't do.
    pub(crate) diagnostics: serde_json::Value,
    /// What is wrong with the Plan that was made of it.
    pub(crate) violations: Vec<String>,
    /// Decisions that a reader may want to know of.
    pub(crate) notes: Vec<Note>,
    /// The Plan's sums; `null` if there is none.
    pub(crate) totals: Option<Totals>,
}

/// How a pipeline is looked at: nothing is known of a scene.
pub(crate) fn view(arguments: &Check) -> View<'static> {
    View { facts: None, size: DEFAULT_SIZE, rotation: arguments.planning.rotate, dump: &[] }
}

/// Checks a pipeline.
///
/// # Errors
/// In the form for people everything that is wrong is an error; in the form for programs the mistakes of the pipeline are
/// its answer.
pub(crate) fn check(arguments: &Check) -> Result<Exit, Error> {
    if arguments.all_variants {
        return variants::check(arguments);
    }
    if arguments.device.as_deref() == Some(OsStr::new(profiles::ALL)) {
        return every_device::check(arguments);
    }
    let profile = profiles::choose(arguments.device.as_deref(), &ReadFiles::default())?;
    let result = plan(arguments, &profile);
    match arguments.format {
        CheckFormat::Human => {
            let plan = result?;
            let fine = fine(arguments, &plan.device.name, &plan.totals);
            let notes = notes::lines(notes::told(&plan.notes)).into_iter().map(|line| line + "\n");
            text::print(&(fine + "\n" + &notes.collect::<String>())).map_err(Error::Print)?;
            Ok(Exit::Fine)
        }
        CheckFormat::Json => json(arguments, &profile, result),
    }
}

fn plan(arguments: &Check, profile: &Profile) -> Result<Plan, Error> {
    let busy = progress::busy("reading");
    let mut pipeline = planning::load(&arguments.pipeline, &ReadFiles::default())?;
    let frame = pipeline.frame(view(arguments), profile)?;
    busy.set_message(progress::compiling(&frame, &profile.name));
    let plan = pipeline.compile(&frame, profile, &mut Estimated(profile), &arguments.planning.options())?;
    pipeline.fits(&plan, &frame, profile)?;
    Ok(plan)
}

/// That all is well, and how much the frame takes.
pub(crate) fn fine(arguments: &Check, device: &str, totals: &Totals) -> String {
    let (pipeline, device) = (text::path(&arguments.pipeline.file), text::escape(device));
    format!("{pipeline}: fine on {device}: {}", sums(totals))
}

/// Sums of a Plan, in words.
pub(crate) fn sums(totals: &Totals) -> String {
    let waits = match totals.waits {
        0 => String::new(),
        waits => format!("{} between queues, ", text::count(waits as usize, "wait", "waits")),
    };
    format!(
        "{} in {}, {}, {}, {waits}{} placed in {} (estimated)",
        text::count((totals.passes + totals.inserted_passes) as usize, "pass", "passes"),
        text::count(totals.scopes as usize, "rendering scope", "rendering scopes"),
        text::count(totals.resolves as usize, "resolve", "resolves"),
        text::count((totals.image_barriers + totals.memory_barriers) as usize, "barrier", "barriers"),
        text::bytes(totals.transient_bytes),
        text::bytes(totals.placed_bytes),
    )
}

/// What comes of a pipeline on `device`.
///
/// # Errors
/// What is no matter of the pipeline: files that can't be read, and the like.
pub(crate) fn verdict(device: String, result: Result<Plan, Error>) -> Result<Verdict, Error> {
    let mut verdict = Verdict {
        device,
        fine: false,
        diagnostics: serde_json::Value::Array(Vec::new()),
        violations: Vec::new(),
        notes: Vec::new(),
        totals: None,
    };
    match result {
        Ok(plan) => {
            verdict.fine = true;
            verdict.notes = plan.notes;
            verdict.totals = Some(plan.totals);
        }
        Err(Error::Wrong { wrong }) => verdict.diagnostics = base::to_json(&wrong.sources, &wrong.diagnostics),
        Err(Error::Violations { violations }) => verdict.violations = violations,
        Err(other) => return Err(other),
    }
    Ok(verdict)
}

fn json(arguments: &Check, profile: &Profile, result: Result<Plan, Error>) -> Result<Exit, Error> {
    let exit = result.as_ref().map_or_else(Error::exit, |_| Exit::Fine);
    let pipeline = arguments.pipeline.file.to_string_lossy().into_owned();
    let answer = Answer { format_version: 1, pipeline, verdict: verdict(profile.name.clone(), result)? };
    text::print(&text::json(&answer)?).map_err(Error::Print)?;
    Ok(exit)
}
