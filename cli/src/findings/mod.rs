//! What a check found, in the forms of code hosts and CI systems: SARIF, JUnit, annotations of GitHub.

mod finding;
mod github;
mod junit;
mod sarif;

pub(crate) use finding::Case;

use crate::command_line::args::CheckFormat;

/// The findings in one of the forms for CI; `None` for the forms that `check` itself has.
///
/// # Errors
/// If they have no JSON form.
pub(crate) fn shown(format: CheckFormat, pipeline: &str, cases: &[Case]) -> serde_json::Result<Option<String>> {
    Ok(match format {
        CheckFormat::Human | CheckFormat::Json => None,
        CheckFormat::Sarif => Some(sarif::sarif(pipeline, cases)?),
        CheckFormat::Junit => Some(junit::junit(pipeline, cases)),
        CheckFormat::Github => Some(github::github(pipeline, cases)),
    })
}
