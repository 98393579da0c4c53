//! `diff`: the differences between two Plans (IN-4).

use crate::testing::{FORWARD, Place};
use serde_json::Value;

fn read(place: &Place, file: &str) -> String {
    std::fs::read_to_string(place.path(file)).expect("it is there")
}

#[test]
fn a_setting_or_a_device_of_the_second_plan_alone_makes_the_difference() {
    let place = Place::new();
    let same = place.run(&["diff", "forward", "--a", "msaa=1", "--set", "msaa=1"]).exits(0).out;
    assert_eq!(same, "A: forward on lavapipe\nB: forward on lavapipe\n\nno difference\n");
    let out = place.run(&["diff", "forward", "--set", "msaa=4", "--a", "msaa=1"]).exits(0).out;
    assert!(out.contains("\n  ~ `msaa`: value 4 (was 1)\n") && out.contains("resolves          0 → 1 (+1)\n"), "{out}");
    let out = place.run(&["diff", "forward", "--b", "@device=amd-rx-7800-xt", "--b", "@size=640x360"]).exits(0).out;
    assert!(out.starts_with("A: forward on lavapipe\nB: forward on AMD Radeon RX 7800 XT\n"), "{out}");
    assert!(out.contains("size 640×360 (was 1280×720)"), "{out}");
}

#[test]
fn a_plan_in_a_file_is_compared_like_its_pipeline() {
    let place = Place::new();
    place.file("forward.ron", FORWARD);
    place.run(&["inspect", "forward.ron", "--format", "json", "-o", "before.json"]).exits(0);
    let out = place.run(&["diff", "before.json", "forward.ron"]).exits(0).out;
    assert!(out.ends_with("\nno difference\n"), "{out}");
    let out = place.run(&["diff", "before.json", "forward.ron", "--b", "msaa=1", "--format", "json"]).exits(0).out;
    let found: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!((&found["a"]["name"], &found["b"]["name"]), (&"before.json".into(), &"forward.ron".into()));
    let resolve = found["entries"].as_array().expect("entries").iter().find(|it| it["kind"] == "resolve");
    assert_eq!(resolve.expect("a resolve")["change"], "removed", "{out}");
    place.run(&["diff", "before.json", "forward.ron", "--format", "markdown", "-o", "pr.md"]).exits(0);
    assert_eq!(read(&place, "pr.md"), "A: before.json on lavapipe  \nB: forward.ron on lavapipe\n\nNo difference.\n");
}

#[test]
fn wrong_choices_and_damaged_plans_are_told() {
    let place = Place::new();
    place.file("forward.ron", FORWARD);
    place.run(&["inspect", "forward.ron", "--format", "json", "-o", "plan.json"]).exits(0);
    let plan = read(&place, "plan.json");
    place.file("cut.json", &plan[..plan.len() / 2]);
    place.run(&["diff", "cut.json", "forward.ron"]).exits(1).mentions("cut.json: not a Plan: ");
    place.file("newer.json", plan.replacen("\"format_version\": 14", "\"format_version\": 99", 1));
    place.run(&["diff", "newer.json", "forward.ron"]).exits(1).mentions("the Plan has format version 99");
    place.file("wrong.json", plan.replacen("\"SHADER_READ_ONLY_OPTIMAL\"", "\"GENERAL\"", 1));
    place.run(&["diff", "wrong.json", "forward.ron"]).exits(1).mentions("wrong.json: the Plan is not right: ");
    place.run(&["diff", "plan.json", "--a", "msaa=1"]).exits(2).mentions("--a chooses something for `plan.json`");
    for (option, value) in [("--set", "msaa=1"), ("--device", "lavapipe"), ("--scene", "courtyard")] {
        let both = ["diff", "plan.json", "plan.json", option, value];
        place.run(&both).exits(2).mentions(&format!("{option} chooses something for `plan.json`"));
    }
    place.run(&["diff", "forward.ron", "--b", "@speed=1"]).exits(2).mentions("--b @speed: expected a setting, @device");
    place.run(&["diff", "forward.ron", "--b", "@size=0x1"]).exits(2).mentions("--b @size: ");
    place.run(&["diff", "forward.ron", "--b", "msaa=3"]).exits(2).mentions("doesn't allow `3`");
    place.run(&["diff", "forward.ron", "gone.ron"]).exits(1).mentions("there is no pipeline `gone.ron`");
    place.run(&["diff", "forward.ron", "plan.json", "-o", "plan.json"]).exits(2);
    assert_eq!(read(&place, "plan.json"), plan, "it is as it was");
}
