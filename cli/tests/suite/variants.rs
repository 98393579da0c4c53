//! `check --all-variants`: every combination of settings, facts of the scene and devices.

use crate::testing::{Outcome, Place, shipped_pipelines};
use framewright_graph::device::SHIPPED_PROFILES;
use framewright_tests::sweep;
use serde_json::Value;
use std::fmt::Write;

/// Wrong only with eight samples, without HDR, in a scene without transparent objects: then eight samples are copied to four.
const TREACHEROUS: &str = r#"Pipeline(
    version: 1,
    settings: [
        (name: "msaa", value: OneOf(default: 4, of: [4, 8])),
        (name: "hdr", value: Bool(default: true)),
        (name: "bright", value: Bool(default: false)),
        (name: "sky", value: Bool(default: true)),
        (name: "idle", value: Integer(default: 1, min: 0, max: 9)),
    ],
    images: [
        (name: "color", format: Color(hdr: true), size: Output, samples: "msaa"),
        (name: "kept", format: Like("color"), size: Output, samples: 4),
        (name: "screen", format: Output, size: Output),
    ],
    passes: [
        (name: "behind", draw: Sky, color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
        (name: "again", when: "sky || bright", draw: Sky, color: ["color"]),
        (name: "keep", when: "!hdr && !scene.has_transparent", copy: (from: "color", to: "kept")),
        (name: "show", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["screen"]),
    ],
    outputs: ["screen"],
)"#;

/// A scene in which nothing is transparent.
const SOLID: &str = r##"Scene(version: 1, materials: [(name: "stone", color: "#808080")], objects: [Cube(material: "stone", size: 1)])"##;

/// A pipeline with `count` switches, each of which turns a pass on.
fn switches(count: usize) -> String {
    let (mut settings, mut passes) = (String::new(), String::new());
    for at in 0..count {
        writeln!(settings, "(name: \"s{at}\", value: Bool(default: false)),").expect("memory");
        writeln!(passes, "(name: \"p{at}\", when: \"s{at}\", draw: Sky, color: [\"screen\"]),").expect("memory");
    }
    format!(
        "Pipeline(version: 1, settings: [\n{settings}], images: [(name: \"screen\", format: Output, size: Output)], passes: [\n\
         (name: \"first\", draw: Sky, color: [(image: \"screen\", clear: (0.0, 0.0, 0.0, 1.0))]),\n{passes}],\n\
         outputs: [\"screen\"])"
    )
}

fn check(place: &Place, words: &[&str]) -> Outcome {
    place.run(&[&["check"], words, &["--all-variants"]].concat())
}

fn json(place: &Place, words: &[&str], code: i32) -> Value {
    let outcome = check(place, &[words, &["--format", "json"]].concat()).exits(code);
    serde_json::from_str(&outcome.out).expect("JSON")
}

/// `name=value` of settings.
fn pairs(settings: &Value) -> Vec<String> {
    let text = |value: &Value| value.as_str().expect("text").to_owned();
    let settings = settings.as_array().expect("a list").iter();
    settings.map(|one| format!("{}={}", text(&one["name"]), text(&one["value"]))).collect()
}

fn names(axes: &Value) -> Vec<String> {
    let axes = axes.as_array().expect("a list").iter();
    axes.map(|axis| axis["name"].as_str().unwrap_or("device").to_owned()).collect()
}

#[test]
fn a_mistake_is_traced_to_the_least_that_brings_it_about() {
    let place = Place::new();
    place.file("p.ron", TREACHEROUS);
    let answer = json(&place, &["p.ron"], 1);
    // `idle` stands nowhere but in its declaration.
    assert_eq!(names(&answer["axes"]), ["msaa", "hdr", "bright", "sky", "scene.has_transparent", "device"]);
    assert_eq!((&answer["variants"], &answer["checked"]), (&32.into(), &32.into()));
    assert_eq!((&answer["failing"], &answer["fine"]), (&4.into(), &false.into()));
    let [failure] = &answer["failures"].as_array().expect("a list")[..] else { panic!("{answer:#}") };
    assert_eq!((&failure["variants"], &failure["each_is_needed"]), (&4.into(), &true.into()));
    let cause = &failure["breaks_with"];
    assert_eq!(pairs(&cause["settings"]), ["msaa=8", "hdr=false"]);
    assert_eq!(cause["facts"], serde_json::json!([{ "name": "scene.has_transparent", "value": "false" }]));
    assert_eq!(cause["device"], Value::Null);
    assert_eq!(failure["diagnostic"]["line"], 18);

    let out = check(&place, &["p.ron"]).exits(1).says("").out;
    let said = "in 4 variants; breaks with --set msaa=8 --set hdr=false in a scene where scene.has_transparent = false";
    assert!(out.contains(said), "{out}");
    assert!(out.contains("p.ron: wrong in 4 of 32 variants: msaa (2) × hdr (2) × "), "{out}");
}

