//! A Plan from a file. It may come from anyone: it is read within bounds, and verified before anything is done with it.

use super::options;
use crate::command_line::args::PipelineArguments;
use crate::command_line::subject::SubjectArguments;
use crate::command_line::values::MAX_SIZE;
use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use framewright::{Assets, Helper};
use framewright_graph::base::ReadFiles;
use framewright_graph::plan::Plan;
use framewright_graph::verify;
use std::path::Path;

/// A file of a Plan has at most this many bytes.
const LARGEST: usize = 1 << 30;

/// Whether a file is a Plan, where a pipeline may be named too.
#[must_use]
pub(crate) fn is_one(path: &Path) -> bool {
    path.extension().is_some_and(|end| end.eq_ignore_ascii_case("json"))
}

/// Refuses an option that chooses something, which a Plan leaves nothing of. `own` is one of the command's own that is given.
///
/// # Errors
/// [`Error::ChoiceForPlan`].
pub(crate) fn nothing_chosen(
    pipeline: &PipelineArguments,
    subject: &SubjectArguments,
    own: Option<&'static str>,
) -> Result<(), Error> {
    match pipeline.chosen().or(subject.planning.chosen()).or(own).or(subject.chosen()) {
        Some(option) => Err(Error::ChoiceForPlan { option, path: pipeline.file.clone() }),
        None => Ok(()),
    }
}

/// The Plan that a file holds, verified.
///
/// # Errors
/// If the file can't be read, is no Plan, or is one that breaks rules.
pub(crate) fn read(path: &Path, read: &ReadFiles) -> Result<Plan, Error> {
    let text = inputs::text(FileRole::PLAN, path, LARGEST, read)?;
    let wrong = |problem: String| Error::NoPlan { path: path.to_owned(), problem };
    let plan = Plan::from_json(&text).map_err(|problem| wrong(problem.to_string()))?;
    let violations = verify::verify(&plan);
    match violations.split_first() {
        None => Ok(plan),
        Some((first, others)) => {
            let more = if others.is_empty() { String::new() } else { format!(" (and {} more)", others.len()) };
            Err(wrong(format!("the Plan is not right: {first}{more}")))
        }
    }
}

/// The Plan that the command line names, with the files that it names in turn: they are looked for where a pipeline's are.
///
/// # Errors
/// Those of [`read`]; if the output has no size that a command takes; if the Plan lies outside of the folder that `--root` names.
pub(crate) fn load(
    arguments: &PipelineArguments,
    helper: Helper,
    recorded: &ReadFiles,
) -> Result<(Plan, Assets), Error> {
    let plan = read(&arguments.file, recorded)?;
    if let Some(side) = plan.extent.into_iter().find(|side| !(1..=MAX_SIZE).contains(side)) {
        let problem = format!("`extent`: a side of {side} pixels; a side has 1 to {MAX_SIZE}");
        return Err(Error::NoPlan { path: arguments.file.clone(), problem });
    }
    let root = framewright::folder_of(&arguments.file, &inputs::options(arguments).reach)?;
    let options = options(arguments, helper, recorded)?;
    Ok((plan, Assets::new(Some(&root), &options, recorded)))
}
