//! The verdict on a pipeline on one device.

use crate::command_line::args::{CheckArguments, CheckFormat};
use crate::error::Error;
use crate::findings::{self, Case};
use crate::planning::totals;
use crate::system::text;
use framewright_graph::base;
use framewright_graph::plan::{Note, Plan, Totals};
use serde::Serialize;

/// The verdict on one device.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Verdict {
    /// The device's own name.
    pub(crate) device: String,
    /// Whether nothing is wrong.
    pub(crate) fine: bool,
    /// Mistakes of the pipeline, its settings or its shaders, and features that the device lacks.
    pub(crate) diagnostics: serde_json::Value,
    /// Violations that `verify` found in the Plan.
    pub(crate) violations: Vec<String>,
    /// Decisions that a reader may want to know of.
    pub(crate) notes: Vec<Note>,
    /// The Plan's sums; `null` if there is none.
    pub(crate) totals: Option<Totals>,
}

/// The verdict on `device`.
///
/// # Errors
/// Errors that aren't the pipeline's, such as files that can't be read.
pub(crate) fn verdict(device: String, result: Result<Plan, Error>) -> Result<Verdict, Error> {
    let mut verdict = Verdict { device, diagnostics: serde_json::Value::Array(Vec::new()), ..Verdict::default() };
    match result {
        Ok(plan) => {
            verdict.fine = true;
            verdict.notes = plan.notes;
            verdict.totals = Some(plan.totals);
        }
        Err(Error::Mistakes { mistakes }) => {
            verdict.diagnostics = base::to_json(&mistakes.sources, &mistakes.diagnostics)
        }
        Err(Error::Violations { violations }) => verdict.violations = violations,
        Err(other) => return Err(other),
    }
    Ok(verdict)
}

/// Prints findings in one of the forms for CI.
///
/// # Errors
/// If they can't be printed.
pub(crate) fn print_findings(arguments: &CheckArguments, format: CheckFormat, cases: &[Case]) -> Result<(), Error> {
    let shown = findings::shown(format, &arguments.pipeline.file.to_string_lossy(), cases)?;
    text::print(&shown.unwrap_or_default()).map_err(Error::Print)
}

/// The sentence for a pipeline without mistakes, with its Plan's totals.
pub(crate) fn fine(arguments: &CheckArguments, device: &str, totals: &Totals) -> String {
    let (pipeline, device) = (text::path(&arguments.pipeline.file), text::escape(device));
    format!("{pipeline}: fine on {device}: {}", totals::estimated(totals))
}
