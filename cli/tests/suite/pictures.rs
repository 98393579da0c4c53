//! `run`: pictures, reports and dumps from real drivers, under real validation layers.

use crate::testing::{Outcome, Place, Vulkan, shipped_pipelines};
use framewright_tests::sweep;
use image::{GenericImageView, Rgb, RgbImage};
use serde_json::Value;
use std::collections::HashMap;
use std::path::Path;

const SIZE: [u32; 2] = [160, 90];

/// Draws the shipped scene through a shipped pipeline; `None` where the driver or layer is missing.
fn draw(place: &Place, vulkan: Vulkan, pipeline: &str, more: &[&str]) -> Option<Outcome> {
    draw_scene(place, vulkan, pipeline, "spheres_and_cubes", more)
}

/// The same of another scene.
fn draw_scene(place: &Place, vulkan: Vulkan, pipeline: &str, scene: &str, more: &[&str]) -> Option<Outcome> {
    let variables = vulkan.variables()?;
    let mut arguments = vec!["run", pipeline, "--scene", scene, "--size", "160x90"];
    arguments.extend(more);
    Some(place.run_with(&variables, &arguments))
}

fn picture(path: &Path) -> RgbImage {
    image::open(path).expect("a picture").into_rgb8()
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("written")).expect("JSON")
}

/// Number of different colours: a picture worth the name has many.
fn colours(picture: &RgbImage) -> usize {
    picture.pixels().collect::<std::collections::HashSet<_>>().len()
}

#[test]
fn the_picture_is_the_same_bytes_run_to_run() {
    let place = Place::new();
    let Some(first) = draw(&place, Vulkan::LAVAPIPE, "forward", &["-o", "a.png"]) else { return };
    first.exits(0);
    if let Some(second) = draw(&place, Vulkan::LAVAPIPE, "forward", &["-o", "b.png", "--frames", "3"]) {
        second.exits(0);
    }
    assert_eq!(std::fs::read(place.path("a.png")).expect("a"), std::fs::read(place.path("b.png")).expect("b"));
    let picture = picture(&place.path("a.png"));
    assert_eq!(picture.dimensions(), SIZE.into());
    assert!(colours(&picture) > 500, "{} colours", colours(&picture));
    assert_eq!(place.names(), ["a.png", "b.png"]);
}

/// Whatever lies in memory, however it is shared and in whatever order passes run: what follows from the file is the picture.
#[test]
fn no_way_to_make_a_plan_changes_a_pixel() {
    let place = Place::new();
    let ways: [&[&str]; 7] = [
        &["--poison"],
        &["--no-alias"],
        &["--naive", "resolves"],
        &["--one-queue"],
        &["--order", "file"],
        &["--order", "low-memory"],
        &["--order", "random:7"],
    ];
    let mut drawn = HashMap::new();
    let pipelines = shipped_pipelines();
    let cases = ways.into_iter().flat_map(|way| pipelines.iter().map(move |pipeline| (way, pipeline)));
    for (way, pipeline) in sweep::of("ways to make Plans", cases.collect(), 6) {
        let picture_of = |way: &[&str]| {
            let outcome = draw(&place, Vulkan::LAVAPIPE, pipeline, &[&["--frames", "3", "-o", "a.png"], way].concat())?;
            outcome.exits(0);
            Some(picture(&place.path("a.png")))
        };
        let Some(other) = picture_of(way) else { return };
        let plain = drawn.entry(pipeline).or_insert_with(|| picture_of(&[]));
        assert!(plain.as_ref() == Some(&other), "{pipeline} with {way:?} is another picture");
    }
}

/// Draws shipped pipelines with two choices of settings each under a layer, which has to find nothing.
fn silent(name: &str, vulkan: Vulkan) {
    let cases = shipped_pipelines().into_iter().flat_map(|pipeline| {
        let sets = match &*pipeline {
            "deferred" | "deferred_mobile" => ["bloom=0.08", "bloom=1"],
            "temporal" => ["taa=true", "taa=false"],
            _ => ["msaa=4", "msaa=1"],
        };
        sets.map(|set| (pipeline.clone(), set))
    });
    for (pipeline, set) in sweep::of(name, cases.collect(), 4) {
        let place = Place::new();
        let more = ["--validate", "--report", "report.json", "-o", "a.png", "--frames", "3", "--set", set];
        let Some(outcome) = draw(&place, vulkan, &pipeline, &more) else { return };
        let outcome = outcome.exits(0);
        assert!(outcome.out.contains("validation: silent; "), "{}", outcome.out);
        let validation = &json(&place.path("report.json"))["validation"];
        assert_eq!(validation["findings"], 0);
        assert_eq!(validation["sees_attachments"], vulkan.layer_sees_attachments());
        assert!(validation["canary"].as_array().is_some_and(|ids| !ids.is_empty()), "{validation:#}");
    }
}

