//! `framewright check` on one device.

use super::verdict::{Verdict, fine, print_findings, verdict};
use crate::budget;
use crate::command_line::args::{CheckArguments, CheckFormat};
use crate::error::Error;
use crate::findings::Case;
use crate::planning::{self, device, notes};
use crate::system::{Exit, progress, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::plan::{Plan, UsedFeature};
use serde::Serialize;

/// The answer for programs.
#[derive(Debug, Serialize)]
struct Answer {
    format_version: u32,
    pipeline: String,
    #[serde(flatten)]
    verdict: Verdict,
    /// The features of a device that the Plan uses; `null` if there is no Plan.
    features: Option<Vec<UsedFeature>>,
}

/// Checks a pipeline on the device that `--device` names.
///
/// # Errors
/// Those of [`super::check`].
pub(crate) fn check(arguments: &CheckArguments) -> Result<Exit, Error> {
    let profile = device::choose(arguments.device.as_deref(), &ReadFiles::default())?;
    let result = plan(arguments, &profile);
    match arguments.format {
        CheckFormat::Human => {
            let (plan, _) = result?;
            let fine = fine(arguments, &plan.device.name, &plan.totals);
            let notes = notes::lines(notes::worth_showing(&plan.notes)).into_iter().map(|line| line + "\n");
            text::print(&(fine + "\n" + &notes.collect::<String>())).map_err(Error::Print)?;
            Ok(Exit::Fine)
        }
        CheckFormat::Json => json(arguments, &profile, result),
        format => for_ci(arguments, format, &profile, result.map(|(plan, _)| plan)),
    }
}

/// The Plan, and the features of a device that it uses.
fn plan(arguments: &CheckArguments, profile: &Profile) -> Result<(Plan, Vec<UsedFeature>), Error> {
    let busy = progress::busy("reading");
    let mut pipeline = planning::load(&arguments.pipeline, &ReadFiles::default())?;
    let budget = budget::read(arguments.budget.as_deref(), &mut pipeline)?;
    let choices = planning::choices(&arguments.pipeline, arguments.size, arguments.planning.rotate);
    let frame = pipeline.frame(&choices, profile)?;
    busy.set_message(progress::compiling(&frame, &profile.name));
    let plan = pipeline.compile(&frame, profile, &mut MemoryEstimate(profile), &arguments.planning.options())?;
    pipeline.fits(&plan, &frame, profile)?;
    budget.holds(&plan, &pipeline.sources)?;
    let features = pipeline.features(&plan)?;
    Ok((plan, features))
}

fn for_ci(
    arguments: &CheckArguments,
    format: CheckFormat,
    profile: &Profile,
    result: Result<Plan, Error>,
) -> Result<Exit, Error> {
    let exit = result.as_ref().map_or_else(Error::exit, |_| Exit::Fine);
    let Verdict { device, diagnostics, violations, .. } = verdict(profile.name.clone(), result)?;
    let case = Case::new(device, &diagnostics).violations(&violations);
    print_findings(arguments, format, &[case])?;
    Ok(exit)
}

fn json(
    arguments: &CheckArguments,
    profile: &Profile,
    result: Result<(Plan, Vec<UsedFeature>), Error>,
) -> Result<Exit, Error> {
    let exit = result.as_ref().map_or_else(Error::exit, |_| Exit::Fine);
    let features = result.as_ref().ok().map(|(_, features)| features.clone());
    let result = result.map(|(plan, _)| plan);
    let pipeline = arguments.pipeline.file.to_string_lossy().into_owned();
    let answer = Answer { format_version: 1, pipeline, verdict: verdict(profile.name.clone(), result)?, features };
    text::print(&text::json(&answer)?).map_err(Error::Print)?;
    Ok(exit)
}
