//! `framewright facts`: the facts of a scene that conditions can use, and what decided each.

use crate::command_line::args::FactsArguments;
use crate::error::Error;
use crate::files::inputs;
use crate::system::{Exit, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::language::FactValue;
use framewright_passes::facts::ExplainedFact;
use serde::Serialize;

#[derive(Debug, Serialize)]
struct Answer<'a> {
    format_version: u32,
    facts: Vec<Entry<'a>>,
}

#[derive(Debug, Serialize)]
struct Entry<'a> {
    name: &'static str,
    #[serde(rename = "type")]
    ty: String,
    value: serde_json::Value,
    about: &'static str,
    /// The reason for the value, or nothing.
    because: &'a str,
}

/// Prints the facts of a scene.
///
/// # Errors
/// If the scene can't be read.
pub(crate) fn facts(arguments: &FactsArguments) -> Result<Exit, Error> {
    let found = inputs::scene(&arguments.scene, arguments.reading.strict, &ReadFiles::default())?.explained();
    let shown = if arguments.json {
        text::json(&Answer { format_version: 1, facts: found.iter().map(entry).collect() })?
    } else {
        found.iter().map(line).collect()
    };
    text::print(&shown).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

fn line(found: &ExplainedFact) -> String {
    let because = if found.because.is_empty() { String::new() } else { format!(" ({})", text::escape(&found.because)) };
    format!("{}: {}{because}\n", found.fact.name(), found.value)
}

fn entry(found: &ExplainedFact) -> Entry<'_> {
    Entry {
        name: found.fact.name(),
        ty: found.fact.ty().to_string(),
        value: match found.value {
            FactValue::Bool(value) => value.into(),
            FactValue::Integer(value) => value.into(),
            FactValue::Number(value) => value.into(),
        },
        about: found.fact.about(),
        because: &found.because,
    }
}
