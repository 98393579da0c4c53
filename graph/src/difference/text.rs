//! Differences for people, as lines.

use super::{Change, Differences, Entry, Field, Figure, Side};
use crate::base::{Place, amount};
use crate::plan::names::ShownText;
use std::fmt::Write;

/// Fields that are told where they differ, and not of what only one Plan has.
const DETAILS: [&str; 9] =
    ["accesses", "usage", "layout", "draw", "covers", "discards", "clear value", "state before", "state after"];

impl Differences {
    /// The text for people: sums that differ, then each entry, with `+` before what only B has and `-` before what only A has.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = format!("A: {}\nB: {}\n", of(&self.a), of(&self.b));
        if self.is_empty() {
            return text + "\nno difference\n";
        }
        let changed: Vec<&Figure> = self.totals.iter().filter(|figure| figure.a != figure.b).collect();
        if !changed.is_empty() {
            text.push('\n');
        }
        let width = changed.iter().map(|figure| figure.name.len()).max().unwrap_or_default();
        for figure in changed {
            let [a, b] = [figure.a, figure.b].map(|value| shown(figure, value));
            writeln!(text, "{:width$}  {a} → {b} ({})", figure.name, more(figure)).expect("a string takes everything");
        }
        let mut kind = None;
        for entry in &self.entries {
            if kind != Some(entry.kind) {
                kind = Some(entry.kind);
                writeln!(text, "\n{}", entry.kind.heading()).expect("a string takes everything");
            }
            let sign = match entry.change {
                Change::Added { .. } => '+',
                Change::Removed { .. } => '-',
                Change::Changed { .. } => '~',
            };
            writeln!(text, "  {sign} {}", line(entry)).expect("a string takes everything");
        }
        text
    }
}

/// The name of a Plan, and its device.
pub(super) fn of(side: &Side) -> String {
    format!("{} on {}", ShownText(&side.name), ShownText(&side.device.name))
}

/// A figure's value.
pub(super) fn shown(figure: &Figure, value: u64) -> String {
    if figure.bytes { amount::bytes(value) } else { value.to_string() }
}

/// By how much B's value exceeds A's.
pub(super) fn more(figure: &Figure) -> String {
    let sign = if figure.b >= figure.a { '+' } else { '−' };
    format!("{sign}{}", shown(figure, figure.a.abs_diff(figure.b)))
}

/// An entry: its name, its fields and its cause.
pub(super) fn line(entry: &Entry) -> String {
    let fields: Vec<String> = match &entry.change {
        Change::Added { fields } | Change::Removed { fields } => {
            fields.iter().filter(|field| !DETAILS.contains(&field.name)).map(one).collect()
        }
        Change::Changed { fields } => {
            // What is bound tells of accesses too.
            let binds = fields.iter().any(|field| field.name == "binds");
            fields.iter().filter(|field| !(binds && field.name == "accesses")).map(both).collect()
        }
    };
    let fields = if fields.is_empty() { String::new() } else { format!(": {}", fields.join("; ")) };
    let because = entry.because.as_ref().map_or_else(String::new, |why| format!("; {why}"));
    format!("{}{fields}{because}{}", entry.name, place(entry.at.as_ref()))
}

fn one(field: &Field) -> String {
    format!("{} {}", field.name, field.value())
}

fn both(field: &Field) -> String {
    let [a, b] = [&field.a, &field.b].map(|value| value.as_deref().unwrap_or("none"));
    format!("{} {b} (was {a})", field.name)
}

fn place(at: Option<&Place>) -> String {
    at.map_or_else(String::new, |at| format!(" ({}:{})", ShownText(&at.file), at.line))
}