#[test]
fn shipped_pipelines_are_silent_on_lavapipe_under_the_current_layer() {
    silent("pipelines on lavapipe and the current layer", Vulkan::LAVAPIPE_CURRENT);
}

/// Some mistakes are seen only by GPU-assisted validation, which looks at what shaders wrote: counts of a dispatch beyond the limit are
/// planted, so that silence counts.
#[test]
fn pipelines_are_silent_under_gpu_assisted_validation() {
    let Some(mut variables) = Vulkan::LAVAPIPE_CURRENT.variables() else { return };
    variables.push(("VK_KHRONOS_VALIDATION_GPUAV_ENABLE", "true"));
    let run = |place: &Place, pipeline: &str| {
        let words = ["run", pipeline, "--scene", "spheres_and_cubes", "--size", "32x18", "--validate", "--frames", "2"];
        place.run_with(&variables, &[&words[..], &["-o", "o.png"]].concat())
    };
    let place = Place::new();
    let head = "#version 460\nlayout(local_size_x = 1) in;\n";
    let make = "layout(set = 0, binding = 0) buffer Counts { uint words[]; } counts;
        void main() { for (int i = 0; i < 3; ++i) counts.words[i] = i == 0 ? 70000 : 1; }";
    let none = "layout(set = 0, binding = 0) buffer Left { uint words[]; } left;
        void main() { if (gl_GlobalInvocationID.x == 0) left.words[0] = 1; }";
    place.file("make.comp", format!("{head}{make}"));
    place.file("none.comp", format!("{head}{none}"));
    place.file(
        "many.ron",
        r#"Pipeline(version: 1,
            buffers: [(name: "counts", bytes: 12), (name: "left", bytes: 16)],
            images: [(name: "o", format: R8_UNORM, size: Output)],
            passes: [
                (name: "make", dispatch: "make", groups: Count(1), storage: {"counts": (buffer: "counts", access: Write)}),
                (name: "zero", fill: (to: "left", value: 0)),
                (name: "many", dispatch: "none", groups: Indirect("counts"), storage: {"left": "left"}, side_effect: true),
                (name: "f", fill: (to: "o", value: 1.0)),
            ], outputs: ["o"])"#,
    );
    let planted = run(&place, "many.ron").exits(1).out;
    assert!(planted.contains("VUID-VkDispatchIndirectCommand-x-"), "GPU-assisted validation is off: {planted}");
    // An indirect draw whose first instance is the object's number, as GPU-driven draws have it.
    let counts = "layout(set = 0, binding = 0) buffer Counts { uint words[]; } counts;
        void main() { for (int i = 0; i < 4; ++i) counts.words[i] = uint[](3, 1, 0, 7)[i]; }";
    place.file("make.comp", format!("{head}{counts}"));
    place.file(
        "seventh.vert",
        "#version 460\nlayout(location = 0) flat out int number;
        void main() {
            number = gl_InstanceIndex;
            gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0);
        }",
    );
    place.file(
        "seventh.frag",
        "#version 460\nlayout(location = 0) flat in int number; layout(location = 0) out vec4 color;
        void main() { color = vec4(0.0, float(number) / 10.0, 0.0, 1.0); }",
    );
    place.file(
        "seventh.ron",
        r#"Pipeline(version: 1,
            buffers: [(name: "counts", bytes: 16)],
            images: [(name: "o", format: R8G8B8A8_UNORM, size: Output)],
            passes: [
                (name: "make", dispatch: "make", groups: Count(1), storage: {"counts": (buffer: "counts", access: Write)}),
                (name: "draw", draw: Indirect("counts"), shader: "seventh", color: [(image: "o", clear: (0.0, 0.0, 1.0, 1.0))]),
            ], outputs: [(image: "o", encoding: Unorm)])"#,
    );
    for pipeline in ["seventh.ron", "forward", "snow"] {
        let outcome = run(&place, pipeline).exits(0);
        assert!(outcome.out.contains("validation: silent; "), "{pipeline}: {}", outcome.out);
    }
}

#[test]
fn shipped_pipelines_are_silent_on_lavapipe_under_the_distributions_layer() {
    silent("pipelines on lavapipe and the distribution's layer", Vulkan::LAVAPIPE_OLD);
}

