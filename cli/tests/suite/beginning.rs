//! A pipeline to begin with, and the schema of what it is written in.

use crate::testing::{Place, Vulkan};

#[test]
fn a_new_pipeline_is_right_on_every_device_in_every_variant_and_draws() {
    let place = Place::new();
    place.run(&["new", "glow"]).exits(0);
    assert_eq!(place.names(), ["glow.ron"]);
    place.run(&["check", "glow.ron", "--all-variants", "--device", "all"]).exits(0);
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let run = ["run", "glow.ron", "--scene", "spheres_and_cubes", "--size", "64x48", "-o", "glow.png"];
    place.run_with(&variables, &run).exits(0);
    assert_eq!(place.names(), ["glow.png", "glow.ron"]);
}

#[test]
fn a_file_that_is_there_stays() {
    let place = Place::new();
    place.file("mine.ron", "mine");
    for name in ["mine", "mine.ron"] {
        place
            .run(&["new", name])
            .exits(1)
            .says("error: there is a file `mine.ron` already: choose another name, or move it away");
    }
    assert_eq!(std::fs::read_to_string(place.path("mine.ron")).expect("a text"), "mine");
    assert_eq!(place.names(), ["mine.ron"]);
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_nowhere_is_there_too() {
    let place = Place::new();
    std::os::unix::fs::symlink("elsewhere.ron", place.path("link.ron")).expect("linked");
    place.run(&["new", "link"]).exits(1).mentions("there is a file `link.ron` already");
    assert_eq!(place.names(), ["link.ron"]);
}

#[test]
fn names_that_make_no_file_are_refused() {
    let place = Place::new();
    for name in ["2d", "a b", "a.b", "..", "a/", "\u{1b}[2J"] {
        place.run(&["new", name]).exits(2).mentions("can't be the name of a pipeline: names are letters, digits");
    }
    place.run(&["new", "nowhere/glow"]).exits(3).mentions("help: its folder must exist: mkdir -p nowhere");
    assert!(place.names().is_empty());
}

#[test]
fn the_schema_is_json_and_so_is_a_file() {
    let place = Place::new();
    let json =
        |words: &[&str]| -> serde_json::Value { serde_json::from_str(&place.run(words).exits(0).out).expect("JSON") };
    let schema = json(&["schema"]);
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    place.run(&["new", "glow"]).exits(0);
    let file = json(&["schema", "glow.ron"]);
    assert_eq!(file["Pipeline"]["version"], 1);
    assert_eq!(file["Pipeline"]["passes"][1]["draw"], serde_json::json!({ "Sky": [] }));
}

#[test]
fn what_is_no_json_is_said_with_its_place() {
    let place = Place::new();
    place.file("p.ron", "Pipeline(version: 1, version: 2)");
    place.run(&["schema", "p.ron"]).exits(1).mentions("error: `version` stands here twice").mentions("p.ron:1:22");
    place.file("q.ron", "Pipeline(version: ");
    place.run(&["schema", "q.ron"]).exits(1).mentions("q.ron:1:");
}
