//! Findings as commands that GitHub Actions turns into annotations of lines.

use super::finding::{Case, FilePlace};
use crate::system::text;
use std::fmt::Write;

pub(super) fn github(pipeline: &str, cases: &[Case]) -> String {
    let mut commands = String::new();
    for case in cases {
        for finding in &case.findings {
            let title = property(&format!("framewright, {}", case.name));
            let place = finding.place.as_ref().map_or_else(String::new, |place| {
                let FilePlace { file, line, column, end: [end_line, end_column] } = place;
                let file = property(file);
                format!("file={file},line={line},endLine={end_line},col={column},endColumn={end_column},")
            });
            let _ = writeln!(commands, "::error {place}title={title}::{}", data(&finding.text()));
        }
    }
    if commands.is_empty() {
        let pipeline = data(&text::escape(pipeline));
        let _ = writeln!(
            commands,
            "::notice title=framewright::{pipeline} is fine: {}",
            text::count(cases.len(), "case", "cases")
        );
    }
    commands
}

/// The text of a command: line breaks would end it.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// A property of a command, which a comma or colon would end too.
fn property(value: &str) -> String {
    data(&text::escape(value)).replace(':', "%3A").replace(',', "%2C")
}
