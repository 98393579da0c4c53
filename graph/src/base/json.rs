//! Mistakes as JSON, for editors and other programs.

use super::render::{shown, shown_lines};
use super::{Diagnostic, Label, MOST_KEPT, Quote, Sources, Span};
use serde_json::{Value, json};
use std::ops::Range;

/// Mistakes as a JSON list. Each has `code`, `message`, `help` (or null) and `labels`, and of its primary place, unless no file
/// is involved, `file` as the user named it, `line` and `column` from 1, and `end` with `line` and `column` of the first
/// character after it. Columns count characters. Messages, remarks and help are escaped as in
/// [`render`](super::render()); the file's name is not. At most 256 are told; a last one without a place says so.
#[must_use]
pub fn to_json(sources: &Sources, diagnostics: &[Diagnostic]) -> Value {
    let told = diagnostics.iter().take(MOST_KEPT).map(|diagnostic| one(sources, diagnostic));
    let more = "there may be more mistakes: no others were kept";
    let more = (diagnostics.len() >= MOST_KEPT).then(|| json!({ "message": more, "help": null, "labels": [] }));
    told.chain(more).collect()
}

fn one(sources: &Sources, diagnostic: &Diagnostic) -> Value {
    let mut labels: Vec<Value> = diagnostic
        .labels
        .iter()
        .map(|label| {
            let mut value = place(sources, label);
            value["text"] = json!(shown(&label.text));
            value
        })
        .collect();
    labels.extend(diagnostic.quotes.iter().map(quoted));
    let mut value = diagnostic.labels.first().map_or_else(|| json!({}), |label| place(sources, label));
    value["code"] = json!(diagnostic.code.to_string());
    value["message"] = json!(shown(&diagnostic.message));
    value["help"] = json!(diagnostic.help.as_deref().map(shown_lines));
    value["labels"] = json!(labels);
    value
}

/// A line of another file, which is placed as labels are.
fn quoted(Quote { file, line, text, underlined, remark }: &Quote) -> Value {
    let column = |at: usize| text[..text.floor_char_boundary(at)].chars().count() + 1;
    json!({
        "file": file,
        "line": line,
        "column": column(underlined.start),
        "end": { "line": line, "column": column(underlined.end) },
        "text": shown(remark),
    })
}

fn place(sources: &Sources, label: &Label) -> Value {
    let file = label.span.file().and_then(|file| sources.file(file));
    let (Some(file), Some(start)) = (file, sources.place(label.span)) else { return json!({}) };
    let length = file.text[within_line(&file.text, label.span)].chars().count();
    json!({
        "file": file.shown,
        "line": start.line,
        "column": start.column,
        "end": { "line": start.line, "column": start.column as usize + length },
    })
}

/// The bytes of a span that stand on its first line, moved to whole characters.
pub(super) fn within_line(text: &str, span: Span) -> Range<usize> {
    let start = text.floor_char_boundary((span.start as usize).min(text.len()));
    let end = text.ceil_char_boundary((span.end as usize).clamp(start, text.len()));
    let line = text[start..end].find(['\n', '\r']).map_or(end, |at| start + at);
    start..line
}
