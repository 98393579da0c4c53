//! What the RON reader says, in an author's words and at the right place.

use super::{Diagnostic, suggest};
use crate::source::Span;
use ron::error::{Error, Position, SpannedError};

/// Turns an error inside `text` (a slice of the file) into a mistake. `what` names the value that was read.
pub(super) fn reword(error: &SpannedError, text: &str, what: &str, span: impl Fn(&str) -> Span) -> Diagnostic {
    let place = place(error, text);
    let part = &text[place.clone()];
    let at = |message: String| Diagnostic::new(span(part), message);
    match &error.code {
        Error::NoSuchStructField { expected, found, .. } => {
            let help = suggest::help(found, expected.iter().copied());
            let field = text[..place.end].rfind(found.as_str()).map_or(part, |start| &text[start..start + found.len()]);
            let unknown = Diagnostic::new(span(field), format!("{what} has no field `{found}`"));
            Diagnostic { help, ..unknown }
        }
        Error::MissingStructField { field, .. } => {
            let open = &text[..text.chars().next().map_or(0, char::len_utf8)];
            Diagnostic::new(span(open), format!("{what} lacks the field `{field}`"))
        }
        Error::DuplicateStructField { field, .. } => at(format!("{what} has the field `{field}` twice")),
        Error::ExpectedDifferentLength { expected, found } => {
            let wanted = expected.rsplit(' ').next().unwrap_or_default();
            at(format!("{what} takes {wanted} values, found {found}"))
        }
        Error::ExpectedDifferentStructName { expected, found } => {
            at(format!("expected `{expected}(…)`, found `{found}`"))
        }
        Error::ExpectedNamedStructLike(name) if !name.is_empty() => at(format!("expected `{name}(…)`")),
        Error::ExceededRecursionLimit => {
            at("brackets are nested too deeply".to_owned()).help("no file needs more than a dozen levels")
        }
        Error::Eof | Error::ExpectedStringEnd => {
            at("the file ends in the middle of a value".to_owned()).help("is a bracket or a quote left open?")
        }
        Error::IntegerOutOfBounds => at("this whole number is too large".to_owned()),
        Error::InvalidValueForType { expected, found } => at(format!("expected {expected}, found {found}")),
        Error::UnexpectedChar(c) => at(format!("unexpected character `{}`", c.escape_debug())),
        Error::TrailingCharacters => at("something stands after the last bracket".to_owned()),
        Error::ExpectedComma => at("expected a comma".to_owned()),
        Error::ExpectedMapColon => at("expected a colon".to_owned()),
        Error::ExpectedIdentifier => at("expected the name of a field".to_owned()),
        Error::ExpectedStructLike | Error::ExpectedNamedStructLike(_) => {
            at("expected `(`".to_owned()).help(format!("{what} is written `(field: value, …)`"))
        }
        Error::ExpectedStructLikeEnd => at("expected `)`".to_owned()),
        Error::ExpectedArrayEnd => at("expected `]`".to_owned()),
        Error::ExpectedMapEnd => at("expected `}`".to_owned()),
        other => {
            let words = other.to_string();
            let mut letters = words.chars();
            let first = letters.next().map(|c| c.to_lowercase().to_string()).unwrap_or_default();
            at(first + letters.as_str())
        }
    }
}

/// The part of `text` that the error is about, in bytes. Never empty unless at the text's end.
fn place(error: &SpannedError, text: &str) -> std::ops::Range<usize> {
    let start = offset(text, error.span.start);
    // The reader's position may be on the blanks before what it stumbled over.
    let start = start + (text[start..].len() - text[start..].trim_start().len());
    let start = if start < text.len() { start } else { text.trim_end().len() };
    let mut end = offset(text, error.span.end).max(start);
    if end == start {
        end = start + text[start..].chars().next().map_or(0, char::len_utf8);
    }
    start..end
}

/// The byte at a position that counts lines and characters from 1.
fn offset(text: &str, position: Position) -> usize {
    let line: usize = text.split_inclusive('\n').take(position.line.saturating_sub(1)).map(str::len).sum();
    let rest = &text[line..];
    line + rest.char_indices().nth(position.col.saturating_sub(1)).map_or(rest.len(), |(at, _)| at)
}
