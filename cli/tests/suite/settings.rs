//! `--preset`, `--settings` and `--set`: which value is in force, and what is said about those that can't be.

use crate::testing::Place;
use serde_json::Value;

/// Wrong only where `scale` is 0.5, which only the preset `small` chooses: then images of two sizes are copied.
const PIPELINE: &str = r#"Pipeline(
    version: 1,
    settings: [
        (name: "msaa", value: OneOf(default: 4, of: [1, 2, 4])),
        (name: "scale", value: Number(default: 1.0, min: 0.25, max: 1.0)),
        (name: "quality", value: OneOf(default: "high", of: ["low", "high"])),
        (name: "levels", value: Integer(default: 5, min: 1, max: 8)),
    ],
    presets: [
        (name: "low", about: "for phones", set: {"msaa": 1, "quality": "low"}),
        (name: "small", set: {"scale": 0.5, "levels": 2}),
    ],
    images: [
        (name: "color", format: Color(hdr: true), size: Output, samples: "msaa"),
        (name: "kept", format: Output, size: Scaled("if(scale == 0.5, 0.5, 1)")),
        (name: "screen", format: Output, size: Output),
    ],
    passes: [
        (name: "behind", draw: Sky, color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
        (name: "again", when: "quality == 'high'", draw: Sky, color: ["color"]),
        (name: "show", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["screen"]),
        (name: "keep", copy: (from: "screen", to: "kept")),
    ],
    outputs: ["screen", "kept"],
)"#;

fn place() -> Place {
    let place = Place::new();
    place.file("p.ron", PIPELINE);
    place.file("quality.ron", "Settings(\n    version: 1,\n    preset: \"low\",\n    set: {\"msaa\": 2},\n)\n");
    place.file("levels.ron", r#"Settings(version: 1, set: {"levels": 3})"#);
    place
}

/// The settings that a Plan names.
fn settings(place: &Place, words: &[&str]) -> String {
    let out = place.run(&[&["inspect", "p.ron", "--format", "json"], words].concat()).exits(0).out;
    let plan: Value = serde_json::from_str(&out).expect("JSON");
    let list = plan["settings"].as_array().expect("a list").iter();
    list.map(|one| one["value"].as_str().expect("a text")).collect::<Vec<_>>().join(" ")
}

#[test]
fn the_command_line_is_stronger_than_files_those_than_presets_and_those_than_defaults() {
    let place = place();
    let of = |words: &[&str]| settings(&place, words);
    assert_eq!(of(&[]), "4 1 high 5");
    assert_eq!(of(&["--preset", "low"]), "1 1 low 5");
    assert_eq!(of(&["--settings", "quality.ron"]), "2 1 low 5");
    assert_eq!(of(&["--settings", "quality.ron", "--settings", "levels.ron"]), "2 1 low 3");
    assert_eq!(of(&["--settings", "quality.ron", "--set", "quality=high", "--set", "msaa=4"]), "4 1 high 5");
    // The order of different words doesn't matter.
    assert_eq!(of(&["--set", "msaa=4", "--settings", "quality.ron", "--preset", "low"]), "4 1 low 5");
}

#[test]
fn what_is_wrong_with_the_command_line_ends_with_2_and_with_a_file_with_1() {
    let place = place();
    let check = |words: &[&str]| place.run(&[&["check", "p.ron"], words].concat());
    check(&["--preset", "lo"]).exits(2).says("error: there is no preset named `lo`\n = help: did you mean `low`?");
    check(&["--preset", "low", "--preset", "small"]).exits(2).mentions("--preset");
    check(&["--settings", "nowhere.ron"]).exits(1).mentions("error: the settings file `nowhere.ron` can't be read: ");
    place.file("bytes.ron", b"\xff");
    check(&["--settings", "bytes.ron"])
        .exits(1)
        .says("error: the settings file `bytes.ron` is not text: byte 0 is not UTF-8");

    place.file("wrong.ron", "Settings(\n    version: 1,\n    set: {\"msaa\": 3},\n)\n");
    place.file("other.ron", r#"Settings(version: 1, preset: "hi")"#);
    let both = check(&["--settings", "wrong.ron", "--settings", "other.ron"]).exits(1);
    both.mentions("doesn't allow `3`").mentions("error: there is no preset named `hi`\n --> other.ron:1:30\n");
    let said = check(&["--settings", "wrong.ron"]).exits(1);
    let said = said.mentions("error: setting `msaa` doesn't allow `3`\n").mentions(" wrong.ron:3:19\n");
    said.mentions(" p.ron:4:16\n").mentions("`msaa` is declared here").mentions("it is one of 1, 2, 4");
    let out = check(&["--settings", "wrong.ron", "--format", "json"]).exits(1).out;
    let answer: Value = serde_json::from_str(&out).expect("JSON");
    let label = |at: usize| {
        (answer["diagnostics"][0]["labels"][at]["file"].clone(), answer["diagnostics"][0]["labels"][at]["line"].clone())
    };
    assert_eq!((label(0), label(1)), (("wrong.ron".into(), 3.into()), ("p.ron".into(), 4.into())));
}

#[test]
fn a_settings_file_is_not_written_over() {
    let place = place();
    let words = ["inspect", "p.ron", "--settings", "quality.ron", "-o", "quality.ron"];
    place.run(&words).exits(2).mentions("`quality.ron` is the settings file itself");
}

#[test]
fn each_preset_is_among_all_variants_and_what_is_chosen_does_not_vary() {
    let place = place();
    let check = |words: &[&str], code: i32| -> Value {
        let words = [&["check", "p.ron", "--all-variants", "--format", "json"], words].concat();
        serde_json::from_str(&place.run(&words).exits(code).out).expect("JSON")
    };
    // `levels` stands in a preset and nowhere else, so it has no effect.
    let answer = check(&[], 1);
    assert_eq!(answer["axes"][1]["values"], serde_json::json!(["1.0", "0.25"]));
    assert_eq!((&answer["variants"], &answer["failing"]), (&13.into(), &1.into()));
    assert_eq!(answer["presets"], serde_json::json!(["low", "small"]));
    let cause = &answer["failures"][0]["breaks_with"]["settings"];
    assert_eq!(*cause, serde_json::json!([{ "name": "scale", "value": "0.5" }]));
    assert_eq!(check(&["--pairwise"], 1)["failing"], 1);

    let chosen = check(&["--settings", "quality.ron", "--set", "quality=high"], 0);
    assert_eq!((&chosen["variants"], &chosen["presets"]), (&2.into(), &serde_json::json!([])));
    let values = serde_json::json!([{ "name": "msaa", "value": "2" }, { "name": "quality", "value": "high" }]);
    assert_eq!(chosen["chosen"], values);
    let out = place.run(&["check", "p.ron", "--all-variants"]).exits(1).out;
    assert!(
        out.ends_with("p.ron: wrong in 1 of 13 variants: msaa (3) × scale (2) × quality (2), and 2 presets\n"),
        "{out}"
    );
}
