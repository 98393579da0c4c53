//! Pipelines that extend others, and extensions that the user applies.

use crate::testing::{Outcome, Place, Vulkan};
use serde_json::Value;

const EXTENDING: &str = r#"Pipeline(
    version: 1,
    extends: "forward.ron",
    settings: [(name: "glow", value: Bool(default: true))],
    images: [(name: "bloomed", format: Like("color"), size: Like("color"))],
    include: ["library/bloom.ron"],
    changes: [
        Set(setting: "msaa", to: (default: 1)),
        Set(pass: "tone_map", to: (sample: {"source": (image: "bloomed", filter: Nearest)}), without: ["when", "otherwise"]),
        Insert(before: "tone_map", passes: [
            (use: "bloom", name: "bloom", when: "glow", with: {"source": "color", "target": "bloomed"},
                otherwise: Forward(from: "color", to: "bloomed")),
        ]),
    ],
)"#;

/// It needs nothing but a pipeline that draws into `screen`.
const DEBUG: &str = r#"Extension(
    version: 1,
    about: "Shows the picture darker.",
    images: [(name: "dark", format: Output, size: Output)],
    changes: [
        Insert(at: End, passes: [
            (name: "darken", draw: FullScreen("copy"), sample: {"source": (image: "screen", filter: Nearest)}, color: ["dark"]),
        ]),
        Remove(output: "screen"),
        Insert(outputs: ["dark"]),
    ],
)"#;

fn place() -> Place {
    let place = Place::new();
    place.file("bright.ron", EXTENDING);
    place.file("debug.ron", DEBUG);
    place
}

fn check(place: &Place, words: &[&str]) -> Outcome {
    place.run(&[&["check"], words].concat())
}

#[test]
fn a_shipped_pipeline_is_extended_with_shipped_fragments_and_the_plan_tells_how() {
    let place = place();
    check(&place, &["bright.ron", "--device", "all"]).exits(0);
    let tree = place.run(&["inspect", "bright.ron"]).exits(0).out;
    for line in [
        "├─ changes\n│  ├─ extends `shipped:forward.ron` (bright.ron:3)\n│  ├─ adds setting `glow` (bright.ron:4)\n",
        "│  ├─ sets `default` of setting `msaa` (bright.ron:8)\n",
        "│  ├─ sets `sample` and takes away `when` and `otherwise` of pass `tone_map` (bright.ron:9)\n",
        "│  └─ inserts `bloom` before `tone_map` (bright.ron:10)\n",
        "(shipped:forward.ron:",
        "(shipped:library/bloom.ron:",
    ] {
        assert!(tree.contains(line), "{line}\n{tree}");
    }
    let json = place.run(&["inspect", "bright.ron", "--format", "json"]).exits(0).out;
    let plan: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(plan["changes"][0]["action"]["extends"]["file"], "shipped:forward.ron");
    assert_eq!(plan["changes"][0]["at"], "bright.ron:3:14");
    let answer = check(&place, &["bright.ron", "--all-variants", "--format", "json"]).exits(0).out;
    let answer: Value = serde_json::from_str(&answer).expect("JSON");
    assert_eq!(answer["fine"], true);
    assert!(answer["variants"].as_u64().is_some_and(|variants| variants > 32), "{answer:#}");
}

#[test]
fn extensions_of_the_user_are_applied_to_any_pipeline_one_after_the_other() {
    let place = place();
    let plan = |words: &[&str]| place.run(&[&["inspect"], words].concat()).exits(0).out;
    for pipeline in ["bright.ron", "forward", "deferred"] {
        let tree = plan(&[pipeline, "--extend", "debug.ron"]);
        assert!(tree.contains("applies `debug.ron` (debug.ron:1)"), "{tree}");
        assert!(tree.contains("`darken` draws the full screen with shader `copy` (debug.ron:7)"), "{tree}");
        let (_, outputs) = tree.split_once("├─ outputs").expect("a branch of outputs");
        let (outputs, _) = outputs.split_once("\n├─ ").expect("branches after it");
        assert!(outputs.contains("`dark` in") && !outputs.contains("`screen` in"), "{outputs}");
    }
    // One that names files is counted from its own folder, and may lie anywhere.
    std::fs::create_dir(place.path("more")).expect("a folder");
    place.file("more/lib.ron", r#"Fragments(version: 1, fragments: [])"#);
    place.file(
        "more/first.ron",
        r#"Extension(version: 1, include: ["lib.ron"], changes: [Set(pass: "darken", to: (name2: 1))])"#,
    );
    check(&place, &["forward", "--extend", "debug.ron", "--extend", "more/first.ron"])
        .exits(1)
        .mentions("error: pass `darken` has no field `name2`\n --> more/first.ron:1:80\n")
        .mentions("::: debug.ron:7:")
        .mentions("`darken` stands here");
    check(&place, &["forward", "--extend", "more/first.ron", "--extend", "debug.ron"])
        .exits(1)
        .mentions("error: there is no pass named `darken`\n --> more/first.ron:1:65\n");
    check(&place, &["forward", "--extend", "nowhere.ron"])
        .exits(1)
        .mentions("error: the extension `nowhere.ron` can't be read: ");
    check(&place, &["debug.ron"])
        .exits(1)
        .mentions("error: this is an extension, and a pipeline is needed here\n --> debug.ron:1:1\n");
}

#[test]
fn what_is_extended_lies_within_the_root_and_extends_nothing_in_a_circle() {
    let place = Place::new();
    std::fs::create_dir(place.path("inside")).expect("a folder");
    place.file("outside.ron", include_str!("../../../examples/pipelines/forward.ron"));
    place.file("inside/p.ron", r#"Pipeline(version: 1, extends: "../outside.ron")"#);
    check(&place, &["inside/p.ron"]).exits(1).mentions("error: `../outside.ron` leads out of `inside`");
    check(&place, &["inside/p.ron", "--root", "."]).exits(0);
    place.file("inside/p.ron", r#"Pipeline(version: 1, extends: "soft_focus.ron", extensions: ["../outside.ron"])"#);
    check(&place, &["inside/p.ron"]).exits(1).mentions("error: `../outside.ron` leads out of `inside`");
    // A file beside comes before a shipped one, even if it is the file itself.
    place.file("forward.ron", r#"Pipeline(version: 1, extends: "forward.ron")"#);
    check(&place, &["forward.ron"])
        .exits(1)
        .mentions("files extend each other in a circle: `forward.ron` → `forward.ron`");
}

#[test]
fn what_extends_and_changes_nothing_draws_the_same_picture() {
    let place = Place::new();
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    place.file("same.ron", r#"Pipeline(version: 1, extends: "forward.ron")"#);
    let picture = |pipeline: &str, file: &str| {
        let run = ["run", pipeline, "--scene", "spheres_and_cubes", "--size", "64x36", "-o", file];
        place.run_with(&variables, &run).exits(0);
        std::fs::read(place.path(file)).expect("a picture")
    };
    assert_eq!(picture("same.ron", "same.png"), picture("forward", "base.png"));
}
