//! `facts`: what conditions may ask of a scene, and what decided it (NU-6).

use crate::testing::Place;
use framewright_graph::language::Fact;
use serde_json::Value;

#[test]
fn each_fact_is_printed_with_what_decided_it() {
    let place = Place::new();
    let out = place.run(&["facts", "spheres_and_cubes"]).exits(0).out;
    let lines: Vec<&str> = out.lines().collect();
    for line in [
        "scene.has_transparent: true (4 objects: `bubble`, `amber block`, `rose ball`, …)",
        "scene.has_alpha_clip: true (3 objects: `sieve`, `lattice`, `far lattice`)",
        "scene.has_cross_fade: false (no object)",
        "scene.casts_shadows: false (no light that shines has `shadows: true`)",
        "scene.shadow_cascades: 0 (the sun casts none)",
        "scene.point_lights: 2",
        "scene.lights: 3",
        "scene.objects: 67",
    ] {
        assert!(lines.contains(&line), "`{line}` is not in\n{out}");
    }
    assert_eq!(lines.len(), Fact::ALL.len(), "{out}");
    assert!(lines.contains(&"scene.exposure: 1 (the file's own numbers are drawn)"), "{out}");
    assert!(lines.iter().any(|line| line.starts_with("scene.size: 6.06")), "{out}");
    // The lamp emits 12.
    assert!(lines.iter().any(|line| line.starts_with("scene.peak_radiance: 1") && line.contains("`lamp`")), "{out}");
}

#[test]
fn programs_read_the_same_as_people() {
    let place = Place::new();
    let answer: Value =
        serde_json::from_str(&place.run(&["facts", "spheres_and_cubes", "--json"]).exits(0).out).expect("JSON");
    assert_eq!(answer["format_version"], 1);
    let people = place.run(&["facts", "spheres_and_cubes"]).exits(0).out;
    let facts = answer["facts"].as_array().expect("a list");
    assert_eq!(facts.len(), people.lines().count());
    for (fact, line) in facts.iter().zip(people.lines()) {
        let (name, value) = (fact["name"].as_str().expect("a name"), &fact["value"]);
        let ty = fact["type"].as_str().expect("a type");
        // A whole number that is one of many is `1.0` in JSON.
        let shown =
            value.as_f64().filter(|_| ty == "Number").map_or_else(|| value.to_string(), |number| number.to_string());
        assert!(
            line.starts_with(&format!("{name}: {shown} ")) || line == format!("{name}: {shown}"),
            "{line} and {fact}"
        );
        assert_eq!(ty == "Bool", value.is_boolean(), "{fact}");
        assert_eq!(ty == "Integer", value.is_i64(), "{fact}");
        assert!(fact["about"].as_str().is_some_and(|about| about.len() > 10), "{fact}");
        assert!(line.contains(fact["because"].as_str().expect("a cause")), "{line} and {fact}");
    }
}

#[test]
fn a_fading_object_and_shadows_are_facts() {
    let place = Place::new();
    place.file(
        "fading.ron",
        r#"Scene(version: 1, sun: (direction: (0, -1, 0), shadows: true),
            lights: [(position: (0, 9, 0), shadows: true), (position: (0, 9, 0), intensity: 0)],
            materials: [(name: "plain")], objects: [
            Cube(name: "near", material: "plain", size: 1, cross_fade: 0.3),
            Sphere(name: "far", material: "plain", radius: 0.5, cross_fade: -0.3)])"#,
    );
    let out = place.run(&["facts", "fading.ron"]).exits(0).out;
    for line in [
        "scene.has_opaque: false (no object)",
        "scene.has_alpha_clip: false (no object)",
        "scene.has_cross_fade: true (2 objects: `near`, `far`)",
        "scene.casts_shadows: true (the sun, point light 0)",
        "scene.point_lights: 1 (1 more give no light)",
    ] {
        assert!(out.lines().any(|found| found == line), "`{line}` is not in\n{out}");
    }
}

#[test]
fn names_of_a_file_reach_no_terminal_raw() {
    let place = Place::new();
    // Names in RON can't hold control characters; those in glTF can.
    let json = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"name":"a\u001b[31m\nb","mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]}"#;
    let json = format!("{json:<width$}", width = json.len().next_multiple_of(4));
    let corners = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    let chunk = |kind: &[u8; 4], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), &kind[..], bytes].concat();
    let chunks = [chunk(b"JSON", json.as_bytes()), chunk(b"BIN\0", &corners)].concat();
    let header = [b"glTF", &2_u32.to_le_bytes()[..], &(12 + chunks.len() as u32).to_le_bytes()].concat();
    place.file("named.glb", [header, chunks].concat());
    let out = place.run(&["facts", "named.glb"]).exits(0).out;
    assert!(out.contains("1 object: `a\\u{1b}[31m\\nb`") && !out.contains('\u{1b}'), "{out:?}");
    let json = place.run(&["facts", "named.glb", "--json"]).exits(0).out;
    assert!(json.contains("\\u001b") && !json.contains('\u{1b}'), "{json:?}");
}

#[test]
fn what_is_no_scene_ends_as_everywhere() {
    let place = Place::new();
    place.run(&["facts"]).exits(2);
    place.run(&["facts", "nothing.ron"]).exits(1).mentions("there is no scene `nothing.ron`");
    place.file("wrong.ron", "Scene(version: 1, materials: [], objects: [], sun: (direction: (0, 0, 0), shadows: 3))");
    place.run(&["facts", "wrong.ron"]).exits(1).mentions("wrong.ron:1:");
}
