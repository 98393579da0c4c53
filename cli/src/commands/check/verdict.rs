//! The verdict on a pipeline on one device.

use crate::command_line::args::CheckArguments;
use crate::error::Error;
use crate::planning::totals;
use crate::system::text;
use framewright_graph::describe;
use framewright_graph::plan::{Note, Plan, Totals};
use serde::Serialize;

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

/// The verdict on `device`.
///
/// # Errors
/// What the pipeline is not to blame for, such as files that can't be read.
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
        Err(Error::Mistakes { mistakes }) => {
            verdict.diagnostics = describe::to_json(&mistakes.sources, &mistakes.diagnostics)
        }
        Err(Error::Violations { violations }) => verdict.violations = violations,
        Err(other) => return Err(other),
    }
    Ok(verdict)
}

/// That all is well, and how much the frame takes.
pub(crate) fn fine(arguments: &CheckArguments, device: &str, totals: &Totals) -> String {
    let (pipeline, device) = (text::path(&arguments.pipeline.file), text::escape(device));
    format!("{pipeline}: fine on {device}: {}", totals::sentence(totals))
}