#[test]
fn the_cause_holds_for_the_other_commands_too_and_no_part_of_it_can_be_left_out() {
    let place = Place::new();
    place.file("p.ron", TREACHEROUS);
    place.file("solid.ron", SOLID);
    let inspect = |words: &[&str]| place.run(&[&["inspect", "p.ron", "--scene", "solid.ron"], words].concat());
    inspect(&["--set", "msaa=8", "--set", "hdr=false"]).exits(1).mentions("p.ron:18:");
    inspect(&["--set", "msaa=8"]).exits(0);
    inspect(&["--set", "hdr=false"]).exits(0);
    place.run(&["check", "p.ron", "--set", "msaa=8", "--set", "hdr=false"]).exits(0);
}

#[test]
fn a_mistake_of_one_device_is_said_of_it() {
    let place = Place::new();
    let large = TREACHEROUS.replacen(
        "(name: \"kept\"",
        "(name: \"wide\", format: Output, size: Fixed(9000, 9000)), (name: \"kept\"",
        1,
    );
    let large = large.replacen("outputs: [", "outputs: [\"wide\", ", 1).replacen(
        "passes: [",
        "passes: [(name: \"wide\", draw: Sky, color: [(image: \"wide\", clear: (0.0, 0.0, 0.0, 1.0))]),",
        1,
    );
    place.file("p.ron", large);
    let answer = json(&place, &["p.ron", "--device", "all", "--set", "hdr=true"], 1);
    let [failure] = &answer["failures"].as_array().expect("a list")[..] else { panic!("{answer:#}") };
    assert_eq!(failure["devices"], serde_json::json!(["swiftshader"]));
    assert_eq!(failure["breaks_with"]["device"], "swiftshader");
    let out = check(&place, &["p.ron", "--device", "all", "--set", "hdr=true"]).exits(1).out;
    assert!(out.contains(" on swiftshader; breaks with --device swiftshader\n"), "{out}");
}

#[test]
fn what_is_wrong_with_the_defaults_and_with_all_variants_is_said_so() {
    let place = Place::new();
    place.file("p.ron", TREACHEROUS.replace("\"reinhard\"", "\"reinhart\""));
    let out = check(&place, &["p.ron"]).exits(1).out;
    assert!(out.contains("in 32 variants; breaks with the defaults\n"), "{out}");
    assert!(out.contains("in 4 variants; breaks with --set msaa=8"), "{out}");
    assert_eq!(out.matches("error: ").count(), 2, "{out}");
}

#[test]
fn a_file_that_cannot_be_read_is_an_answer_for_programs_and_an_error_for_people() {
    let place = Place::new();
    place.file("p.ron", TREACHEROUS.replace("from: \"color\"", "from: \"colr\""));
    check(&place, &["p.ron"]).exits(1).mentions("did you mean `color`?");
    let answer = json(&place, &["p.ron"], 1);
    assert_eq!((answer["diagnostics"].as_array().map(Vec::len), &answer["variants"]), (Some(1), &0.into()));
    check(&place, &["forward", "--set", "msaa=3"]).exits(2).mentions("doesn't allow `3`");
    place.run(&["check", "forward", "--pairwise"]).exits(2).mentions("--all-variants");
    place.run(&["check", "forward", "--threads", "2"]).exits(2).mentions("--all-variants");
    check(&place, &["forward", "--threads", "0"]).exits(2);
}

/// Which have too many variants on all devices: of these every pair of choices is checked.
const IN_PAIRS: [&str; 4] = ["deferred", "deferred_mobile", "image_quality", "shadows"];

