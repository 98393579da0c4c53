//! Mistakes as text: `error: … [E0207]`, `file:line:column`, the offending text underlined, the help.

use super::shorten::bounded;
use super::{Diagnostic, MOST_KEPT, Quote, Sources};
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use std::fmt::Write as _;
use std::ops::Range;

/// At most this many mistakes are shown; the rest are counted.
const MOST_SHOWN: usize = 20;

/// Labels further apart than this many bytes are shown apart; the text of a longer line is not shown.
const LARGEST_WINDOW: usize = 8192;

/// Text from a file, fit to be shown: control characters, and others that are invisible or turn the direction of the text
/// behind them, are escaped. All others stay.
#[must_use]
pub fn escape(text: &str) -> String {
    text.chars().fold(String::with_capacity(text.len()), |mut escaped, c| {
        if hidden(c) {
            escaped.extend(c.escape_debug())
        } else {
            escaped.push(c)
        }
        escaped
    })
}

/// Whether a character must not reach a terminal as it is.
fn hidden(c: char) -> bool {
    let invisible = matches!(
        c,
        '\u{ad}'
            | '\u{61c}'
            | '\u{180e}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{feff}'
            | '\u{fff9}'..='\u{fffb}'
            | '\u{e0000}'..='\u{e0fff}'
    );
    c.is_control() || invisible
}

/// Lines of a file, fit to be shown: one sign for each hidden character, so that columns stay.
fn veil(lines: &str) -> String {
    lines.chars().map(|c| if hidden(c) && !matches!(c, '\n' | '\r' | '\t') { '\u{fffd}' } else { c }).collect()
}

/// A message or remark, fit to be shown and of bounded length.
pub(super) fn shown(text: &str) -> String {
    escape(&bounded(text))
}

/// The same line by line: line breaks stay.
pub(super) fn shown_lines(text: &str) -> String {
    bounded(text).lines().map(escape).collect::<Vec<_>>().join("\n")
}

/// Renders mistakes as text: `error: … [E0207]`, `file:line:column`, the offending text underlined, the help. The first 20 are
/// shown, and the others counted. Ends with a line break unless there are no mistakes.
#[must_use]
pub fn render(sources: &Sources, diagnostics: &[Diagnostic]) -> String {
    let mut text = String::new();
    for diagnostic in diagnostics.iter().take(MOST_SHOWN) {
        if !text.is_empty() {
            text.push('\n');
        }
        text.push_str(&block(sources, diagnostic));
        text.push('\n');
    }
    if let Some(more @ 1..) = diagnostics.len().checked_sub(MOST_SHOWN) {
        let least = if diagnostics.len() >= MOST_KEPT { "at least " } else { "" };
        // Writing to a text can't fail.
        let _ = writeln!(text, "\n… and {least}{more} more");
    }
    text
}

fn block(sources: &Sources, diagnostic: &Diagnostic) -> String {
    let mut group =
        Group::with_title(Level::ERROR.primary_title(format!("{} [{}]", shown(&diagnostic.message), diagnostic.code)));
    for window in windows(sources, diagnostic) {
        if window.lines.len() > LARGEST_WINDOW {
            let origin = Origin::path(window.path).line(window.line).char_column(window.column);
            group = group.element(origin);
            let remarks = window.labels.into_iter().filter(|label| !label.text.is_empty());
            group = group.elements(remarks.map(|label| Level::NOTE.message(label.text)));
            continue;
        }
        let labels = window.labels.into_iter().map(|label| {
            let kind = if label.primary { AnnotationKind::Primary } else { AnnotationKind::Context };
            let [start, end] = [label.range.start, label.range.end].map(|at| veil(&window.lines[..at]).len());
            kind.span(start..end).label((!label.text.is_empty()).then_some(label.text))
        });
        let snippet = Snippet::source(veil(window.lines)).line_start(window.line).path(window.path);
        group = group.element(snippet.annotations(labels));
    }
    for quote in &diagnostic.quotes {
        group = quoted(group, quote);
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(shown_lines(help)));
    }
    let text = Renderer::plain().render(&[group]);
    // The line that leads from a snippet to the help leads nowhere where there is no snippet.
    if diagnostic.labels.is_empty() { text.replacen("\n |\n", "\n", 1) } else { text }
}

/// With a line of another file; of a long one only its place and the remark.
fn quoted<'g>(group: Group<'g>, quote: &Quote) -> Group<'g> {
    let Quote { file, line, text, underlined, remark } = quote;
    let (file, line, remark) = (escape(file), *line as usize, shown(remark));
    if text.len() > LARGEST_WINDOW {
        return group.element(Origin::path(file).line(line)).element(Level::NOTE.message(remark));
    }
    let [start, end] = [underlined.start, underlined.end].map(|at| veil(&text[..text.floor_char_boundary(at)]).len());
    let label = AnnotationKind::Primary.span(start..end).label((!remark.is_empty()).then_some(remark));
    group.element(Snippet::source(veil(text)).line_start(line).path(file).annotation(label))
}

/// Whole lines of one file, with their labels.
struct Window<'s> {
    path: String,
    /// Number of the first line, from 1.
    line: usize,
    /// Where the first label begins in its line, from 1.
    column: usize,
    start: usize,
    lines: &'s str,
    labels: Vec<ShownLabel>,
}

struct ShownLabel {
    range: Range<usize>,
    text: String,
    primary: bool,
}

/// The lines that labels stand on. Labels share a window unless that would grow too large.
fn windows<'s>(sources: &'s Sources, diagnostic: &Diagnostic) -> Vec<Window<'s>> {
    let mut windows: Vec<Window<'s>> = Vec::new();
    for (position, label) in diagnostic.labels.iter().enumerate() {
        let Some(file) = label.span.file().and_then(|file| sources.file(file)) else { continue };
        let Some(place) = sources.place(label.span) else { continue };
        let range = super::json::within_line(&file.text, label.span);
        let line_start = file.text[..range.start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = file.text[range.end..].find('\n').map_or(file.text.len(), |at| range.end + at);
        let mut window = Window {
            path: escape(&file.shown),
            line: place.line as usize,
            column: place.column as usize,
            start: line_start,
            lines: &file.text[line_start..line_end],
            labels: Vec::new(),
        };
        let shown = ShownLabel { range, text: shown(&label.text), primary: position == 0 };
        let joined = windows.iter_mut().find_map(|earlier| {
            let start = earlier.start.min(window.start);
            let end = (earlier.start + earlier.lines.len()).max(line_end);
            (earlier.path == window.path && end - start <= LARGEST_WINDOW).then_some((earlier, start, end))
        });
        match joined {
            Some((earlier, start, end)) => {
                earlier.line = earlier.line.min(window.line);
                (earlier.start, earlier.lines) = (start, &file.text[start..end]);
                earlier.labels.push(shown);
            }
            None => {
                window.labels.push(shown);
                windows.push(window);
            }
        }
    }
    for window in &mut windows {
        for label in &mut window.labels {
            label.range = label.range.start - window.start..label.range.end - window.start;
        }
    }
    windows
}
