//! No file that a command read is written by it, whatever kind of file it is and by whatever name it is meant.
#![cfg(unix)]

use crate::testing::{self, Outcome, Place, Vulkan};
use std::os::unix::fs::symlink;

/// It includes a fragment, reads a texture and draws with a shader that includes another file.
const PIPELINE: &str = r#"Pipeline(
    version: 1,
    include: ["parts/fill.ron"],
    settings: [(name: "bright", value: Bool(default: true))],
    textures: [(name: "tile", file: "tile.png", color_space: Linear)],
    images: [(name: "sky", format: Output, size: Output), (name: "screen", format: Output, size: Output)],
    passes: [
        (use: "fill", name: "all", with: {"target": "sky"}),
        (name: "show", draw: FullScreen("show"), sample: {"source": "tile"}, color: ["screen"]),
    ],
    outputs: ["screen", "sky"],
)"#;

const FILL: &str = r#"Fragments(version: 1, fragments: [
    (name: "fill", parameters: [(name: "target", value: Image)],
        passes: [(name: "sky", draw: Sky, color: [(image: "target", clear: (0.0, 0.0, 0.0, 1.0))])]),
])"#;

const EXTENSION: &str = r#"Extension(version: 1, changes: [Set(setting: "bright", to: (default: false))])"#;

const SETTINGS: &str = r#"Settings(version: 1, set: {"bright": true})"#;

const SHADER: &str = "#version 460
#include \"parts/half.glsl\"
layout(set = 0, binding = 0) uniform sampler2D source;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = halved(texture(source, uv)); }";

const INCLUDED: &str = "vec4 halved(vec4 color) { return color * 0.5; }";

/// A triangle with a buffer and a picture in files of their own.
const SCENE: &str = r#"{"asset": {"version": "2.0"},
    "buffers": [{"uri": "scene/triangle.bin", "byteLength": 36}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "images": [{"uri": "scene/paint.png"}], "textures": [{"source": 0}],
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0}"#;

/// Each file that is read, and what it is called.
const READ: [(&str, &str); 10] = [
    ("p.ron", "the pipeline itself"),
    ("parts/fill.ron", "a fragment of the pipeline"),
    ("more.ron", "an extension of the pipeline"),
    ("settings.ron", "the settings file itself"),
    ("tile.png", "the texture itself"),
    ("show.frag", "the shader itself"),
    ("parts/half.glsl", "the shader itself"),
    ("scene.gltf", "the scene itself"),
    ("scene/triangle.bin", "a file of the scene"),
    ("scene/paint.png", "a file of the scene"),
];

fn place() -> Place {
    let place = Place::new();
    for folder in ["parts", "scene"] {
        std::fs::create_dir(place.path(folder)).expect("a folder");
    }
    for (name, text) in [
        ("p.ron", PIPELINE),
        ("parts/fill.ron", FILL),
        ("more.ron", EXTENSION),
        ("settings.ron", SETTINGS),
        ("show.frag", SHADER),
        ("parts/half.glsl", INCLUDED),
        ("scene.gltf", SCENE),
    ] {
        place.file(name, text);
    }
    for name in ["tile.png", "scene/paint.png"] {
        image::RgbaImage::new(2, 2).save(place.path(name)).expect("written");
    }
    let corners = [[0.0_f32, 0.0, -2.0], [1.0, 0.0, -2.0], [0.0, 1.0, -2.0]];
    place
        .file("scene/triangle.bin", corners.as_flattened().iter().flat_map(|it| it.to_le_bytes()).collect::<Vec<u8>>());
    place
}

/// A command over all of these files, which writes `out`.
fn command(place: &Place, variables: &[(&str, &str)], words: &[&str]) -> Outcome {
    let [first, others @ ..] = words else { panic!("a command") };
    let all = [first, "p.ron", "--settings", "settings.ron", "--extend", "more.ron", "--scene", "scene.gltf"];
    place.run_with(variables, &[&all[..], &["--size", "16x9"], others].concat())
}

/// Asserts that no file has changed and none was added.
#[track_caller]
fn all_is_as_it_was(place: &Place) {
    let new = self::place();
    for (file, _) in READ {
        let [now, before] = [place, &new].map(|place| std::fs::read(place.path(file)).expect("read"));
        assert!(now == before, "{file} was written over");
    }
}

/// The name that messages give a file, which is read as `what`, where `name` is to be written. By its ending a shader is known before
/// it is read; a hard link has an ending of its own.
fn said(what: &'static str, name: &str) -> &'static str {
    if what == "the shader itself" && !name.starts_with("hard") { "a shader by its name" } else { what }
}

#[test]
fn inspect_writes_over_no_file_that_it_read_by_whatever_name() {
    let place = place();
    for (file, what) in READ {
        symlink(place.path(file), place.path("link")).expect("a link");
        std::fs::hard_link(place.path(file), place.path("hard")).expect("a link");
        for name in [file, &format!("parts/../{file}"), "link", "hard"] {
            command(&place, &[], &["inspect", "-o", name]).exits(2).mentions(&format!(
                "error: `{name}` is {}, which would be lost: name another file to write",
                said(what, name)
            ));
        }
        all_is_as_it_was(&place);
        for link in ["link", "hard"] {
            std::fs::remove_file(place.path(link)).expect("removed");
        }
    }
    let profile = std::fs::read_to_string(testing::repository("graph/src/device/profiles/lavapipe.ron")).expect("read");
    place.file("device.ron", &profile);
    command(&place, &[], &["inspect", "--device", "device.ron", "-o", "./device.ron"])
        .exits(2)
        .mentions("`./device.ron` is the device profile itself, which would be lost");
    assert_eq!(std::fs::read_to_string(place.path("device.ron")).expect("read"), profile);
}

#[test]
fn run_writes_over_no_file_that_it_read_by_whatever_name() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = place();
    for (file, what) in READ {
        symlink(place.path(file), place.path("link.png")).expect("a link");
        std::fs::hard_link(place.path(file), place.path("hard.png")).expect("a link");
        for (words, name) in [
            (["run", "--report", file], file),
            (["run", "-o", "link.png"], "link.png"),
            (["run", "--dump", "sky=hard.png"], "hard.png"),
        ] {
            // Another file, which comes first, isn't written either.
            command(&place, &variables, &[&words[..], &["-o", "sky=first.png"]].concat()).exits(2).mentions(&format!(
                "error: `{name}` is {}, which would be lost: name another file to write",
                said(what, name)
            ));
        }
        all_is_as_it_was(&place);
        assert!(!place.path("first.png").exists());
        for link in ["link.png", "hard.png"] {
            std::fs::remove_file(place.path(link)).expect("removed");
        }
    }
    command(&place, &variables, &["run", "-o", "picture.png", "--report", "report.json"]).exits(0);
}

#[test]
fn new_and_devices_write_over_no_file() {
    let place = place();
    place.run(&["new", "p"]).exits(1).mentions("there is a file `p.ron` already");
    place.run(&["new", "parts/fill"]).exits(1).mentions("there is a file `parts/fill.ron` already");
    all_is_as_it_was(&place);
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    place.run_with(&variables, &["devices", "--save", "show.frag"]).exits(2).mentions("is a shader by its name");
    all_is_as_it_was(&place);
}
