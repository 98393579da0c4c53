//! Presets and settings files: which values they come to, and what is wrong with them. Every file under `bad_settings/`
//! is wrong, its name says how, and the whole answer stands beside it.

use crate::testing::pipelines::{INPUTS, set};
use crate::testing::table::Table;
use framewright_graph::base::{self, Diagnostic, Sources};
use framewright_graph::expand::{Inputs, expand};
use framewright_graph::expression::Value;
use framewright_graph::language::{self, ChosenBy, Document, SettingsFile};
use std::path::{Path, PathBuf};
use std::sync::Arc;

const PIPELINE: &str = r#"Pipeline(
    version: 1,
    settings: [
        (name: "msaa", value: OneOf(default: 4, of: [1, 2, 4])),
        (name: "bloom", value: Bool(default: true)),
        (name: "scale", value: Number(default: 1.0, min: 0.25, max: 2.0, step: 0.25)),
        (name: "quality", value: OneOf(default: "high", of: ["low", "high"])),
        (name: "levels", value: Integer(default: 5, min: 1, max: 8)),
    ],
    presets: [
        (name: "low", about: "for phones", set: {"msaa": 1, "bloom": false, "scale": 0.5, "quality": "low"}),
        (name: "high", set: {"msaa": 4, "levels": 8}),
        (name: "plain", set: {}),
    ],
    images: [(name: "screen", format: Output, size: Scaled("if(quality == 'low', 0.5, 1) * scale"))],
    passes: [(name: "sky", draw: FullScreen("plain"), color: ["screen"])],
    outputs: ["screen"],
)"#;

fn document() -> (Sources, Document) {
    let mut sources = Sources::default();
    let document = language::read(&mut sources, "test.ron", "test.ron", PIPELINE.to_owned());
    let document = document.unwrap_or_else(|errors| panic!("{}", base::render(&sources, &errors)));
    (sources, document)
}

/// A settings file that is right.
fn file(sources: &mut Sources, document: &Document, text: &str) -> SettingsFile {
    let file = document.read_settings(sources, "my/quality.ron", "quality.ron", text.to_owned());
    file.unwrap_or_else(|errors| panic!("{}", base::render(sources, &errors)))
}

/// Values of `msaa`, `bloom`, `scale`, `quality` and `levels`.
fn shown(document: &Document, sources: Sources, values: &[(&str, &str)]) -> String {
    let inputs = Inputs { set: &set(values), ..INPUTS };
    let frame = expand(document, Arc::new(sources), &inputs, &mut Table).expect("a frame");
    let values: Vec<&str> = frame.settings.iter().map(|(_, value)| value.as_str()).collect();
    values.join(" ")
}

/// The values that a preset and files, with their texts, lead to.
fn come_to(preset: Option<&str>, files: &[&str], values: &[(&str, &str)]) -> String {
    let (mut sources, mut document) = document();
    let files: Vec<SettingsFile> = files.iter().map(|text| file(&mut sources, &document, text)).collect();
    document.choose(preset, &files).expect("a known preset");
    shown(&document, sources, values)
}

#[test]
fn a_preset_chooses_what_it_names_and_leaves_the_rest_at_defaults() {
    assert_eq!(come_to(None, &[], &[]), "4 true 1 high 5");
    assert_eq!(come_to(Some("low"), &[], &[]), "1 false 0.5 low 5");
    assert_eq!(come_to(Some("plain"), &[], &[]), "4 true 1 high 5");
    let (_, document) = document();
    assert_eq!(document.presets[0].about.as_deref(), Some("for phones"));
    assert_eq!(document.presets[0].set.len(), 4);
}

#[test]
fn what_is_chosen_decides_what_expressions_come_to() {
    let (sources, mut document) = document();
    document.choose(Some("low"), &[]).expect("a known preset");
    let frame = expand(&document, Arc::new(sources), &INPUTS, &mut Table).expect("a frame");
    assert_eq!(frame.images[0].extent, [160, 90, 1]);
}

