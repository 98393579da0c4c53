//! Pipelines that begin with what others say: what is set, removed and inserted, and in which order.

use crate::testing::pipelines::{INPUTS, right, unnamed};
use crate::testing::plans::{on, shipped};
use crate::testing::table::Table;
use framewright_graph::base::{self, FilePath, Sources};
use framewright_graph::expand::{Inputs, expand};
use framewright_graph::frame::Frame;
use framewright_graph::frame::change::{Action, InsertPlace, Kind};
use framewright_graph::language::{self, Document, Files, FoundFile, ReadFailure};
use framewright_graph::plan::Plan;
use std::sync::Arc;

const BASE: &str = r#"Pipeline(
    version: 1,
    settings: [(name: "strength", value: Number(default: 0.5, min: 0.0, max: 1.0), about: "of the softness"), (name: "haze", value: Bool(default: false))],
    presets: [(name: "soft", set: {"strength": 1.0, "haze": true})],
    images: [
        (name: "color", format: Color(hdr: true), size: Output, samples: 4),
        (name: "small", format: Like("color"), size: Scaled(0.5)),
        (name: "screen", format: Output, size: Output),
    ],
    passes: [
        (name: "sky", draw: Sky, color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
        (anchor: "effects"),
        (name: "shrink", draw: FullScreen("downsample"), sample: {"source": "color"}, color: ["small"]),
        (name: "mix", draw: FullScreen("soft_focus"), sample: {"sharp": "color", "soft": "small"},
            params: {"strength": "strength"}, color: ["screen"]),
    ],
    outputs: ["screen"],
)"#;

