//! Findings as SARIF 2.1.0, the Static Analysis Results Interchange Format of OASIS.

use super::finding::{Case, FilePlace, Finding, Kind};
use crate::system::text;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde_json::{Value, json};

/// Characters of a path that an URI doesn't hold as they are.
const ESCAPED: &AsciiSet = &NON_ALPHANUMERIC.remove(b'/').remove(b'.').remove(b'_').remove(b'-').remove(b'~');

pub(super) fn sarif(cases: &[Case]) -> serde_json::Result<String> {
    let rules = Kind::ALL.map(|kind| json!({"id": kind.id(), "shortDescription": {"text": kind.words()}}));
    let found = cases.iter().flat_map(|case| case.findings.iter().map(move |finding| result(&case.name, finding)));
    text::json(&json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": {"driver": {
                "name": "framewright",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": rules,
            }},
            "columnKind": "unicodeCodePoints",
            "results": found.collect::<Vec<Value>>(),
        }],
    }))
}

fn result(case: &str, finding: &Finding) -> Value {
    let mut result = json!({
        "ruleId": finding.kind.id(),
        "ruleIndex": Kind::ALL.iter().position(|kind| *kind == finding.kind),
        "level": "error",
        "message": {"text": format!("{}\n{case}", finding.text())},
    });
    if let Some(place) = &finding.place {
        result["locations"] = json!([{"physicalLocation": location(place)}]);
    }
    if !finding.related.is_empty() {
        let related = finding.related.iter().zip(1..).map(
            |((place, remark), id)| json!({"id": id, "physicalLocation": location(place), "message": {"text": remark}}),
        );
        result["relatedLocations"] = related.collect();
    }
    result
}

fn location(FilePlace { file, line, column, end: [end_line, end_column] }: &FilePlace) -> Value {
    json!({
        "artifactLocation": {"uri": utf8_percent_encode(file, ESCAPED).to_string()},
        "region": {"startLine": line, "startColumn": column, "endLine": end_line, "endColumn": end_column},
    })
}
