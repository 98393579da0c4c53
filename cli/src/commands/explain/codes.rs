//! The codes of mistakes, explained.

use crate::command_line::values::AnswerFormat;
use crate::error::Error;
use crate::system::text;
use framewright_graph::base::{Code, suggestion};
use serde::Serialize;

/// The answer for programs.
#[derive(Serialize)]
struct Answer {
    format_version: u32,
    code: String,
    title: &'static str,
    /// Markdown, in lines.
    explanation: String,
}

/// The explanation of a code, in capitals or not.
///
/// # Errors
/// If there is no such code.
pub(super) fn explained(shown: &str, format: AnswerFormat) -> Result<String, Error> {
    let capitals = shown.to_uppercase();
    let unknown = || {
        let all: Vec<String> = Code::all().map(|code| code.to_string()).collect();
        Error::UnknownCode { code: shown.to_owned(), help: suggestion(&capitals, all.iter().map(String::as_str)) }
    };
    let code = Code::find(&capitals).ok_or_else(unknown)?;
    let (title, explanation) = (code.title(), code.explanation());
    Ok(match format {
        AnswerFormat::Human => format!("{code}: {title}\n\n{explanation}\n"),
        AnswerFormat::Json => text::json(&Answer { format_version: 1, code: code.to_string(), title, explanation })?,
    })
}