#[test]
fn shipped_pipelines_are_silent_on_swiftshader_under_the_current_layer() {
    silent("pipelines on SwiftShader and the current layer", Vulkan::SWIFTSHADER_CURRENT);
}

/// Scaled up, an edge is spread over pixels that look smooth: smooth are then only those that are further from it.
#[test]
fn both_drivers_draw_the_same_pictures_up_to_their_edges() {
    let place = Place::new();
    let mut cases = Vec::new();
    for pipeline in shipped_pipelines() {
        let scales: &[(&str, u32)] = match &*pipeline {
            "dynamic_resolution" => &[("render_scale=1", 1), ("render_scale=0.7", 2)],
            "deferred_mobile" => &[("scale=1", 1), ("scale=0.5", 2)],
            _ => &[("", 1)],
        };
        cases.extend(scales.iter().map(|(set, around)| (pipeline.clone(), "spheres_and_cubes", *set, *around)));
    }
    // In the other scene the sun casts shadows.
    cases.extend(["deferred", "shadows"].map(|pipeline| (pipeline.to_owned(), "courtyard", "", 1)));
    for (pipeline, scene, set, around) in sweep::of("pictures of both drivers", cases, 4) {
        let set: &[&str] = if set.is_empty() { &[] } else { &["--set", set] };
        for (vulkan, file) in [(Vulkan::LAVAPIPE, "lavapipe.png"), (Vulkan::SWIFTSHADER_CURRENT, "swiftshader.png")] {
            let more = [&["--frames", "3", "-o", file], set].concat();
            let Some(outcome) = draw_scene(&place, vulkan, &pipeline, scene, &more) else { return };
            outcome.exits(0);
        }
        let (ours, theirs) = (picture(&place.path("lavapipe.png")), picture(&place.path("swiftshader.png")));
        let differ = |a: &Rgb<u8>, b: &Rgb<u8>| (0..3).map(|i| a[i].abs_diff(b[i])).max().unwrap_or(0);
        // On edges the drivers round coverage differently: only where the picture is smooth must they agree.
        let smooth = |x: u32, y: u32| {
            let square = (y - around..=y + around).flat_map(|y| (x - around..=x + around).map(move |x| (x, y)));
            square.into_iter().all(|(i, k)| differ(ours.get_pixel(i, k), ours.get_pixel(x, y)) <= 16)
        };
        let inside = (around..SIZE[1] - around).flat_map(|y| (around..SIZE[0] - around).map(move |x| (x, y)));
        let compared: Vec<u8> = inside
            .filter(|(x, y)| smooth(*x, *y))
            .map(|(x, y)| differ(ours.get_pixel(x, y), theirs.get_pixel(x, y)))
            .collect();
        let (apart, all) = (compared.iter().filter(|difference| **difference > 2).count(), compared.len());
        assert!(all > 5000, "{pipeline} {set:?}: only {all} pixels are smooth");
        assert!(apart * 200 <= all, "{pipeline} {set:?}: {apart} of {all} smooth pixels are further apart than 2/255");
    }
}

#[test]
fn a_dump_is_a_picture_of_its_image_and_may_change_the_plan() {
    let place = Place::new();
    let more = ["-o", "a.png", "--dump", "color=color.png", "--set", "msaa=4", "--dump", "depth=depth.png"];
    let Some(outcome) = draw(&place, Vulkan::LAVAPIPE, "forward", &more) else { return };
    let outcome = outcome.exits(0).mentions("note: dumping changes the Plan: ");
    assert!(outcome.err.contains("in its picture values outside 0…1 are clamped"), "{}", outcome.err);
    assert!(outcome.err.contains("in its picture the nearest texel is white"), "{}", outcome.err);
    for file in ["color.png", "depth.png"] {
        let picture = image::open(place.path(file)).expect("a picture");
        assert_eq!(picture.dimensions(), SIZE.into());
        assert!(colours(&picture.into_rgb8()) > 50, "{file}");
    }
    assert_eq!(image::open(place.path("depth.png")).expect("a picture").color(), image::ColorType::L8);
}

#[test]
fn floating_point_images_go_to_openexr_files_and_others_are_refused_before_anything_is_drawn() {
    let place = Place::new();
    let Some(outcome) = draw(&place, Vulkan::LAVAPIPE, "forward", &["--dump", "color=color.exr"]) else { return };
    assert!(!outcome.exits(0).err.contains("in its picture"));
    let picture = image::open(place.path("color.exr")).expect("a picture");
    assert_eq!((picture.dimensions(), picture.color()), (SIZE.into(), image::ColorType::Rgba32F));
    let picture = picture.into_rgb32f();
    assert!(picture.iter().all(|light| light.is_finite()) && picture.iter().any(|light| *light > 1.0));
    if let Some(outcome) = draw(&place, Vulkan::LAVAPIPE, "forward", &["-o", "screen.exr"]) {
        let why = "`screen` is R8G8B8A8_SRGB, and OpenEXR files hold floating-point numbers and integers: write it to a \
             .png file";
        outcome.exits(1).mentions(why);
    }
    assert_eq!(place.names(), ["color.exr"]);
}

