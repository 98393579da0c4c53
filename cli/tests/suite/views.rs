//! Several views of a real scene in one frame, each drawn as it would be alone.

use crate::testing::{Outcome, Place, Vulkan, repository};

/// The settings of the pipeline, and the fragment that each view draws.
const FRAGMENT: &str = r#"
    settings: [
        (name: "msaa", value: OneOf(default: 4, of: [1, 4])),
        (name: "tone_mapping", value: Bool(default: true)),
        (name: "white_point", value: Number(default: 100.0, min: 1.0, max: 100.0)),
    ],
    fragments: [
        (name: "objects",
            parameters: [
                (name: "target", value: Image), (name: "samples", value: Integer),
                (name: "tone_mapping", value: Bool), (name: "white_point", value: Number),
            ],
            images: [
                (name: "color", format: Color(hdr: true), size: Output, samples: "if(view.allows_msaa, samples, 1)"),
                (name: "depth", format: Depth, size: Like("color"), samples: Like("color")),
            ],
            passes: [
                (name: "opaque", draw: Objects(Opaque), shader: "lit",
                    color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "depth", clear: 0.0)),
                (name: "masked", draw: Objects(Masked), shader: "lit_masked", color: ["color"], depth: "depth"),
                (name: "sky", draw: Sky, color: ["color"], depth: (image: "depth", write: false)),
                (name: "transparent", draw: Objects(Transparent), shader: "lit",
                    color: [(image: "color", blend: Premultiplied)], depth: (image: "depth", write: false)),
                (name: "tone_map", when: "tone_mapping", draw: FullScreen("tone_map"), sample: {"source": "color"},
                    params: {"exposure": 1.0, "white_point": "white_point"}, color: ["target"],
                    otherwise: Forward(from: "color", to: "target")),
            ]),
    ],"#;

const ARGUMENTS: &str = r#""samples": "msaa", "tone_mapping": "tone_mapping", "white_point": "white_point""#;

/// A frame of three views: the scene's own camera, another with fewer effects, and another with other ones.
fn three() -> String {
    format!(
        r#"Pipeline(version: 1, {FRAGMENT}
            views: [
                (name: "main"),
                (name: "preview", size: Scaled(0.25), camera: "top", allows_msaa: false, set: {{"tone_mapping": false}}),
                (name: "mirror", size: Fixed(100, 30), set: {{"white_point": 2.0}}),
            ],
            images: [
                (name: "screen", format: Output, size: Output),
                (name: "small", view: "preview", format: Output, size: Output),
                (name: "wide", view: "mirror", format: Output, size: Output),
            ],
            passes: [
                (use: "objects", name: "world", with: {{"target": "screen", {ARGUMENTS}}}),
                (use: "objects", name: "from_above", view: "preview", with: {{"target": "small", {ARGUMENTS}}}),
                (use: "objects", name: "behind", view: "mirror", with: {{"target": "wide", {ARGUMENTS}}}),
            ],
            outputs: ["screen", "small", "wide"])"#
    )
}

/// A frame without views.
fn one() -> String {
    format!(
        r#"Pipeline(version: 1, {FRAGMENT}
            images: [(name: "screen", format: Output, size: Output)],
            passes: [(use: "objects", name: "world", with: {{"target": "screen", {ARGUMENTS}}})],
            outputs: ["screen"])"#
    )
}

const OWN: &str = "camera: (position: (7.6, 3.5, 9.6), target: (0.1, 1.0, 0.3), fov: 36),";
const TOP: &str = "position: (0.5, 14, 1), target: (0, 0, 0), up: (0, 0, -1), fov: 50";

/// The shipped scene, with these cameras.
fn scene(cameras: &str) -> String {
    let text = std::fs::read_to_string(repository("examples/scenes/spheres_and_cubes.ron")).expect("the scene");
    assert!(text.contains(OWN), "the scene has its camera");
    text.replace(OWN, cameras)
}

fn run(place: &Place, vulkan: Vulkan, more: &[&str]) -> Option<Outcome> {
    let variables = vulkan.variables()?;
    Some(place.run_with(&variables, &[&["run", "--validate"], more].concat()))
}

