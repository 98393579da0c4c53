//! `framewright check`: whether a pipeline is right, without a GPU.

use crate::args::{Check, CheckFormat, DEFAULT_SIZE};
use crate::error::{Error, Exit};
use crate::planning::{self, View};
use crate::{profiles, text};
use framewright_graph::compile::Options;
use framewright_graph::describe;
use framewright_graph::device::{Estimated, Profile};
use framewright_graph::plan::{Note, Plan, Stage};
use serde::Serialize;

/// The answer for programs.
#[derive(Debug, Serialize)]
struct Answer {
    format_version: u32,
    pipeline: String,
    device: String,
    /// Whether nothing is wrong.
    fine: bool,
    /// What is wrong with the pipeline, its settings or its shaders.
    diagnostics: serde_json::Value,
    /// What is wrong with the Plan that was made of it.
    violations: Vec<String>,
    /// Decisions that a reader may want to know of.
    notes: Vec<Note>,
}

/// Checks a pipeline.
///
/// # Errors
/// In the form for people everything that is wrong is an error; in the form for programs the mistakes of the pipeline are
/// its answer.
pub(crate) fn check(arguments: &Check) -> Result<Exit, Error> {
    let profile = profiles::choose(arguments.device.as_deref())?;
    let result = plan(arguments, &profile);
    match arguments.format {
        CheckFormat::Human => result.and_then(|plan| human(arguments, &plan)),
        CheckFormat::Json => json(arguments, &profile, result),
    }
}

fn plan(arguments: &Check, profile: &Profile) -> Result<Plan, Error> {
    let mut pipeline = planning::load(&arguments.pipeline)?;
    let view = View { facts: None, size: DEFAULT_SIZE, dump: &[] };
    pipeline.plan(view, profile, &mut Estimated(&profile.memory), &Options::default()).map(|planned| planned.plan)
}

fn human(arguments: &Check, plan: &Plan) -> Result<Exit, Error> {
    let totals = &plan.totals;
    let mut answer = format!(
        "{}: fine on {}: {} in {}, {}, {}, {} of images in {} (estimated)\n",
        text::path(&arguments.pipeline.file),
        text::escape(&plan.device.name),
        text::count((totals.passes + totals.inserted_passes) as usize, "pass", "passes"),
        text::count(totals.scopes as usize, "rendering scope", "rendering scopes"),
        text::count(totals.resolves as usize, "resolve", "resolves"),
        text::count((totals.image_barriers + totals.memory_barriers) as usize, "barrier", "barriers"),
        text::bytes(totals.transient_bytes),
        text::bytes(totals.placed_bytes),
    );
    // Why scopes are separate is for those who look into the Plan.
    for note in plan.notes.iter().filter(|note| note.stage != Stage::Scope) {
        let at = note.at.as_ref().map_or_else(String::new, |place| format!(" ({})", text::escape(&place.to_string())));
        answer += &format!("note: `{}`: {}{at}\n", text::escape(&note.subject), text::escape(&note.text));
    }
    text::print(&answer).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

fn json(arguments: &Check, profile: &Profile, result: Result<Plan, Error>) -> Result<Exit, Error> {
    let mut answer = Answer {
        format_version: 1,
        pipeline: arguments.pipeline.file.to_string_lossy().into_owned(),
        device: profile.name.clone(),
        fine: false,
        diagnostics: serde_json::Value::Array(Vec::new()),
        violations: Vec::new(),
        notes: Vec::new(),
    };
    let exit = result.as_ref().map_or_else(Error::exit, |_| Exit::Fine);
    match result {
        Ok(plan) => {
            answer.fine = true;
            answer.notes = plan.notes;
        }
        Err(Error::Wrong { wrong }) => answer.diagnostics = describe::to_json(&wrong.sources, &wrong.diagnostics),
        Err(Error::Violations { violations }) => answer.violations = violations,
        Err(other) => return Err(other),
    }
    text::print(&text::json(&answer)?).map_err(Error::Print)?;
    Ok(exit)
}
