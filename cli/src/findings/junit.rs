//! Findings as the XML that JUnit writes: a test for each case.

use super::finding::{Case, FilePlace};
use crate::system::text;
use framewright_viewer::escape_xml as escaped;
use std::fmt::Write;

pub(super) fn junit(pipeline: &str, cases: &[Case]) -> String {
    let failures = cases.iter().filter(|case| !case.findings.is_empty()).count();
    let suite = escaped(&text::escape(&format!("framewright check {pipeline}")));
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites tests=\"{0}\" failures=\"{failures}\" errors=\"0\">\n  \
         <testsuite name=\"{suite}\" tests=\"{0}\" failures=\"{failures}\" errors=\"0\" skipped=\"0\" time=\"0\">\n",
        cases.len()
    );
    for case in cases {
        let name = escaped(&text::escape(&case.name));
        let _ =
            write!(xml, "    <testcase name=\"{name}\" classname=\"{}\" time=\"0\"", escaped(&text::escape(pipeline)));
        let Some(first) = case.findings.first() else {
            xml += "/>\n";
            continue;
        };
        let told = case.findings.iter().map(|finding| {
            let place = finding.place.as_ref().map_or_else(String::new, |FilePlace { file, line, column, .. }| {
                format!("{}:{line}:{column}: ", text::escape(file))
            });
            let related = finding.related.iter().map(|(FilePlace { file, line, column, .. }, remark)| {
                format!("\n{}:{line}:{column}: {remark}", text::escape(file))
            });
            format!("{place}{}{}", finding.text(), related.collect::<String>())
        });
        let told: Vec<String> = told.collect();
        let _ = write!(
            xml,
            ">\n      <failure message=\"{}\" type=\"{}\">{}</failure>\n    </testcase>\n",
            escaped(&first.message),
            first.code,
            escaped(&told.join("\n\n"))
        );
    }
    xml + "  </testsuite>\n</testsuites>\n"
}
