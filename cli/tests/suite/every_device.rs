//! `check --device all`, and what the command line says of how a Plan is made.

use crate::testing::{FORWARD, Place, shipped_pipelines};
use framewright_graph::device::SHIPPED_PROFILES;

fn json(place: &Place, arguments: &[&str], code: i32) -> serde_json::Value {
    let outcome = place.run(&[arguments, &["--format", "json"]].concat()).exits(code);
    serde_json::from_str(&outcome.out).expect("JSON")
}

#[test]
fn every_shipped_pipeline_is_fine_on_every_shipped_device() {
    for pipeline in shipped_pipelines() {
        let out = Place::new().run(&["check", &pipeline, "--device", "all"]).exits(0).out;
        for (name, _) in SHIPPED_PROFILES {
            assert!(out.contains(&format!("{pipeline}: fine on {name}: ")), "{name} in\n{out}");
        }
        let all = SHIPPED_PROFILES.len();
        assert!(out.ends_with(&format!("{pipeline}: fine on {all} of {all} devices\n")), "{out}");
    }
}

/// IQ-5: lavapipe, SwiftShader and the headset have no 8 samples, the others do.
#[test]
fn samples_that_some_devices_lack_are_lowered_on_those_and_that_is_said() {
    for pipeline in ["forward", "soft_focus"] {
        let out = Place::new().run(&["check", pipeline, "--device", "all", "--set", "msaa=8"]).exits(0).out;
        assert_eq!(out.matches("`color`: 4 samples instead of 8: ").count(), 3, "{out}");
    }
}

#[test]
fn what_one_device_refuses_is_said_of_that_device_alone() {
    let place = Place::new();
    let large = FORWARD.replacen(
        "(name: \"depth\"",
        "(name: \"large\", format: Output, size: Fixed(9000, 9000)), (name: \"depth\"",
        1,
    );
    let large = large.replacen("outputs: [", "outputs: [\"large\", ", 1).replacen(
        "passes: [",
        "passes: [(name: \"wide\", draw: Sky, color: [(image: \"large\", clear: (0.0, 0.0, 0.0, 1.0))]),",
        1,
    );
    place.file("p.ron", large);
    let out = place.run(&["check", "p.ron", "--device", "all"]).exits(1).says("").out;
    assert!(out.contains("p.ron: refused on swiftshader\n  error: "), "{out}");
    assert!(out.contains("9000×9000") && out.contains("8192"), "{out}");
    assert_eq!(out.matches("refused on").count(), 1, "{out}");
    let all = SHIPPED_PROFILES.len();
    assert!(out.ends_with(&format!("p.ron: fine on {} of {all} devices\n", all - 1)), "{out}");

    let answer = json(&place, &["check", "p.ron", "--device", "all"], 1);
    assert_eq!(answer["fine"], false);
    for device in answer["devices"].as_array().expect("a list") {
        let refused = device["profile"] == "swiftshader";
        assert_eq!(device["fine"], !refused, "{device:#}");
        assert_eq!(device["diagnostics"].as_array().map(Vec::is_empty), Some(!refused), "{device:#}");
        assert_eq!(device["totals"].is_null(), refused, "{device:#}");
    }
}

#[test]
fn what_is_wrong_on_every_device_is_said_once() {
    let place = Place::new();
    place.file("p.ron", FORWARD.replacen("image: \"color\", clear", "image: \"colr\", clear", 1));
    let outcome = place.run(&["check", "p.ron", "--device", "all"]).exits(1).mentions("did you mean `color`?");
    assert_eq!((outcome.out.as_str(), outcome.err.matches("error: ").count()), ("", 1));
    let answer = json(&place, &["check", "p.ron", "--device", "all"], 1);
    assert_eq!(answer["diagnostics"].as_array().map(Vec::len), Some(1));
    assert_eq!(answer["devices"], serde_json::json!([]));
    place.run(&["check", "forward", "--device", "all", "--set", "msaa=3"]).exits(2).mentions("doesn't allow `3`");
    place.run(&["check", "none.ron", "--device", "all"]).exits(1).mentions("there is no pipeline `none.ron`");
}

#[test]
fn only_check_takes_all_devices() {
    Place::new().run(&["inspect", "forward", "--device", "all"]).exits(2).mentions("there is no device profile `all`");
}

