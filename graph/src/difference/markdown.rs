//! Differences as Markdown, for a pull request.

use super::text::{line, more, of, shown};
use super::{Change, Differences, Kind};
use std::fmt::Write;

impl Differences {
    /// The Markdown: a table of the sums that differ, and a list for each kind of entry, folded away where it is about barriers
    /// and the like. Nothing from a file acts in it.
    #[must_use]
    pub fn markdown(&self) -> String {
        let mut text = format!("A: {}  \nB: {}\n", escaped(&of(&self.a)), escaped(&of(&self.b)));
        if self.is_empty() {
            return text + "\nNo difference.\n";
        }
        if self.totals.iter().any(|figure| figure.a != figure.b) {
            text += "\n| | A | B | more |\n|---|---:|---:|---:|\n";
        }
        for figure in self.totals.iter().filter(|figure| figure.a != figure.b) {
            let [a, b] = [figure.a, figure.b].map(|value| shown(figure, value));
            writeln!(text, "| {} | {a} | {b} | {} |", figure.name, more(figure)).expect("a string takes everything");
        }
        for entries in self.entries.chunk_by(|one, next| one.kind == next.kind) {
            let kind = entries[0].kind;
            let folded = kind > Kind::Transfer;
            let title = format!("{} ({})", kind.heading(), entries.len());
            text += &if folded {
                format!("\n<details><summary>{title}</summary>\n\n")
            } else {
                format!("\n**{title}**\n\n")
            };
            for entry in entries {
                let change = match entry.change {
                    Change::Added { .. } => "added",
                    Change::Removed { .. } => "removed",
                    Change::Changed { .. } => "changed",
                };
                writeln!(text, "- {change} {}", escaped(&line(entry))).expect("a string takes everything");
            }
            text += if folded { "\n</details>\n" } else { "" };
        }
        text
    }
}

/// Text in which no letter means anything to Markdown or HTML.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '@' => escaped.push_str("&#64;"),
            '#' => escaped.push_str("&#35;"),
            '\\' | '*' | '_' | '[' | ']' | '|' | '~' | '`' | '!' | '$' => {
                escaped.push('\\');
                escaped.push(letter);
            }
            _ => escaped.push(letter),
        }
    }
    escaped
}
