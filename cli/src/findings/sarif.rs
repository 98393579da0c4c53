//! Findings as SARIF 2.1.0, the Static Analysis Results Interchange Format of OASIS.

use super::finding::{Case, FilePlace, Finding};
use crate::system::text;
use framewright_graph::base::Code;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Characters of a path that an URI doesn't hold as they are.
const ESCAPED: &AsciiSet = &NON_ALPHANUMERIC.remove(b'/').remove(b'.').remove(b'_').remove(b'-').remove(b'~');

pub(super) fn sarif(pipeline: &str, cases: &[Case]) -> serde_json::Result<String> {
    let findings = || cases.iter().flat_map(|case| case.findings.iter().map(move |finding| (&case.name, finding)));
    let codes: BTreeSet<Code> = findings().map(|(_, finding)| finding.code).collect();
    let found = findings().map(|(case, finding)| result(pipeline, case, finding));
    text::json(&json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": {"driver": {
                "name": "framewright",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": codes.into_iter().map(rule).collect::<Vec<Value>>(),
            }},
            // Code hosts take one run of each id: files of several pipelines can be uploaded together.
            "automationDetails": {"id": format!("framewright check {pipeline}/")},
            "columnKind": "unicodeCodePoints",
            "results": found.collect::<Vec<Value>>(),
        }],
    }))
}

/// What code hosts show of a rule beside its findings.
fn rule(code: Code) -> Value {
    let explanation = code.explanation();
    json!({
        "id": code.to_string(),
        "shortDescription": {"text": code.title()},
        "help": {"text": explanation, "markdown": explanation},
    })
}

fn result(pipeline: &str, case: &str, finding: &Finding) -> Value {
    let found_at = match &finding.place {
        Some(place) => location(place),
        // Code hosts refuse a file with a result that has no line.
        None => json!({"artifactLocation": {"uri": uri(pipeline)}, "region": {"startLine": 1}}),
    };
    let mut result = json!({
        "ruleId": finding.code.to_string(),
        "level": "error",
        "message": {"text": plain(&format!("{}\n{case}", finding.text()))},
        "locations": [{"physicalLocation": found_at}],
    });
    if !finding.related.is_empty() {
        let related = finding.related.iter().zip(1..).map(
            |((place, remark), id)| json!({"id": id, "physicalLocation": location(place), "message": {"text": plain(remark)}}),
        );
        result["relatedLocations"] = related.collect();
    }
    result
}

fn location(FilePlace { file, line, column, end: [end_line, end_column] }: &FilePlace) -> Value {
    json!({
        "artifactLocation": {"uri": uri(file)},
        "region": {"startLine": line, "startColumn": column, "endLine": end_line, "endColumn": end_column},
    })
}

/// A path as a reference to a file.
fn uri(path: &str) -> String {
    utf8_percent_encode(path, ESCAPED).to_string()
}

/// A text without links: SARIF reads `[words](address)` as one, wherever brackets aren't escaped.
fn plain(text: &str) -> String {
    if !text.contains("](") {
        return text.to_owned();
    }
    text.replace('\\', "\\\\").replace('[', "\\[").replace(']', "\\]")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Code hosts refuse a whole file for one result without a line.
    #[test]
    fn what_has_no_place_stands_at_the_first_line_of_the_pipeline() {
        let case = Case::new("lavapipe", &json!([])).violations(&["step 0: a barrier is missing".to_owned()]);
        let place = &result("p.ron", &case.name, &case.findings[0])["locations"][0]["physicalLocation"];
        assert_eq!(*place, json!({"artifactLocation": {"uri": "p.ron"}, "region": {"startLine": 1}}));
    }
}