#[test]
fn the_same_check_on_all_devices_gives_the_same_bytes() {
    let place = Place::new();
    let arguments = ["check", "soft_focus", "--device", "all", "--format", "json"];
    assert_eq!(place.run(&arguments).exits(0).out, place.run(&arguments).exits(0).out);
}

#[test]
fn every_way_of_making_a_plan_is_fine_on_every_device() {
    for words in [
        &["--order", "file"][..],
        &["--order", "low-memory"],
        &["--order", "random:1"],
        &["--order", "random:18446744073709551615"],
        &["--naive", "resolves"],
        &["--one-queue"],
        &["--poison", "--no-alias"],
    ] {
        let arguments = [&["check", "soft_focus", "--device", "all"], words].concat();
        Place::new().run(&arguments).exits(0);
    }
}

#[test]
fn a_random_order_depends_on_its_seed_alone() {
    let place = Place::new();
    let plan = |order: &str| place.run(&["inspect", "soft_focus", "--order", order, "--format", "json"]).exits(0).out;
    assert_eq!(plan("random:7"), plan("random:7"));
    assert_eq!(plan("default"), place.run(&["inspect", "soft_focus", "--format", "json"]).exits(0).out);
}

#[test]
fn an_order_that_does_not_exist_is_refused_in_one_sentence() {
    for command in [&["check", "forward"][..], &["inspect", "forward"], &["run", "forward", "--scene", "s.ron"]] {
        for (order, said) in [
            ("fast", "expected file, default, low-memory or random:SEED, such as random:7"),
            ("random:", "the seed is a whole number, such as random:7"),
            ("random:-1", "the seed is a whole number, such as random:7"),
            ("random:18446744073709551616", "the seed must be 0 to 18446744073709551615"),
        ] {
            Place::new().run(&[command, &["--order", order]].concat()).exits(2).mentions(said);
        }
    }
}

/// Particles move while the sky is drawn.
const BESIDE: &str = r#"Pipeline(
    version: 1,
    images: [(name: "color", format: Color(hdr: true), size: Output), (name: "screen", format: Output, size: Output)],
    buffers: [
        (name: "flakes", bytes: 16000000, lifetime: History),
        (name: "seen", bytes: 4000000),
        (name: "counts", bytes: 16),
    ],
    passes: [
        (name: "sky", draw: Sky, color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
        (name: "fall", dispatch: "snow_fall", groups: Invocations(1000000, 1, 1),
            storage: {"before": (buffer: "flakes", previous: 1), "flakes": (buffer: "flakes", access: Write)},
            params: {"seconds": 0.016, "wind": 0.0}),
        (name: "gather", dispatch: "snow_gather", groups: Count(1, 1, 1), storage: {
            "flakes": "flakes", "seen": (buffer: "seen", access: Write), "counts": (buffer: "counts", access: Write),
        }),
        (name: "copied", draw: FullScreen("copy"), sample: {"source": "color"}, color: ["screen"]),
        (name: "snow", draw: Indirect("counts"), shader: "snow", storage: {"flakes": "flakes", "seen": "seen"},
            params: {"brightness": 1.0}, color: [(image: "screen", blend: Premultiplied)]),
    ],
    outputs: ["screen"],
)"#;

#[test]
fn work_on_other_queues_is_told_with_what_it_waits_for() {
    let place = Place::new();
    place.file("p.ron", BESIDE);
    let command =
        |word: &'static str, more: &[&'static str]| [&[word, "p.ron", "--device", "amd-rx-7800-xt"], more].concat();
    let said = place.run(&command("check", &[])).exits(0).out;
    assert!(said.contains(" between queues, "), "{said}");
    let note = "note: `fall`: runs on the compute queue, beside `sky`: that saves up to 7.0 MiB of work for it and the other step \
                that needs the same waits, and 2 waits cost as much as 4.0 MiB (p.ron:11:16)";
    assert!(said.contains(note), "{said}");
    let tree = place.run(&command("inspect", &[])).exits(0).out;
    assert!(tree.contains(" on the compute queue: dispatch") && tree.contains("waits in "), "{tree}");
    let plan = json(&place, &command("inspect", &[]), 0);
    let compute = plan["steps"].as_array().expect("steps").iter().filter(|step| step["queue"] == "COMPUTE").count();
    assert_eq!(compute, 2, "{tree}");

    let one = place.run(&command("check", &["--one-queue"])).exits(0).out;
    assert!(!one.contains("queue"), "{one}");
}