/// Files in memory.
struct Shelf(Vec<(&'static str, String)>);

impl Files for Shelf {
    fn read(&mut self, _: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        let (_, text) = self.0.iter().find(|(name, _)| *name == path).ok_or_else(|| format!("no `{path}`"))?;
        Ok(FoundFile { shown: path.to_owned(), relative: path.into(), bytes: text.clone().into_bytes() })
    }
}

/// A pipeline that extends [`BASE`] and says `more`.
fn extending(more: &str) -> String {
    format!("Pipeline(version: 1, extends: \"base.ron\", {more})")
}

fn document(text: &str, files: &[(&'static str, &str)], applied: &[&str]) -> (Document, Arc<Sources>) {
    let shelf = files.iter().chain(&[("base.ron", BASE)]).map(|(name, text)| (*name, (*text).to_owned()));
    let found = |name: &str, text: &str| FoundFile {
        shown: name.to_owned(),
        relative: name.into(),
        bytes: text.as_bytes().to_vec(),
    };
    let further = applied.iter().zip(0..).map(|(text, at)| found(&format!("further{at}.ron"), text)).collect();
    let mut sources = Sources::default();
    let own = found("test.ron", text);
    let document = language::read_extended(&mut sources, &mut Shelf(shelf.collect()), own, further)
        .unwrap_or_else(|errors| panic!("{}", base::render(&sources, &errors)));
    (document, Arc::new(sources))
}

fn frame_of(text: &str, files: &[(&'static str, &str)], applied: &[&str]) -> Frame {
    let (document, sources) = document(text, files, applied);
    expand(&document, sources.clone(), &INPUTS, &mut Table)
        .unwrap_or_else(|errors| panic!("{}", base::render(&sources, &errors)))
}

fn plan(frame: &Frame) -> Plan {
    on(frame, &shipped("amd-rx-7800-xt")).expect("it can be made")
}

fn passes(frame: &Frame) -> Vec<&str> {
    frame.passes.iter().map(|pass| &*pass.name).collect()
}

/// A pass that can stand anywhere.
fn fill(name: &str) -> String {
    format!("(name: \"{name}\", draw: FullScreen(\"plain\"), color: [\"color\"])")
}

#[test]
fn what_extends_and_says_nothing_else_is_the_same_but_for_its_places() {
    let base = right(BASE, &INPUTS);
    let frame = frame_of(&extending(""), &[], &[]);
    assert_eq!(unnamed(&frame), unnamed(&base));
    assert_eq!(passes(&frame), passes(&base));
    assert_eq!(
        frame.sources.place(frame.passes[1].span).map(|place| place.to_string()).as_deref(),
        Some("base.ron:13:16")
    );
    let twice = frame_of(r#"Pipeline(version: 1, extends: "one.ron")"#, &[("one.ron", &extending(""))], &[]);
    assert_eq!(unnamed(&twice), unnamed(&base));
}

/// The values of [`BASE`]'s preset, by the settings' names.
fn preset(document: &Document) -> Vec<(&str, String)> {
    let chosen = |choice: &language::Choice| (&*document.settings[choice.setting].name.text, choice.value.to_string());
    document.presets[0].set.iter().map(chosen).collect()
}

#[test]
fn one_value_of_a_preset_is_set_and_the_others_stay() {
    let changes = r#"changes: [Set(preset: "soft", to: (set: {"strength": 0.25}))]"#;
    let (document, _) = document(&extending(changes), &[], &[]);
    assert_eq!(preset(&document), [("strength", "0.25".to_owned()), ("haze", "true".to_owned())]);
}

#[test]
fn a_setting_that_is_removed_is_taken_out_of_presets_and_views() {
    let view = r#"views: [(name: "main", set: {"strength": 0.0, "haze": true})], images: ["#;
    let with_view = BASE.replacen("images: [", view, 1);
    let text = r#"Pipeline(version: 1, extends: "view.ron", changes: [
        Set(pass: "mix", to: (params: {"strength": 0.25})),
        Set(preset: "soft", to: (about: "with haze")),
        Remove(setting: "strength"),
    ])"#;
    let files = [("view.ron", &*with_view)];
    let (document, _) = document(text, &files, &[]);
    assert_eq!(preset(&document), [("haze", "true".to_owned())]);
    assert_eq!(document.presets[0].about.as_deref(), Some("with haze"));
    assert_eq!(frame_of(text, &files, &[]).views.len(), 1);
}

#[test]
fn a_setting_that_is_removed_and_declared_again_is_the_one_that_presets_mean() {
    let again =
        r#"Extension(version: 1, settings: [(name: "strength", value: Number(default: 0.1, min: 0.0, max: 1.0))])"#;
    let without = r#"Extension(version: 1, changes: [Remove(setting: "strength")])"#;
    let files = [("without.ron", without), ("again.ron", again)];
    let (document, _) = document(&extending(r#"extensions: ["without.ron", "again.ron"]"#), &files, &[]);
    assert_eq!(document.settings.last().map(|it| it.kind.default().to_string()).as_deref(), Some("0.1"));
    assert!(preset(&document).iter().any(|(name, _)| *name == "strength"), "{:?}", preset(&document));
}

#[test]
fn fields_are_set_and_taken_away_and_maps_are_merged_by_key() {
    let changes = r#"changes: [
        Set(image: "color", to: (samples: 2, size: Fixed(32, 16))),
        Set(pass: "mix", to: (params: {"strength": 0.25}, sample: {"soft": (image: "small", filter: Nearest)})),
        Set(setting: "strength", to: (default: 0.75, about: "other words")),
        Set(preset: "soft", to: (set: {"strength": 0.875}), without: ["set"]),
        Set(image: "small", to: (format: R8G8B8A8_UNORM)),
        Set(image: "color", without: ["samples"]),
    ]"#;
    let expected = BASE
        .replace("size: Output, samples: 4", "size: Fixed(32, 16)")
        .replace(r#""soft": "small""#, r#""soft": (image: "small", filter: Nearest)"#)
        .replace(r#"{"strength": "strength"}"#, r#"{"strength": 0.25}"#)
        .replace(r#"format: Like("color")"#, "format: R8G8B8A8_UNORM");
    assert_eq!(unnamed(&frame_of(&extending(changes), &[], &[])), unnamed(&right(&expected, &INPUTS)));
    let (document, _) = document(&extending(changes), &[], &[]);
    assert_eq!(document.settings[0].kind.default().to_string(), "0.75");
    assert_eq!(document.settings[0].about.as_deref(), Some("other words"));
    assert_eq!(document.settings[0].kind.allowed(), "a number from 0 to 1");
    assert_eq!(document.presets[0].set[0].value.to_string(), "0.875");
    assert_eq!(document.presets[0].set.len(), 1, "`without` took the whole map away");
}

#[test]
fn a_word_that_is_wrong_in_the_base_stays_wrong_where_the_entry_is_changed() {
    let base = BASE.replace(r#"(name: "sky", draw"#, r#"Layer(name: "sky", draw"#);
    let changes = extending(r#"changes: [Set(pass: "sky", to: (side_effect: true))]"#);
    for text in [extending(""), changes] {
        let own = FoundFile { shown: "test.ron".to_owned(), relative: "test.ron".into(), bytes: text.into_bytes() };
        let mut sources = Sources::default();
        let mut shelf = Shelf(vec![("base.ron", base.clone())]);
        let errors = language::read_extended(&mut sources, &mut shelf, own, Vec::new());
        let said = base::render(&sources, &errors.expect_err("a pass is no layer"));
        assert!(said.contains("expected `Pass(…)`, found `Layer`"), "{said}");
        assert!(said.contains("base.ron:11:9"), "{said}");
    }
}

#[test]
fn inserts_at_one_place_stand_in_the_order_in_which_they_are_applied() {
    let insert = |place: &str, name: &str| format!("Insert({place}, passes: [{}])", fill(name));
    let changes = [
        insert("after: \"sky\"", "a"),
        insert("at: \"effects\"", "b"),
        insert("before: \"shrink\"", "c"),
        insert("after: \"sky\"", "d"),
        insert("before: \"shrink\"", "e"),
        insert("at: \"effects\"", "f"),
        insert("at: End", "g"),
        insert("after: \"a\"", "h"),
        insert("before: \"e\"", "i"),
        insert("at: End", "j"),
        insert("after: \"mix\"", "k"),
        // It draws before the image is cleared.
        insert("at: Start", "l").replace("\"color\"]", "\"screen\"]"),
    ];
    let frame = frame_of(&extending(&format!("changes: [{}]", changes.join(", "))), &[], &[]);
    let expected = ["l", "sky", "a", "h", "d", "b", "f", "c", "i", "e", "shrink", "mix", "k", "g", "j"];
    assert_eq!(passes(&frame), expected);
}

#[test]
fn extensions_come_before_the_changes_of_the_file_that_names_them_and_those_of_the_user_last() {
    let extension = |name: &str, more: &str| {
        format!(
            "Extension(version: 1, about: \"more\", changes: [{more} Insert(at: \"effects\", passes: [{}])])",
            fill(name)
        )
    };
    let one = extension("one", "");
    let two = extension("two", r#"Set(pass: "one", to: (draw: Sky)),"#);
    let own =
        format!("extensions: [\"one.ron\", \"two.ron\"], changes: [Insert(after: \"two\", passes: [{}])]", fill("own"));
    let files = [("one.ron", &*one), ("two.ron", &*two)];
    let further = [extension("user", r#"Remove(pass: "own"),"#), extension("last", "")];
    let frame = frame_of(&extending(&own), &files, &[&further[0], &further[1]]);
    assert_eq!(passes(&frame), ["sky", "one", "two", "user", "last", "shrink", "mix"]);

    // A pipeline that stands by itself takes extensions too.
    let whole = BASE.replace("version: 1,", "version: 1, extensions: [\"one.ron\"],");
    assert_eq!(passes(&frame_of(&whole, &files, &[])), ["sky", "one", "shrink", "mix"]);
    assert_eq!(passes(&frame_of(BASE, &[], &[&one])), ["sky", "one", "shrink", "mix"]);
}

#[test]
fn what_an_extension_brings_is_as_if_it_stood_in_the_pipeline() {
    let extension = r#"Extension(version: 1,
        include: ["lib.ron"],
        settings: [(name: "levels", value: Integer(default: 2, min: 1, max: 4))],
        images: [(name: "wide", repeat: ("i", "levels"), format: Like("color"), size: Output)],
        buffers: [(name: "numbers", bytes: 64)],
        fragments: [(name: "own", parameters: [(name: "to", value: Image)],
            passes: [(name: "fill", draw: FullScreen("plain"), color: ["to"])])],
        changes: [
            Remove(image: "small"), Remove(pass: "shrink"), Remove(pass: "mix"), Remove(preset: "soft"),
            Remove(setting: "strength"),
            Insert(at: "effects", passes: [
                (use: "own", name: "first", with: {"to": "wide[0]"}),
                (use: "lib", name: "second", with: {"from": "wide[0]", "to": "screen"}),
            ]),
            Insert(outputs: ["color"]),
        ])"#;
    let lib = r#"Fragments(version: 1, fragments: [
        (name: "lib", parameters: [(name: "from", value: Image), (name: "to", value: Image)],
            passes: [(name: "copy", draw: FullScreen("downsample"), sample: {"source": "from"}, color: ["to"])]),
    ])"#;
    let text = BASE.replace("version: 1,", "version: 1, extensions: [\"extension.ron\"],");
    let frame = frame_of(&text, &[("extension.ron", extension), ("lib.ron", lib)], &[]);
    assert_eq!(passes(&frame), ["sky", "first.fill", "second.copy"]);
    assert_eq!((frame.outputs.len(), frame.buffers.len(), frame.settings.len()), (2, 1, 2));
    let place = frame.sources.place(frame.passes[2].span).expect("a place");
    assert_eq!(&*place.file, "lib.ron");

    let outputs = frame_of(
        &extending(r#"outputs: ["small"], changes: [Insert(outputs: ["color"]), Remove(output: "small")]"#),
        &[],
        &[],
    );
    assert_eq!(outputs.outputs.len(), 1);
}

#[test]
fn a_plan_tells_what_files_did_and_where() {
    let extension = "Extension(version: 1, images: [(name: \"more\", format: Output, size: Output)],\nchanges: [Remove(pass: \"mix\"),\n\
                     Set(pass: \"shrink\", to: (color: [\"screen\"]), without: [\"when\"]), \
                     Insert(before: \"shrink\", passes: [(name: \"extra\", draw: FullScreen(\"plain\"), color: [\"color\"])])])";
    let base = BASE.replace("(name: \"shrink\",", "(name: \"shrink\", when: \"strength > 2\",");
    let own = "Pipeline(version: 1,\n extends: \"b.ron\",\n extensions: [\"e.ron\"],\n outputs: [\"screen\"])";
    let frame = frame_of(own, &[("b.ron", &base), ("e.ron", extension)], &[]);
    let actions: Vec<&Action> = frame.changes.iter().map(|change| &change.action).collect();
    let [Action::Extends { file }, Action::Extension { .. }, Action::Add { of: Kind::Image, .. }, rest @ ..] =
        &actions[..]
    else {
        panic!("{actions:#?}")
    };
    assert_eq!(&**file, "b.ron");
    assert!(
        matches!(rest[2], Action::Insert { place: InsertPlace::Before(name), .. } if &**name == "shrink"),
        "{rest:#?}"
    );
    let plan = plan(&frame);
    let tree = plan.tree();
    let (_, after) = tree.split_once("├─ changes\n").expect("a branch");
    let shown: Vec<&str> =
        after.lines().take_while(|line| line.starts_with("│  ")).map(|line| &line["│  ├─ ".len()..]).collect();
    assert_eq!(
        shown,
        [
            "extends `b.ron` (test.ron:2)",
            "applies `e.ron` (test.ron:3)",
            "adds image `more` (e.ron:1)",
            "removes pass `mix` (e.ron:2)",
            "sets `color` and takes away `when` of pass `shrink` (e.ron:3)",
            "inserts `extra` before `shrink` (e.ron:3)",
            "gives `screen` out in place of all others (test.ron:4)",
        ]
    );
    assert!(tree.contains("(e.ron:3)") && tree.contains("(b.ron:11)"), "{tree}");
    let json = plan.to_json().expect("a form");
    assert!(json.contains("\"before\": \"shrink\""), "{json}");
    assert_eq!(Plan::from_json(&json).expect("it is read"), plan);
    assert!(!self::plan(&right(BASE, &INPUTS)).tree().contains("├─ changes\n"));
}

#[test]
fn a_setting_that_an_extension_changes_keeps_its_range_and_takes_values() {
    let changes = r#"changes: [Set(setting: "strength", to: (max: 4.0, step: 0.5))]"#;
    let (document, sources) = document(&extending(changes), &[], &[]);
    assert_eq!(document.settings[0].kind.allowed(), "a number from 0 to 4 in steps of 0.5");
    let set = [("strength".to_owned(), "3.5".to_owned())];
    let inputs = Inputs { set: &set, ..INPUTS };
    let frame = expand(&document, sources, &inputs, &mut Table).expect("it is allowed");
    assert_eq!(frame.settings[0].1, "3.5");
}

#[test]
fn a_hundred_thousand_passes_are_extended_by_a_thousand_changes_in_little_time_and_memory() {
    let many: Vec<String> = (0..100_000).map(|at| fill(&format!("p{at}"))).collect();
    let base = BASE.replace("(anchor: \"effects\"),", &format!("{},", many.join(",\n")));
    let insert = |at: usize| format!("Insert(after: \"p{at}\", passes: [{}])", fill(&format!("q{at}")));
    let nested = |at: usize| format!("Insert(after: \"r{at}\", passes: [{}])", fill(&format!("r{}", at + 1)));
    let first = format!("Insert(after: \"sky\", passes: [{}])", fill("r0"));
    let changes: Vec<String> = (0..500).map(insert).chain([first]).chain((0..500).map(nested)).collect();
    let text = format!("Pipeline(version: 1, extends: \"big.ron\", changes: [{}])", changes.join(", "));
    let (document, _) = document(&text, &[("big.ron", &base)], &[]);
    assert_eq!(document.changes().len(), 1 + 1001);
}

#[test]
fn only_the_removal_of_a_thing_of_the_kind_that_is_missed_is_shown() {
    let removed = |text: &str| {
        let mut sources = Sources::default();
        let mut shelf = Shelf(vec![("base.ron", BASE.to_owned())]);
        let errors = language::read_with(&mut sources, &mut shelf, "test.ron", "test.ron", text.to_owned());
        base::render(&sources, &errors.expect_err("wrong")).matches("is removed here").count()
    };
    // A pass and an image of one name: the image is missed, and the pass was removed.
    let named = |changes: &str| extending(&format!("changes: [{changes}]"));
    let other = |name: &str| format!("Insert(at: End, passes: [{}])", fill(name));
    let missing = r#"Set(pass: "mix", to: (color: ["other"]))"#;
    assert_eq!(removed(&named(&format!("{}, Remove(pass: \"other\"), {missing}", other("other")))), 0);
    assert_eq!(removed(&named(&format!("Remove(pass: \"sky\"), {}", missing.replace("other", "sky")))), 0);
    assert!(removed(&named(&format!("Remove(image: \"small\"), {}", missing.replace("other", "small")))) > 0);
}
