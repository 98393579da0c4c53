//! What `check` writes for CI systems, by the published schemas of SARIF 2.1.0 and of JUnit.

use super::judge;
use crate::testing::{Place, outcome};
use boon::{Compiler, Schemas};
use percent_encoding::percent_decode_str;
use serde_json::Value;
use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::process::Command;

/// Names of files that are text to nobody who wants to act on them.
fn hostile_names() -> Vec<OsString> {
    let names = [
        "a'b\"c<d>&e]]>.ron",
        "line\nbreak\r\ttab.ron",
        "<script>alert(1)<!--.ron",
        "\u{202e}nor\u{2066}.ron",
        "\u{1b}[2J\u{7}\u{7f}\u{9b}\u{fffe}.ron",
        "100%25%0A,a:b::error title=x::.ron",
        "[link](https:x){0}.ron",
        " .ron",
        "https:x?y#z.ron",
        "Größe 漢字 😀.ron",
    ];
    #[allow(unused_mut, reason = "other systems have no such names")]
    let mut names: Vec<OsString> = names.into_iter().map(OsString::from).collect();
    #[cfg(unix)]
    names.push(std::os::unix::ffi::OsStringExt::from_vec(b"not\xff\xfeutf-8.ron".to_vec()));
    names
}

/// Contents of pipelines: right, with a variant that is wrong, wrong where a message quotes what the file says, and no pipeline at all.
fn contents(place: &Place) -> Vec<String> {
    place.run(&["new", "first"]).exits(0);
    let first = std::fs::read_to_string(place.path("first.ron")).expect("written");
    let evil = "\"</script>]]>&#0;\u{202e} [x](https:y) {0} %0A::error::\"";
    vec![
        first.replace("samples: Like(\"color\")", "samples: 4"),
        first.replace("\"reinhard\"", evil).replace("draw: Sky", "draw: FullScreen(\"sky\")"),
        first.replace("color: [\"color\"]", &format!("color: [{evil}]")),
        first.replace("draw: Sky", "drow\u{202e}: Sky"),
        first[..first.len() / 2].to_owned(),
        String::new(),
        first,
    ]
}

/// Answers of `check` in a form: about every content in every way of checking, and about files of every hostile name.
fn answers(form: &str, judge: &mut dyn FnMut(&str, &OsStr, &str)) {
    let place = Place::new();
    place.file("budget.ron", "Budget(version: 1, limits: [(resolves: 0)])");
    let ways: [&[&str]; 5] = [
        &[],
        &["--budget", "budget.ron"],
        &["--all-variants", "--budget", "budget.ron"],
        &["--device", "all"],
        &["--size", "16384x16384", "--set", "msaa=4"],
    ];
    let (contents, names) = (contents(&place), hostile_names());
    let by_content = contents.iter().flat_map(|content| ways.map(|way| (content, &names[0], way)));
    let by_name = names.iter().zip(contents.iter().cycle()).flat_map(|(name, content)| {
        let right = contents.last().expect("the last one is right");
        [(content, name, ways[2]), (right, name, ways[1])]
    });
    let [mut fine, mut failed] = [0, 0];
    for (content, name, way) in by_content.chain(by_name) {
        place.file(name, content);
        let mut arguments: Vec<&OsStr> = vec!["check".as_ref(), name, "--format".as_ref(), form.as_ref()];
        arguments.extend(way.iter().map(OsStr::new));
        let told = place.run(&arguments);
        match told.code {
            Some(0) => fine += 1,
            Some(1) => failed += 1,
            _ => panic!("{arguments:?}: {told:?}"),
        }
        judge(&format!("{arguments:?}"), name, &told.out);
    }
    assert!(fine > 3 && failed > 30, "{fine} {failed}");
}

/// A character that a terminal or a reader could act on.
fn acts(character: char) -> bool {
    character.is_control() && character != '\n'
        || ('\u{202a}'..='\u{202e}').contains(&character)
        || character == '\u{2066}'
}

#[test]
fn sarif_is_what_its_schema_asks_for_and_every_result_has_a_line() {
    let Some(folder) = judge("serde-sarif") else { return };
    let text = std::fs::read_to_string(folder.join("src/schema.json")).expect("the schema");
    let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
    compiler.enable_format_assertions();
    compiler.add_resource("sarif.json", serde_json::from_str(&text).expect("JSON")).expect("a schema");
    let schema = compiler.compile("sarif.json", &mut schemas).expect("it compiles");
    let mut results = 0;
    answers("sarif", &mut |about, name, answer| {
        let sarif: Value = serde_json::from_str(answer).expect("JSON");
        if let Err(problem) = schemas.validate(&sarif, schema) {
            panic!("{about}: {problem:#}\n{answer}");
        }
        assert!(!answer.chars().any(acts), "{about}: {answer}");
        for result in sarif["runs"][0]["results"].as_array().expect("results") {
            results += 1;
            let location = &result["locations"][0]["physicalLocation"];
            assert!(
                location["region"]["startLine"].as_u64() > Some(0),
                "{about}: code hosts refuse a result without a line: {result}"
            );
            let uri = location["artifactLocation"]["uri"].as_str().expect("a reference");
            let file = percent_decode_str(uri).decode_utf8().expect("UTF-8");
            assert_eq!(file, name.to_string_lossy(), "{about}");
            let message = result["message"]["text"].as_str().expect("a message");
            assert!(!message.is_empty() && !message.replace("\\]", "").contains("]("), "{about}: a link: {message}");
        }
    });
    assert!(results > 30, "{results}");
    // The judge refuses what is wrong.
    let wrong = serde_json::json!({"version": "2.1.0", "runs": [{"tool": {}}]});
    assert!(schemas.validate(&wrong, schema).is_err());
}

/// Whether `xmllint` is there.
fn has_xmllint() -> bool {
    let there = Command::new("xmllint").arg("--version").output().is_ok();
    assert!(there || std::env::var_os("CI").is_none(), "no xmllint: install the package libxml2-utils");
    if !there {
        println!("skipped: no xmllint (package libxml2-utils)");
    }
    there
}

fn xmllint(arguments: &[&OsStr]) -> crate::testing::Outcome {
    outcome(Command::new("xmllint").args(["--nonet", "--noout"]).args(arguments))
}

#[test]
fn junit_is_what_the_schema_of_jenkins_asks_for() {
    let Some(folder) = judge("junit-report") else { return };
    if !has_xmllint() {
        return;
    }
    let schema = folder.join("tests/JUnit.xsd");
    let reports = Place::new();
    let mut files = Vec::new();
    answers("junit", &mut |about, _, answer| {
        assert!(!answer.chars().any(acts), "{about}: {answer}");
        files.push(reports.file(format!("{}.xml", files.len()), answer));
    });
    let judge = |files: &[&Path]| {
        let files = files.iter().map(|file| file.as_os_str());
        xmllint(&["--schema".as_ref(), schema.as_os_str()].into_iter().chain(files).collect::<Vec<_>>())
    };
    let told = judge(&files.iter().map(AsRef::as_ref).collect::<Vec<&Path>>()).exits(0);
    assert_eq!(told.err.matches(" validates").count(), files.len(), "{}", told.err);
    // The judge refuses what is wrong.
    let wrong = reports.file("wrong.xml", "<testsuites><testsuite><testcase/></testsuite></testsuites>");
    judge(&[&wrong]).exits(3);
}
