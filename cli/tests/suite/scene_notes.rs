//! Entries of a scene that aren't drawn are told by every command that reads it.

use crate::testing::server::Server;
use crate::testing::{Place, Vulkan};
use serde_json::Value;

const SCENE: &str = r#"{
    "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_unlit"],
    "buffers": [{"uri": "triangle.bin", "byteLength": 36.0}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [{"extensions": {"KHR_materials_unlit": {}}, "pbrMetallicRoughness": {"roughnessFactor": 0.1}}],
    "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]
}"#;

const NOTES: [&str; 3] = [
    "the extension `KHR_materials_unlit` is not supported, and ignored (material 0)",
    "metallic factors, 1 where none is given, are ignored (material 0)",
    "roughness factors are ignored (material 0)",
];

fn place() -> Place {
    let place = Place::new();
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
    place.file("triangle.bin", bytes);
    place.file("scene.gltf", SCENE);
    place
}

#[test]
fn inspect_and_facts_tell_what_a_scene_says_that_is_not_drawn() {
    for arguments in [&["inspect", "forward", "--scene", "scene.gltf"][..], &["facts", "scene.gltf"]] {
        let outcome = place().run(arguments).exits(0);
        for note in NOTES {
            assert_eq!(outcome.err.matches(&format!("note: scene.gltf: {note}\n")).count(), 1, "{}", outcome.err);
        }
    }
}

/// The scene with another triangle, whose corners don't make whole triangles, and a factor above 1.
fn with_mistakes(place: &Place) {
    let mut scene: Value = serde_json::from_str(SCENE).expect("JSON");
    let bad = serde_json::json!({"attributes": {"POSITION": 0}, "indices": 3});
    scene["meshes"][0]["primitives"].as_array_mut().expect("a list").insert(0, bad);
    scene["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = serde_json::json!([1.5, 1, 1, 1]);
    place.file("wrong.gltf", scene.to_string());
}

const MISTAKES: [&str; 2] = [
    "material 0: a base colour factor is 1.5; expected 0 to 1, so it is taken as 1",
    "mesh 0, primitive 0: refers to accessor 3, but there are only 1, so it is left out",
];

#[test]
fn mistakes_in_a_scene_are_notes_and_with_strict_an_error_in_every_command_that_reads_one() {
    let place = place();
    with_mistakes(&place);
    let commands: [&[&str]; 5] = [
        &["inspect", "forward", "--scene", "wrong.gltf"],
        &["explain", "forward", "opaque", "--scene", "wrong.gltf"],
        &["diff", "forward", "forward", "--scene", "wrong.gltf"],
        &["facts", "wrong.gltf"],
        &["facts", "--json", "wrong.gltf"],
    ];
    for command in commands {
        let outcome = place.run(command).exits(0);
        for mistake in MISTAKES {
            assert!(outcome.err.contains(&format!("note: wrong.gltf: {mistake}\n")), "{command:?}: {}", outcome.err);
        }
        let outcome = place.run(&[command, &["--strict"]].concat()).exits(1);
        let said = format!(
            "error: `wrong.gltf` has mistakes, and `--strict` passes over none: [E1404]\n  {}",
            MISTAKES.join("\n  ")
        );
        assert!(outcome.err.contains(&said), "{command:?}: {}", outcome.err);
    }
    // What is right and isn't drawn is no mistake.
    place.run(&["facts", "scene.gltf", "--strict"]).exits(0).mentions("are ignored");
    // The window reads it as the others do, and needs a screen.
    let help = place.run(&["window", "--help"]).exits(0).out;
    assert!(help.contains("--strict"), "{help}");
}

#[test]
fn with_strict_a_scene_with_mistakes_is_neither_drawn_nor_measured_nor_shown() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = place();
    with_mistakes(&place);
    let scene = ["forward", "--scene", "wrong.gltf", "--size", "16x16"];
    let said =
        format!("`wrong.gltf` has mistakes, and `--strict` passes over none: [E1404]\n  {}", MISTAKES.join("\n  "));
    for (command, made) in [("run", "made.png"), ("measure", "made")] {
        let further: &[&str] =
            if command == "run" { &[] } else { &["--frames", "1", "--sweep", "msaa=1", "--reference", "none"] };
        let run = [&[command], &scene[..], further, &["-o", made]].concat();
        place.run_with(&variables, &[&run[..], &["--strict"]].concat()).exits(1).mentions(&format!("error: {said}\n"));
        assert!(!place.path(made).exists(), "{command}");
        let outcome = place.run_with(&variables, &run).exits(0);
        assert!(MISTAKES.iter().all(|mistake| outcome.err.contains(mistake)), "{command}: {}", outcome.err);
    }
    // A page tells it, and shows a picture as soon as the file is mended.
    for strict in [&["--strict"][..], &[]] {
        with_mistakes(&place);
        let server = Server::start(&place, &variables, &[&scene[..], strict].concat());
        let mut state = server.state_after(0);
        let message = |state: &Value| state["live"]["message"].as_str().expect("a text").to_owned();
        if !strict.is_empty() {
            assert!(message(&state).contains(&said), "{}", state["live"]);
            assert_eq!(state["live"]["outputs"], Value::from(Vec::<Value>::new()), "{}", state["live"]);
            place.file("wrong.gltf", SCENE);
            while !message(&state).is_empty() {
                state = server.state_after(state["live"]["version"].as_u64().expect("a number"));
            }
        }
        assert_eq!(
            (&*message(&state), state["live"]["outputs"].as_array().map(Vec::len)),
            ("", Some(1)),
            "{}",
            state["live"]
        );
    }
}

