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
                format!(",file={file},line={line},endLine={end_line},col={column},endColumn={end_column}")
            });
            let _ = writeln!(commands, "::error title={title}{place}::{}", data(&finding.text_with_places()));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::finding::Finding;
    use serde::Deserialize;

    /// A finding, and the line that GitHub's own package writes for it.
    #[derive(Deserialize)]
    #[serde(rename_all = "camelCase")]
    struct WorkflowLine {
        title: String,
        file: String,
        message: String,
        start_line: u64,
        start_column: u64,
        end_line: u64,
        end_column: u64,
        line: String,
    }

    #[test]
    fn commands_are_those_that_the_package_of_github_writes() {
        let file: serde_json::Value =
            serde_json::from_str(include_str!("../../tests/formats/annotations.json")).expect("JSON");
        let judged: Vec<WorkflowLine> = serde_json::from_value(file["findings"].clone()).expect("findings");
        assert!(judged.len() > 5);
        for WorkflowLine { title, file, message, start_line, start_column, end_line, end_column, line } in judged {
            let place = FilePlace { file, line: start_line, column: start_column, end: [end_line, end_column] };
            let finding = Finding::at(message, place);
            assert_eq!(github("p.ron", &[Case { name: title, findings: vec![finding] }]), line);
        }
    }
}