fn each_view_is_what_it_would_be_alone(vulkan: Vulkan) {
    let place = Place::new();
    place.file("three.ron", three());
    place.file("one.ron", one());
    place.file("scene.ron", scene(&format!("{OWN} cameras: [(name: \"top\", {TOP})],")));
    place.file("from_above.ron", scene(&format!("camera: ({TOP}),")));
    let outputs = ["-o", "screen.png", "-o", "small=small.png", "-o", "wide=wide.png"];
    let arguments = [&["three.ron", "--scene", "scene.ron", "--size", "160x90"][..], &outputs].concat();
    let Some(outcome) = run(&place, vulkan, &arguments) else { return };
    let outcome = outcome.exits(0);
    assert!(outcome.out.contains("validation: silent; "), "{}", outcome.out);
    let alone: [(&str, &[&str]); 3] = [
        ("screen.png", &["one.ron", "--scene", "scene.ron", "--size", "160x90"]),
        (
            "small.png",
            &[
                "one.ron",
                "--scene",
                "from_above.ron",
                "--size",
                "40x22",
                "--set",
                "msaa=1",
                "--set",
                "tone_mapping=false",
            ],
        ),
        ("wide.png", &["one.ron", "--scene", "scene.ron", "--size", "100x30", "--set", "white_point=2"]),
    ];
    let read = |name: &str| std::fs::read(place.path(name)).expect("written");
    for (name, arguments) in alone {
        if let Some(outcome) = run(&place, vulkan, &[arguments, &["-o", "alone.png"]].concat()) {
            outcome.exits(0);
        }
        assert!(read(name) == read("alone.png"), "{name} is another picture than its view alone");
    }
    assert_ne!(read("screen.png").len(), read("wide.png").len());
}

#[test]
fn lavapipe_draws_each_view_as_it_would_be_alone() {
    each_view_is_what_it_would_be_alone(Vulkan::LAVAPIPE_CURRENT);
}

#[test]
fn swiftshader_draws_each_view_as_it_would_be_alone() {
    each_view_is_what_it_would_be_alone(Vulkan::SWIFTSHADER_CURRENT);
}

#[test]
fn a_camera_that_the_scene_lacks_is_said() {
    let place = Place::new();
    place.file("three.ron", three());
    place.run(&["check", "three.ron"]).exits(0);
    let Some(outcome) = run(&place, Vulkan::LAVAPIPE_CURRENT, &["three.ron", "--scene", "spheres_and_cubes"]) else {
        return;
    };
    outcome.exits(1).mentions("view `preview`").mentions("`top`");
}

#[test]
fn the_plan_tells_each_views_size_camera_and_passes() {
    let place = Place::new();
    place.file("three.ron", three());
    let tree = place.run(&["inspect", "three.ron", "--size", "160x90"]).exits(0).out;
    for said in ["`preview` 40×22, camera `top`", "`mirror` 100×30, default camera"] {
        assert!(tree.contains(said), "`{said}` is not in\n{tree}");
    }
    let json = place.run(&["inspect", "three.ron", "--format", "json"]).exits(0).out;
    let plan: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let notes: Vec<&str> =
        plan["notes"].as_array().expect("notes").iter().filter_map(|it| it["text"].as_str()).collect();
    assert!(notes.contains(&"is off: tone_mapping = false in view `preview`"), "{notes:?}");
}

#[test]
fn a_camera_that_the_scene_lacks_is_said_where_the_view_stands() {
    let place = Place::new();
    place.file("three.ron", three());
    let arguments = ["three.ron", "--scene", "spheres_and_cubes", "-o", "screen.png"];
    let Some(outcome) = run(&place, Vulkan::LAVAPIPE, &arguments) else { return };
    outcome
        .exits(1)
        .mentions("error: view `preview` asks for the camera `top`; the scene has none by a name\n")
        .mentions("--> three.ron:")
        .mentions("help: name a camera of the scene, or leave `camera` out: the scene's own\n");
}

#[test]
fn what_is_drawn_for_one_view_into_the_image_of_another_is_told() {
    let place = Place::new();
    let pipeline = |sky: &str| {
        format!(
            r#"Pipeline(version: 1,
    views: [(name: "main"), (name: "preview", size: Scaled(0.25))],
    images: [
        (name: "screen", format: Output, size: Output), (name: "small", view: "preview", format: Output, size: Output),
    ],
    passes: [
        (name: "sky", draw: Sky, color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))]),
        (name: "sky_of_preview", {sky}),
        (name: "shown", view: "preview", draw: FullScreen("copy"), sample: {{"source": "screen"}}, color: ["small"]),
    ],
    outputs: ["screen", "small"])"#
        )
    };
    place.file("p.ron", pipeline(r#"view: "preview", draw: Sky, color: ["screen"]"#));
    let told = place.run(&["check", "p.ron"]).exits(0).out;
    let note = "note: `sky_of_preview`: draws view `preview` into `screen`, which is for view `main` of another size";
    assert!(told.contains(note) && told.contains("(p.ron:8:70)"), "{told}");
    let small = r#"view: "preview", draw: Sky, color: [(image: "small", clear: (0.0, 0.0, 0.0, 1.0))]"#;
    for fine in [small, r#"draw: Sky, color: ["screen"]"#] {
        place.file("p.ron", pipeline(fine));
        let told = place.run(&["check", "p.ron"]).exits(0).out;
        assert!(!told.contains("another size"), "{told}");
    }
}
