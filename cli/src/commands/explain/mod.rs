//! `framewright explain`: why something is in a Plan, or isn't, in a few lines. Without a GPU.

mod codes;
mod subject;

use crate::command_line::explaining::{ExplainArguments, ThingArguments};
use crate::command_line::values::AnswerFormat;
use crate::error::Error;
use crate::planning::{self, plan_file};
use crate::system::{Exit, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::plan::{Outline, Plan};
use serde::Serialize;
use subject::Explanation;

/// The answer for programs.
#[derive(Debug, Serialize)]
struct Answer<'a> {
    format_version: u32,
    thing: &'a str,
    device: &'a str,
    /// What there is to say, each with the lines under it.
    explanations: Vec<Outline>,
    /// Where to read on.
    read_on: Vec<String>,
}

/// Explains a code, or a thing in a Plan.
///
/// # Errors
/// If the pipeline, the scene or the profile is wrong, or there is no such code or thing.
pub(crate) fn explain(arguments: &ExplainArguments) -> Result<Exit, Error> {
    let answer = match arguments {
        ExplainArguments::Code { code, format } => codes::explained(code, *format)?,
        ExplainArguments::Thing(arguments) => explained(arguments)?,
    };
    text::print(&answer).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

fn explained(arguments: &ThingArguments) -> Result<String, Error> {
    let read = ReadFiles::default();
    let plan = plan(arguments, &read)?;
    let thing = arguments.thing.as_str();
    let Explanation { explanations, read_on } = subject::explained(&plan, thing)
        .ok_or_else(|| Error::NothingToExplain { thing: thing.to_owned(), help: subject::names_near(&plan, thing) })?;
    let read_on: Vec<String> = read_on.into_iter().map(str::to_owned).collect();
    Ok(match arguments.format {
        AnswerFormat::Human => {
            let told: Vec<String> = explanations.iter().map(|one| text::escape_lines(&one.draw())).collect();
            format!("{}\nread on: {}\n", told.join("\n"), read_on.join("; "))
        }
        AnswerFormat::Json => {
            text::json(&Answer { format_version: 1, thing, device: &plan.device.name, explanations, read_on })?
        }
    })
}

/// The Plan in a file, or that of a pipeline.
fn plan(arguments: &ThingArguments, read: &ReadFiles) -> Result<Plan, Error> {
    let ThingArguments { pipeline, subject, .. } = arguments;
    if plan_file::is_one(&pipeline.file) {
        plan_file::nothing_chosen(pipeline, subject, None)?;
        return plan_file::read(&pipeline.file, read);
    }
    Ok(planning::planned(pipeline, subject, read)?.1.plan)
}