#[test]
fn a_scene_with_nothing_to_draw_says_so_and_is_drawn_all_the_same() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = place();
    // As a file whose mesh is compressed has it.
    place.file("empty.gltf", SCENE.replace("\"bufferView\": 0, ", ""));
    let run = ["run", "forward", "--scene", "empty.gltf", "--size", "16x16", "-o", "sky.png"];
    let nothing = "there is nothing to draw: no triangle of the file has an area";
    place.run_with(&variables, &run).exits(0).mentions(&format!("note: empty.gltf: {nothing}\n"));
    assert!(place.path("sky.png").exists());
    place.run_with(&variables, &[&run[..], &["--strict"]].concat()).exits(1).mentions(nothing);
}

#[test]
fn run_tells_what_a_scene_says_that_is_not_drawn_and_reports_it() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = place();
    let arguments = ["run", "forward", "--scene", "scene.gltf", "--size", "16x16", "--report", "report.json"];
    let outcome = place.run_with(&variables, &arguments).exits(0);
    for note in NOTES {
        assert!(outcome.err.contains(&format!("note: scene.gltf: {note}\n")), "{}", outcome.err);
    }
    let report = std::fs::read_to_string(place.path("report.json")).expect("written");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    assert_eq!(report["scene_notes"], Value::from(NOTES.to_vec()));
}

#[test]
fn run_tells_like_inspect_that_a_scene_needs_finer_depth_than_was_asked_for() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let outcome = |near: &str, command: &str, rest: &[&str]| {
        let scene = "Scene(version: 1, camera: (position: (0, 2, 9), target: (0, 0, 0), fov: 40, near: NEAR),\n\
            materials: [(name: \"plain\", color: (1, 1, 1))], objects: [Cube(name: \"a\", material: \"plain\", size: 2)])\n";
        place.file("scene.ron", scene.replace("NEAR", near));
        let smallest =
            ["image_quality", "--scene", "scene.ron", "--size", "16x16", "--set", "depth_precision=Smallest"];
        place.run_with(&variables, &[&[command], &smallest[..], rest].concat()).exits(0)
    };
    let plan: Value = serde_json::from_str(&outcome("0.0001", "inspect", &["--format", "json"]).out).expect("JSON");
    let notes = plan["notes"].as_array().expect("a list");
    let text = |note: &&Value| note["text"].as_str().is_some_and(|text| text.contains("D16_UNORM is too coarse"));
    let note = notes.iter().find(text).expect("it is noted");
    let said = format!("note: `depth`: {} (image_quality.ron:", note["text"].as_str().expect("a text"));
    outcome("0.0001", "run", &[]).mentions(&said);
    let fine = outcome("0.1", "run", &[]);
    assert!(!fine.err.contains("too coarse"), "{}", fine.err);
}