#[test]
fn every_shipped_pipeline_is_fine_in_every_variant_on_every_shipped_device() {
    let place = Place::new();
    for name in sweep::of("variants of pipelines", shipped_pipelines(), 1) {
        let pipeline = &*name;
        let all = [pipeline, "--device", "all"];
        let answer = json(&place, &all, 0);
        assert_eq!(answer["pairwise"], IN_PAIRS.contains(&pipeline), "{pipeline}");
        assert_eq!((&answer["fine"], &answer["failing"]), (&true.into(), &0.into()), "{pipeline}");
        let devices = answer["axes"].as_array().and_then(|axes| axes.last()).expect("an axis");
        assert_eq!(devices["values"].as_array().map(Vec::len), Some(SHIPPED_PROFILES.len()));
        let of_plans = answer["plans"].as_array().expect("a list").iter().map(|plan| plan["variants"].as_u64());
        assert_eq!(of_plans.map(|count| count.expect("a count")).sum::<u64>(), answer["variants"], "{pipeline}");
    }
    // Samples, HDR, tone mapping, two white points; masked, fading and transparent objects; five greatest radiances.
    assert_eq!(json(&place, &["forward"], 0)["variants"], 4 * 2 * 2 * 2 * 2 * 2 * 2 * 5);
}

#[test]
fn plans_that_differ_only_in_the_text_of_a_setting_are_one() {
    let place = Place::new();
    place.file("p.ron", TREACHEROUS);
    // Whether the sky is drawn again or is bright, and whatever is transparent where `hdr` decides, the Plan is the same.
    let words = ["p.ron", "--set", "msaa=4", "--set", "hdr=true"];
    let answer = json(&place, &words, 0);
    assert_eq!(pairs(&answer["chosen"]), ["msaa=4", "hdr=true"]);
    assert_eq!(names(&answer["axes"]), ["bright", "sky", "scene.has_transparent", "device"]);
    let passes: Vec<_> = answer["plans"].as_array().expect("a list").iter().map(|it| &it["totals"]["passes"]).collect();
    assert!(passes.contains(&&Value::from(3)) && passes.contains(&&Value::from(2)), "{answer:#}");
    assert_eq!((&answer["variants"], &answer["plans"][0]["variants"]), (&8.into(), &6.into()), "{answer:#}");
    assert_eq!(pairs(&answer["plans"][0]["example"]["settings"]), [""; 0]);
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let place = Place::new();
    place.file("p.ron", TREACHEROUS);
    for words in [
        &["p.ron", "--device", "all"][..],
        &["p.ron", "--device", "all", "--format", "json"],
        &["p.ron", "--device", "all", "--pairwise", "--format", "json"],
    ] {
        let with = |threads: &str| check(&place, &[words, &["--threads", threads]].concat()).exits(1).out;
        let one = with("1");
        assert!(["2", "3", "16"].iter().all(|threads| with(threads) == one), "{one}");
    }
}

#[test]
fn of_too_many_variants_pairs_are_checked_and_that_is_said() {
    let place = Place::new();
    place.file("p.ron", switches(60));
    check(&place, &["p.ron"])
        .exits(0)
        .mentions("note: there are 1152921504606846976 combinations, and of more than 250000 each pair of values is checked, as by `--pairwise`");
    let answer = json(&place, &["p.ron"], 0);
    assert_eq!(answer, json(&place, &["p.ron", "--pairwise"], 0));
    assert_eq!((&answer["fine"], &answer["pairwise"]), (&true.into(), &true.into()));
    assert!(answer["variants"].as_u64().is_some_and(|variants| (6..=20).contains(&variants)), "{}", answer["variants"]);
    let out = check(&place, &["p.ron", "--pairwise"]).exits(0).says("").out;
    assert!(out.contains(": every pair of values of s0 (2), s1 (2), "), "{out}");
}

