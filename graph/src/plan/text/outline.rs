//! An outline: a heading, and its parts under it. It is drawn with lines for a terminal.

use crate::base::Place;
use crate::plan::{About, EntryKind};
use serde::Serialize;

/// Columns that text is kept within, as far as its words allow.
const COLUMNS: usize = 120;
/// Columns that a wrapped line keeps at least, however deep it stands.
const LEAST: usize = 40;

/// A line about a Plan, with the lines under it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Outline {
    /// The kind of entry that the line is, or that the lines under it are.
    pub kind: EntryKind,
    /// The line in words. Names from files stand between backticks, with control characters escaped.
    pub text: String,
    /// The part of the Plan that it is about, if it is about one.
    pub about: Option<About>,
    /// The line of a file that says so or caused it; the text ends with it too.
    pub at: Option<Place>,
    /// The lines under it.
    pub parts: Vec<Outline>,
}

impl Outline {
    /// A detail of the line that it stands under, with lines of its own.
    #[must_use]
    pub fn new(text: impl Into<String>, parts: Vec<Outline>) -> Outline {
        Outline::of(EntryKind::Detail, text, parts)
    }

    pub(super) fn detail(text: impl Into<String>) -> Outline {
        Outline::new(text, Vec::new())
    }

    pub(super) fn of(kind: EntryKind, text: impl Into<String>, parts: Vec<Outline>) -> Outline {
        Outline { kind, text: text.into(), about: None, at: None, parts }
    }

    /// The whole outline, with a final line break.
    #[must_use]
    pub fn draw(&self) -> String {
        let mut drawn = String::new();
        self.add(&mut drawn, "", "");
        drawn
    }

    /// Adds this node: `first` stands before its first line, `rest` before all others.
    fn add(&self, drawn: &mut String, first: &str, rest: &str) {
        let under = if self.parts.is_empty() { "   " } else { "│  " };
        let mut before = first.to_owned();
        for line in wrap(&self.text, COLUMNS.saturating_sub(first.chars().count())) {
            drawn.push_str(&before);
            drawn.push_str(&line);
            drawn.push('\n');
            before = format!("{rest}{under}");
        }
        let last = self.parts.len().saturating_sub(1);
        for (at, child) in self.parts.iter().enumerate() {
            let [branch, trunk] = if at == last { ["└─ ", "   "] } else { ["├─ ", "│  "] };
            child.add(drawn, &format!("{rest}{branch}"), &format!("{rest}{trunk}"));
        }
    }
}

/// Breaks a text between words. Lines after the first are drawn three columns further in, so they are shorter.
fn wrap(text: &str, columns: usize) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    let mut used = 0;
    for word in text.split(' ') {
        let length = word.chars().count();
        let room = columns.saturating_sub(if lines.is_empty() { 0 } else { 3 }).max(LEAST);
        if used > 0 && used + 1 + length > room {
            lines.push(std::mem::take(&mut line));
            used = 0;
        }
        if used > 0 {
            line.push(' ');
            used += 1;
        }
        line.push_str(word);
        used += length;
    }
    lines.push(line);
    lines
}
