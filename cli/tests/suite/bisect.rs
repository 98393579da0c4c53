//! `run --bisect`: two modes that must draw the same, and the pass where they part.

use crate::testing::{Place, Vulkan};

/// A compute pass writes one texel of an image of which a draw shows all.
const HALF_WRITTEN: &str = r#"Pipeline(
    version: 1,
    images: [
        (name: "spots", format: R8G8B8A8_UNORM, size: Output),
        (name: "screen", format: Output, size: Output),
    ],
    passes: [
        (name: "first", draw: FullScreen("plain"), color: ["screen"]),
        (name: "spot", dispatch: "spot", groups: Count(1, 1, 1), storage: {"spots": "spots"}),
        (name: "show", draw: FullScreen("spots"), sample: {"spots": "spots"}, color: ["screen"]),
    ],
    outputs: ["screen"],
)"#;

const PLAIN: &str = "#version 460
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(uv, 0.0, 1.0); }";

const SPOT: &str = "#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, rgba8) uniform writeonly image2D spots;
void main() { imageStore(spots, ivec2(0), vec4(1.0)); }";

const SPOTS: &str = "#version 460
layout(location = 0) in vec2 uv;
layout(set = 0, binding = 0) uniform sampler2D spots;
layout(location = 0) out vec4 color;
void main() { color = texture(spots, uv); }";

const SCENE: [&str; 4] = ["--scene", "spheres_and_cubes", "--size", "64x36"];

#[test]
fn every_mode_draws_the_same_after_every_pass() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    for mode in ["full-barriers", "step-by-step", "poison", "no-alias", "file-order", "one-queue"] {
        let words = [&["run", "deferred", "--bisect", mode, "--report", "report.json"][..], &SCENE].concat();
        let said = place.run_with(&variables, &words).exits(0).out;
        let expected = format!("images after their passes are the same with and without `{mode}`");
        assert!(said.starts_with("all ") && said.contains(&expected), "{said}");
        let report = std::fs::read_to_string(place.path("report.json")).expect("written");
        let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
        assert!(report["compared"].as_u64() > Some(4) && report["first_difference"].is_null(), "{report}");
    }
}

#[test]
fn the_first_pass_that_differs_is_named_with_its_texels() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    place.file("half.ron", HALF_WRITTEN);
    for (file, text) in [("plain.frag", PLAIN), ("spot.comp", SPOT), ("spots.frag", SPOTS)] {
        place.file(file, text);
    }
    let words = [&["run", "half.ron", "--bisect", "poison", "--report", "report.json"][..], &SCENE].concat();
    let said = place.run_with(&variables, &words).exits(1).out;
    assert!(said.contains("part at pass `spot`: 2303 of 2304 texels of `spots` differ, the first at 1, 0"), "{said}");
    let report = std::fs::read_to_string(place.path("report.json")).expect("written");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    assert_eq!(report["first_difference"]["pass"], "spot");
    assert_eq!(report["mode"], "poison");
}

/// A triangle that fills less than the screen, a dispatch that stores one texel, and what each of them promises.
const PROMISED: &str = r#"Pipeline(
    version: 1,
    images: [
        (name: "spots", format: R8G8B8A8_UNORM, size: Output, lifetime: Persistent),
        (name: "screen", format: Output, size: Output),
    ],
    passes: [
        (name: "first", draw: FullScreen("plain"), color: ["screen"]),
        (name: "spot", dispatch: "spot", groups: Count(1, 1, 1), storage: {"spots": STORAGE}),
        (name: "show", draw: FullScreen("part"), sample: {"spots": "spots"}, color: ["screen"]COVERS),
    ],
    outputs: ["screen"],
)"#;

const PART: &str = "#version 460
layout(location = 0) out vec2 uv;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(uv - 1.0, 0.0, 1.0);
}";

#[test]
fn a_promise_that_a_pass_sets_every_texel_is_refuted_where_poison_stays() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    for (file, text) in [("plain.frag", PLAIN), ("spot.comp", SPOT), ("part.frag", SPOTS), ("part.vert", PART)] {
        place.file(file, text);
    }
    let bisected = |storage: &str, covers: &str, code: i32| {
        place.file("promised.ron", PROMISED.replace("STORAGE", storage).replace("COVERS", covers));
        let words = [&["run", "promised.ron", "--bisect", "poison"][..], &SCENE].concat();
        place.run_with(&variables, &words).exits(code).out
    };
    let kept = bisected("\"spots\"", "", 0);
    assert!(kept.contains("are the same"), "{kept}");
    let whole = "(image: \"spots\", access: Write)";
    let said = bisected(whole, "", 1);
    assert!(said.contains("at pass `spot`: 2303 of 2304 texels of `spots` differ"), "{said}");
    assert!(said.contains("`access: Write` promises that the pass sets them all, which is false"), "{said}");
    let said = bisected("\"spots\"", ", covers: true", 1);
    assert!(said.contains("at pass `show`:") && said.contains("texels of `screen` differ"), "{said}");
    assert!(said.contains("`covers: true` promises that the pass sets them all, which is false"), "{said}");
}

#[test]
fn a_picture_is_the_same_with_full_barriers_step_by_step_and_breadcrumbs() {
    let Some(variables) = Vulkan::LAVAPIPE_CURRENT.variables() else { return };
    let place = Place::new();
    let modes = [
        ("a.png", &[][..]),
        ("b.png", &["--full-barriers"]),
        ("c.png", &["--step-by-step", "--full-barriers"]),
        ("d.png", &["--breadcrumbs"]),
    ];
    for (file, more) in modes {
        let words = [&["run", "image_quality", "--validate", "-o", file][..], &SCENE, more].concat();
        place.run_with(&variables, &words).exits(0);
    }
    let read = |file: &str| std::fs::read(place.path(file)).expect("written");
    assert!(["b.png", "c.png", "d.png"].iter().all(|file| read(file) == read("a.png")));
}

#[test]
fn a_bisection_writes_no_pictures_and_takes_no_plan() {
    let place = Place::new();
    for words in [&["-o", "a.png"][..], &["--plan"], &["--validate"], &["--dump-all", "all"]] {
        let words = [&["run", "forward", "--bisect", "poison"][..], &SCENE, words].concat();
        place.run(&words).exits(2).mentions("cannot be used with");
    }
}