#[test]
fn defaults_yield_to_presets_those_to_files_and_all_to_what_is_set() {
    let (first, second) =
        (r#"Settings(version: 1, set: {"msaa": 2, "levels": 3})"#, r#"Settings(version: 1, set: {"levels": 4})"#);
    assert_eq!(come_to(Some("low"), &[first], &[]), "2 false 0.5 low 3");
    assert_eq!(come_to(Some("low"), &[first, second], &[]), "2 false 0.5 low 4");
    assert_eq!(come_to(Some("low"), &[second, first], &[]), "2 false 0.5 low 3");
    assert_eq!(come_to(Some("low"), &[first, second], &[("levels", "7"), ("bloom", "true")]), "2 true 0.5 low 7");
}

#[test]
fn one_preset_is_in_force_the_chosen_one_else_that_of_the_last_file_that_names_one() {
    let low = r#"Settings(version: 1, preset: "low", set: {"msaa": 2})"#;
    let high = r#"Settings(version: 1, preset: "high")"#;
    assert_eq!(come_to(None, &[low], &[]), "2 false 0.5 low 5");
    assert_eq!(come_to(None, &[low, high], &[]), "2 true 1 high 8");
    assert_eq!(come_to(None, &[high, low], &[]), "2 false 0.5 low 5");
    assert_eq!(come_to(Some("high"), &[low], &[]), "2 true 1 high 8");
    assert_eq!(come_to(Some("plain"), &[low, high], &[]), "2 true 1 high 5");
}

#[test]
fn a_value_is_known_with_the_one_who_chose_it() {
    let (mut sources, mut document) = document();
    let file = file(&mut sources, &document, "Settings(\n    version: 1,\n    set: {\"msaa\": 2},\n)");
    document.choose(Some("low"), &[file]).expect("a known preset");
    let chosen = document.in_force();
    assert_eq!(chosen[0].value, Value::Integer(2));
    let ChosenBy::File(span) = chosen[0].by else { panic!("{:?}", chosen[0]) };
    assert_eq!(sources.place(span).expect("a place").to_string(), "quality.ron:3:11");
    assert_eq!(chosen[1].by, ChosenBy::Preset("low".into()));
    assert_eq!(chosen[4].by, ChosenBy::Default);
}

#[test]
fn choosing_anew_forgets_what_was_chosen() {
    let (sources, mut document) = document();
    document.choose(Some("low"), &[]).expect("a known preset");
    document.choose(None, &[]).expect("nothing is unknown");
    assert_eq!(shown(&document, sources, &[]), "4 true 1 high 5");
}

#[test]
fn a_preset_that_is_not_there_is_said_with_one_that_is_near() {
    let (_, mut document) = document();
    let unknown = document.choose(Some("lo"), &[]).expect_err("not there");
    assert_eq!(unknown.message, "there is no preset named `lo`");
    assert_eq!(unknown.help.as_deref(), Some("did you mean `low`?"));
    let unknown = document.choose(Some("ultra"), &[]).expect_err("not there");
    assert_eq!(unknown.help.as_deref(), Some("there are `low`, `high`, `plain`"));
}

/// Every file under `bad_settings/`: its name and its text.
pub(crate) fn bad_texts() -> Vec<(String, String)> {
    let paths = folder().read_dir().expect("the folder of bad files").map(|entry| entry.expect("an entry").path());
    let mut paths: Vec<_> = paths.filter(|path| path.extension().is_some_and(|found| found == "ron")).collect();
    paths.sort();
    let named = |path: &PathBuf| {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        (name, std::fs::read_to_string(path).expect("a text"))
    };
    paths.iter().map(named).collect()
}

/// The mistakes of a settings file.
pub(crate) fn mistakes(name: &str, text: String) -> (Sources, Vec<Diagnostic>) {
    let (mut sources, document) = document();
    let errors = document.read_settings(&mut sources, name, name, text).err();
    (sources, errors.unwrap_or_default())
}

/// Every file under `bad_settings/`: its name, the texts, and what is wrong with it.
pub(crate) fn bad_files() -> Vec<(String, Sources, Vec<Diagnostic>)> {
    let answer = |(name, text): (String, String)| {
        let (sources, errors) = mistakes(&name, text);
        assert!(!errors.is_empty(), "{name}");
        (name, sources, errors)
    };
    bad_texts().into_iter().map(answer).collect()
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/language/bad_settings")
}

#[test]
fn every_bad_settings_file_is_answered_as_it_stands_beside_it() {
    let files = bad_files();
    assert!(files.len() >= 9);
    for (name, sources, errors) in files {
        let shown = base::render(&sources, &errors);
        insta::with_settings!({
            snapshot_path => folder(), prepend_module_to_snapshot => false, omit_expression => true,
        }, { insta::assert_snapshot!(name.trim_end_matches(".ron"), shown) });
    }
}