#[test]
fn the_report_holds_what_the_table_shows_and_more() {
    let place = Place::new();
    let Some(outcome) = draw(&place, Vulkan::LAVAPIPE, "forward", &["--report", "report.json"]) else { return };
    let outcome = outcome.exits(0);
    let report = json(&place.path("report.json"));
    assert_eq!(report["format_version"], 2);
    assert_eq!(report["size"], serde_json::json!(SIZE));
    assert_eq!(report["validation"], Value::Null);
    assert!(report["device"]["driver"].as_str().is_some_and(|driver| driver.contains("llvmpipe")), "{report:#}");
    let memory = |name: &str| report["memory"][name].as_u64().expect("a number");
    assert!(memory("live_peak_bytes") <= memory("placed_bytes") && memory("placed_bytes") <= memory("sum_bytes"));
    assert!(memory("live_peak_bytes") > 0);
    assert!(report["barriers"]["image"].as_u64() > Some(0));
    let passes = report["passes"].as_array().expect("a list");
    let names: Vec<&str> = passes.iter().filter_map(|pass| pass["name"].as_str()).collect();
    for name in ["opaque", "masked", "sky", "transparent", "tone_map"] {
        assert!(names.contains(&name), "{names:?}");
        assert!(outcome.out.contains(name), "{}", outcome.out);
    }
    assert_eq!(passes.iter().filter(|pass| pass["kind"] == "resolve").count(), 1);
    let opaque = &passes[0];
    assert!(opaque["draws"].as_u64() > Some(10), "{opaque:#}");
    assert_eq!(opaque["culled"], 2, "{opaque:#}");
    assert!(opaque["gpu_milliseconds"].as_f64() > Some(0.0), "{opaque:#}");
    assert!(report["gpu_milliseconds"].as_f64() > opaque["gpu_milliseconds"].as_f64());
}

#[test]
fn devices_are_listed_for_people_and_for_programs() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let people = place.run_with(&variables, &["devices"]).exits(0).out;
    assert!(people.contains("llvmpipe") && people.contains("| usable |"), "{people}");
    let programs = place.run_with(&variables, &["devices", "--format", "json"]).exits(0).out;
    let answer: Value = serde_json::from_str(&programs).expect("JSON");
    let device = &answer["devices"][0];
    assert_eq!((&device["index"], &device["kind"], &device["usable"]), (&0.into(), &"cpu".into(), &true.into()));
}

#[test]
fn an_interrupted_run_leaves_no_file() {
    let place = Place::new();
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let arguments =
        ["run", "forward", "--scene", "spheres_and_cubes", "--size", "160x90", "--frames", "1000000", "-o", "a.png"];
    let child =
        place.command(&arguments).envs(variables).stderr(std::process::Stdio::piped()).spawn().expect("it starts");
    // It watches from its beginning on; were it too early nonetheless, the end would be the system's own, without a code.
    std::thread::sleep(std::time::Duration::from_secs(3));
    let interrupt =
        std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(interrupt.success());
    let output = child.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(said.contains("of 1000000 frames: nothing was written"), "{said}");
    assert_eq!(place.names(), [""; 0]);
}

#[test]
fn the_shipped_profile_says_what_the_driver_says() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    // The driver of the process is chosen by variables: this test asks the command, whose Plans hold what it took.
    let place = Place::new();
    let arguments = ["run", "forward", "--scene", "spheres_and_cubes", "--size", "160x90", "--report", "report.json"];
    place.run_with(&variables, &arguments).exits(0);
    let inspect = ["inspect", "forward", "--scene", "spheres_and_cubes", "--size", "160x90", "--format", "json"];
    let plan: Value = serde_json::from_str(&place.run(&inspect).exits(0).out).expect("JSON");
    let report = json(&place.path("report.json"));
    assert_eq!(report["memory"]["placed_bytes"], plan["totals"]["placed_bytes"]);
    assert_eq!(report["barriers"]["image"], plan["totals"]["image_barriers"]);
    assert_eq!(report["notes"], plan["notes"]);
}