#[test]
fn pairs_find_what_two_settings_break() {
    let place = Place::new();
    let broken = "(name: \"broken\", when: \"s17 && s31\", draw: FullScreen(\"none\"), color: [\"screen\"])],\noutputs";
    place.file("p.ron", switches(40).replacen("],\noutputs", broken, 1));
    let answer = json(&place, &["p.ron", "--pairwise"], 1);
    assert_eq!(pairs(&answer["failures"][0]["breaks_with"]["settings"]), ["s17=true", "s31=true"]);
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_check_tells_what_it_found_so_far() {
    let place = Place::new();
    // Minutes of work.
    place.file("p.ron", switches(17));
    for format in ["human", "json"] {
        let arguments = ["check", "p.ron", "--all-variants", "--format", format];
        let child = place
            .command(&arguments)
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .expect("it starts");
        // Until the signal is caught it would be the end.
        while !catches_interrupts(child.id()) {
            std::thread::yield_now();
        }
        let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(kill.expect("kill runs").success());
        let output = child.wait_with_output().expect("it ends");
        let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(130), "{out}\n{err}");
        if format == "human" {
            assert!(out.contains(" (interrupted: of 131072 in all): s0 (2) × "), "{out}");
        } else {
            let answer: Value = serde_json::from_str(&out).expect("JSON");
            assert_eq!((&answer["interrupted"], &answer["variants"]), (&true.into(), &131_072.into()));
            assert!(answer["checked"].as_u64() < Some(131_072));
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_terminal_a_line_every_few_seconds_says_how_many_how_fast_and_how_long() {
    use std::io::{BufRead, BufReader};
    let place = Place::new();
    place.file("p.ron", switches(17));
    let mut command = place.command(&["check", "p.ron", "--all-variants", "--threads", "1"]);
    command.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::piped());
    let begun = std::time::Instant::now();
    let mut child = command.spawn().expect("it starts");
    let lines = BufReader::new(child.stderr.take().expect("piped")).lines();
    let said: Vec<String> = lines.map(|line| line.expect("text")).take(2).collect();
    let took = begun.elapsed().as_secs();
    child.kill().expect("it runs");
    child.wait().expect("it ends");
    assert!((8..30).contains(&took), "two lines after {took} s");
    for line in said {
        let words: Vec<&str> = line.split(' ').collect();
        let ["note:", "checked", _, "of", "131072", "variants,", _, "a", "second,", .., "left"] = words[..] else {
            panic!("{line}")
        };
    }
}

/// Whether a process has a handler for SIGINT.
#[cfg(target_os = "linux")]
fn catches_interrupts(process: u32) -> bool {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).expect("it runs");
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).expect("Linux says so");
    // Bit n - 1 stands for signal n; SIGINT is 2.
    u64::from_str_radix(caught.trim(), 16).expect("hexadecimal") & 0b10 != 0
}

#[test]
fn a_mistake_beyond_a_number_of_lights_is_found() {
    let place = Place::new();
    let text = TREACHEROUS
        .replace("!hdr && !scene.has_transparent", "!hdr && scene.point_lights >= 12 && scene.point_lights < 20");
    place.file("p.ron", text);
    let answer = json(&place, &["p.ron"], 1);
    let cause = &answer["failures"][0]["breaks_with"];
    assert_eq!(cause["facts"], serde_json::json!([{ "name": "scene.point_lights", "value": "12" }]));
    let axis = answer["axes"].as_array().and_then(|axes| axes.iter().find(|axis| axis["name"] == "scene.point_lights"));
    assert_eq!(
        axis.expect("it varies")["values"],
        serde_json::json!(["4096", "0", "11", "12", "13", "19", "20", "21"])
    );
}

#[test]
fn plans_that_differ_in_values_alone_are_one_line_for_people_and_each_its_own_for_programs() {
    let place = Place::new();
    let exposed = r#"Pipeline(
    version: 1,
    settings: [
        (name: "msaa", value: OneOf(default: 4, of: [1, 4])),
        (name: "white_point", value: OneOf(default: 4, of: [4, 8, 16])),
    ],
    images: [
        (name: "color", format: Color(hdr: true), size: Output, samples: "msaa"),
        (name: "screen", format: Output, size: Output),
    ],
    passes: [
        (name: "behind", draw: Sky, color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
        (name: "show", draw: FullScreen("tone_map"), sample: {"source": "color"},
            params: {"exposure": 1.0, "white_point": "white_point"}, color: ["screen"]),
    ],
    outputs: ["screen"],
)"#;
    place.file("p.ron", exposed);
    let told = check(&place, &["p.ron"]).exits(0).out;
    let alike = "\n  3 variants, 3 Plans that differ in values alone, such as with ";
    assert!(told.starts_with(&format!("6 distinct Plans{alike}the defaults: ")), "{told}");
    assert_eq!(told.matches(alike).count(), 2, "{told}");
    assert!(told.contains(&format!("{alike}--set msaa=1: ")), "{told}");
    assert_eq!(json(&place, &["p.ron"], 0)["plans"].as_array().map(Vec::len), Some(6));
}
