//! `--stereo`: pictures of both eyes beside each other, on both drivers (ST-1).

use crate::testing::{Place, Vulkan, live_profile, outcome, shipped_pipelines};
use framewright_graph::device::{Profile, SHIPPED_PROFILES};
use framewright_graph::frame::Stereo;
use framewright_tests::sweep;
use image::{DynamicImage, GenericImageView};
use std::path::Path;
use std::process::Command;

const DRIVERS: [Vulkan; 2] = [Vulkan::LAVAPIPE, Vulkan::SWIFTSHADER_CURRENT];

fn picture(path: &Path) -> DynamicImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The left and the right half.
fn halves(both: &DynamicImage) -> [DynamicImage; 2] {
    let (width, height) = both.dimensions();
    [0, width / 2].map(|left| both.crop_imm(left, 0, width / 2, height))
}

#[test]
fn both_eyes_stand_side_by_side_in_pictures_and_dumps() {
    let place = Place::new();
    for vulkan in DRIVERS {
        let Some(variables) = vulkan.variables() else { continue };
        // Odd, so that a half that began a pixel off would show.
        let scene = ["run", "forward", "--scene", "spheres_and_cubes", "--size", "161x90"];
        let run = |more: &[&str]| place.run_with(&variables, &[&scene, more].concat()).exits(0);
        run(&["-o", "one.png"]);
        let both = ["--stereo", "multi-pass", "--validate", "-o", "screen=two.png", "--dump", "color=light.exr"];
        let said = run(&both).out;
        assert!(said.contains("validation: silent; "), "{said}");
        let [one, two, light] = ["one.png", "two.png", "light.exr"].map(|file| picture(&place.path(file)));
        assert_eq!((two.dimensions(), light.dimensions()), ((322, 90), (322, 90)));
        let differ = |a: &DynamicImage, b: &DynamicImage| {
            a.pixels()
                .zip(b.pixels())
                .filter(|((.., a), (.., b))| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 8))
                .count()
        };
        let [left, right] = halves(&two);
        // Each eye sees nearly what one between them sees.
        let (from_left, from_right, apart) = (differ(&left, &one), differ(&right, &one), differ(&left, &right));
        assert!(from_left < 2000 && from_right < 2000, "{from_left} and {from_right} pixels of 14490");
        assert!(apart > from_left && apart > from_right, "{apart}, {from_left}, {from_right}");
    }
}

/// The program draws into images that an OpenXR runtime would hand out, and shows each eye its layer or half.
#[test]
fn the_example_for_openxr_shows_the_eyes_that_the_command_shows() {
    let place = Place::new();
    let tests = std::env::current_exe().expect("a path");
    let built = tests.parent().and_then(Path::parent).expect("a folder").join("examples/openxr_layers");
    assert!(built.exists(), "{} isn't built: cargo build --examples -p framewright-vulkan", built.display());
    for vulkan in [Vulkan::LAVAPIPE_CURRENT, Vulkan::SWIFTSHADER_CURRENT] {
        let Some(variables) = vulkan.variables() else { continue };
        let mut example = Command::new(&built);
        let said =
            outcome(example.arg("validate").current_dir(place.path("")).envs(variables.iter().copied())).exits(0);
        assert_eq!(said.out, "2 layers of 320×180\n1 layers of 640×180\n");
        for (shown, modes) in [("layers", "multiview,instanced"), ("halves", "double-wide")] {
            let run = ["run", "forward", "--scene", "spheres_and_cubes", "--size", "320x180", "--stereo", modes];
            let run = [&run[..], &["--validate", "-o", "both.png"]].concat();
            // The planted mistake shows that the layer is awake.
            let said = place.run_with(&variables, &run).exits(0).out;
            assert!(said.contains("validation: silent; "), "{said}");
            let [both, shown] =
                ["both.png".to_owned(), format!("out/{shown}.png")].map(|file| picture(&place.path(file)).into_rgb8());
            assert!(both == shown, "{modes}: the eyes differ");
        }
    }
}

#[test]
fn the_report_has_each_pass_with_the_eye_that_it_is_for() {
    let place = Place::new();
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let run =
        ["run", "shadows", "--scene", "courtyard", "--size", "64x36", "--stereo", "multi-pass", "--report", "r.json"];
    place.run_with(&variables, &run).exits(0);
    let report = std::fs::read_to_string(place.path("r.json")).expect("it is written");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    let passes: Vec<&str> =
        report["passes"].as_array().expect("a list").iter().filter_map(|pass| pass["name"].as_str()).collect();
    let count = |name: &str| passes.iter().filter(|pass| **pass == name).count();
    assert_eq!((count("opaque (left)"), count("opaque (right)"), count("opaque")), (1, 1, 0), "{passes:?}");
    // Cascades are drawn once.
    let casters: Vec<&&str> = passes.iter().filter(|pass| pass.starts_with("sun")).collect();
    assert!(!casters.is_empty() && casters.iter().all(|pass| !pass.contains("left")), "{passes:?}");
}

#[test]
fn a_way_to_draw_for_two_eyes_that_is_none_is_a_mistake_of_the_command_line() {
    let place = Place::new();
    for wrong in ["three", "", "multi-pass,three", "double-wide,", ",", "Multiview", "auto,off", "multi_pass", " off"] {
        let said = place.run(&["check", "forward", &format!("--stereo={wrong}")]).exits(2);
        said.mentions(
            "expected auto, or some of off, multi-pass, double-wide, instanced, multiview with commas between them",
        );
    }
    place.run(&["check", "forward", "--stereo", "multi-pass"]).exits(0);
}

const MODES: [&str; 4] = ["multi-pass", "double-wide", "instanced", "multiview"];

/// Those of the modes that a device can draw.
fn drawn_by(device: &Profile) -> impl Iterator<Item = &'static str> {
    let lacks = |mode: &str| Stereo::FASTEST_FIRST.iter().any(|it| it.name() == mode && it.lacks(device).is_some());
    MODES.into_iter().filter(move |mode| !lacks(mode))
}

#[test]
fn a_mode_that_a_device_lacks_is_refused_with_what_it_lacks_and_what_else_there_is() {
    let place = Place::new();
    let help = "help: `--stereo auto` takes the fastest way that it has; several, as `--stereo multiview,double-wide`, the first";
    let refused = |command: &str, device: &str, modes: &str| {
        place.run(&[command, "forward", "--device", device, "--stereo", modes]).exits(3).mentions(help)
    };
    for command in ["check", "inspect"] {
        refused(command, "lavapipe", "multiview").mentions(
            "`lavapipe` can't draw multiview: it says that it draws several views at once, and a test showed that it doesn't",
        );
        // A feature that a profile doesn't name is no fact.
        let unknown = "can't draw instanced: its profile doesn't say that vertex shaders can choose the layer, nor how many \
                       clip distances shaders have, and one of the two is needed";
        refused(command, "meta-quest-3", "instanced").mentions(&format!("`Meta Quest 3 (Adreno 740)` {unknown}"));
        place.run(&[command, "forward", "--device", "meta-quest-3", "--stereo", "double-wide"]).exits(0);
    }
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let run = ["run", "forward", "--scene", "spheres_and_cubes", "--size", "8x8", "--stereo", "multiview"];
    let said = place.run_with(&variables, &run);
    match Stereo::Multiview.lacks(&live_profile(&variables)) {
        None => drop(said.exits(0)),
        Some(lacks) => drop(said.exits(3).mentions(&format!("can't draw multiview: {lacks}")).mentions(help)),
    }
}

#[test]
fn of_several_modes_the_first_that_the_device_has_is_taken() {
    let place = Place::new();
    let drawn = |device: &str, modes: &str| {
        let inspect =
            ["inspect", "forward", "--size", "32x18", "--format", "json", "--device", device, "--stereo", modes];
        let plan: serde_json::Value = serde_json::from_str(&place.run(&inspect).exits(0).out).expect("JSON");
        plan["stereo"].as_str().expect("a word").to_owned()
    };
    assert_eq!(drawn("lavapipe", "auto"), "instanced");
    assert_eq!(drawn("swiftshader", "auto"), "multiview");
    assert_eq!(drawn("nvidia-rtx-2080", "auto"), "multiview");
    assert_eq!(drawn("lavapipe", "multiview,double-wide,instanced"), "double_wide");
    assert_eq!(drawn("meta-quest-3", "instanced,multi-pass,multiview"), "multi_pass");
    assert_eq!(drawn("lavapipe", "multiview,off"), "off");
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let run = ["run", "forward", "--scene", "spheres_and_cubes", "--size", "32x18"];
    let said = |more: &[&str]| place.run_with(&variables, &[&run, more].concat()).exits(0).err;
    let live = live_profile(&variables);
    for (modes, wanted) in
        [("auto", &Stereo::FASTEST_FIRST[..]), ("multiview,instanced", &[Stereo::Multiview, Stereo::Instanced])]
    {
        let (said, first) = (said(&["--stereo", modes]), Stereo::first_fit(wanted, &live).expect("one of them"));
        assert!(said.contains(&format!("note: it is drawn for two eyes by `--stereo {}`", first.name())), "{said}");
    }
    // One mode needs no word.
    assert!(!said(&["--stereo", "instanced"]).contains("drawn for two eyes"));
}

#[test]
fn every_shipped_pipeline_is_fine_in_every_mode_on_every_device_that_has_it() {
    let cases = shipped_pipelines().into_iter().flat_map(|pipeline| MODES.map(|mode| (pipeline.clone(), mode)));
    for (pipeline, mode) in sweep::of("modes of pipelines", cases.collect(), 8) {
        // Devices that lack it draw one eye after the other.
        let modes = format!("{mode},multi-pass");
        let out = Place::new().run(&["check", &pipeline, "--device", "all", "--stereo", &modes]).exits(0).out;
        let all = SHIPPED_PROFILES.len();
        assert!(out.ends_with(&format!("{pipeline}: fine on {all} of {all} devices\n")), "{mode}: {out}");
    }
}

/// Outputs, and the passes that draw them, say how they hold both eyes' parts.
#[test]
fn plans_say_how_both_eyes_are_drawn() {
    let place = Place::new();
    let inspect = |device: &str, mode: &str| {
        place.run(&["inspect", "forward", "--size", "33x18", "--device", device, "--stereo", mode]).exits(0).out
    };
    for (device, mode, scope, image) in [
        ("swiftshader", "double-wide", "each draw twice, each to the viewport of its half", "both eyes' side by side"),
        ("lavapipe", "instanced", "twice the instances, each in the layer of its eye", "a layer for each eye"),
        (
            "swiftshader",
            "instanced",
            "twice the instances, cut at the seam by a clip distance",
            "both eyes' side by side",
        ),
    ] {
        let tree = inspect(device, mode);
        assert!(tree.contains(&format!("for both eyes: {scope}")), "{tree}");
        assert!(tree.contains(&format!("`screen` R8G8B8A8_SRGB 33×18, 1 sample, {image}: external")), "{tree}");
        // Views are both eyes'; nothing else is there twice.
        assert_eq!(tree.matches("(left)`").count(), 1, "{tree}");
    }
    assert!(inspect("swiftshader", "multiview").contains("a layer for each eye"));
    assert!(inspect("swiftshader", "multi-pass").contains("`screen (left)`"));
    assert!(!inspect("swiftshader", "off").contains("eye"));
}

/// Each eye's half of `two` shows what that of `reference` shows, up to edges.
fn same_eyes(two: &DynamicImage, reference: &DynamicImage, most: usize, what: &str) {
    assert_eq!(two.dimensions(), reference.dimensions(), "{what}");
    let differ = |a: &DynamicImage, b: &DynamicImage| {
        a.pixels()
            .zip(b.pixels())
            .filter(|((.., a), (.., b))| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 1))
            .count()
    };
    let ([left, right], [their_left, their_right]) = (halves(two), halves(reference));
    let found = [differ(&left, &their_left), differ(&right, &their_right)];
    assert!(found.iter().all(|it| *it <= most), "{what}: {found:?} pixels differ");
    assert!(differ(&left, &their_right) > most && differ(&right, &their_left) > most, "{what}: eyes differ");
}

#[test]
fn pictures_and_dumps_show_the_left_eye_on_the_left_in_every_mode() {
    let place = Place::new();
    for vulkan in DRIVERS {
        let Some(variables) = vulkan.variables() else { continue };
        let device = live_profile(&variables);
        let scene = ["run", "forward", "--scene", "spheres_and_cubes", "--size", "97x54", "--validate"];
        for mode in drawn_by(&device) {
            let [screen, light] = [format!("{mode}.png"), format!("color={mode}_light.png")];
            let more = ["--stereo", mode, "-o", &screen, "--dump", &light];
            let said = place.run_with(&variables, &[&scene[..], &more].concat()).exits(0).out;
            assert!(said.contains("validation: silent; "), "{mode}: {said}");
        }
        let open = |file: String| picture(&place.path(file));
        let [screen, light] = ["multi-pass.png", "multi-pass_light.png"].map(|file| open(file.to_owned()));
        assert_eq!((screen.dimensions(), light.dimensions()), ((194, 54), (194, 54)));
        for mode in drawn_by(&device).skip(1) {
            // 1 in 100 may lie on edges.
            same_eyes(&open(format!("{mode}.png")), &screen, 52, &format!("{mode} on {}", device.name));
            same_eyes(&open(format!("{mode}_light.png")), &light, 52, &format!("{mode} on {}, light", device.name));
        }
    }
}

#[test]
fn one_eyes_image_has_a_name_where_it_is_one() {
    let place = Place::new();
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let run = |mode: &str, more: &[&str]| {
        let scene = ["run", "forward", "--scene", "spheres_and_cubes", "--size", "33x18", "--stereo", mode];
        place.run_with(&variables, &[&scene, more].concat())
    };
    run("multi-pass", &["--dump", "color=both.png"]).exits(0);
    assert_eq!(picture(&place.path("both.png")).dimensions(), (66, 18));
    run("instanced", &["--dump", "color=both.png"]).exits(0);
    assert_eq!(picture(&place.path("both.png")).dimensions(), (66, 18));
    // A name that is none is told with a word on which there are.
    run("instanced", &["--dump", "colour=x.png"]).exits(2).mentions("`color`");
}

#[test]
fn a_picture_one_texel_wide_is_two_in_every_mode() {
    let place = Place::new();
    for vulkan in DRIVERS {
        let Some(variables) = vulkan.variables() else { continue };
        let device = live_profile(&variables);
        for mode in drawn_by(&device) {
            let scene = ["run", "post", "--scene", "spheres_and_cubes", "--size", "1x3", "--validate"];
            let said =
                place.run_with(&variables, &[&scene[..], &["--stereo", mode, "-o", "two.png"]].concat()).exits(0);
            assert!(said.out.contains("validation: silent; "), "{mode}: {}", said.out);
            assert_eq!(picture(&place.path("two.png")).dimensions(), (2, 3), "{mode} on {}", device.name);
        }
    }
}

#[test]
fn every_reachable_combination_is_checked_in_a_mode() {
    let place = Place::new();
    let check = |pipeline: &str, device: &str, mode: &str| {
        let all = [
            "check",
            pipeline,
            "--all-variants",
            "--pairwise",
            "--device",
            device,
            "--stereo",
            mode,
            "--format",
            "json",
        ];
        place.run(&all)
    };
    for device in ["lavapipe", "swiftshader"] {
        let outcome = check("post", device, "instanced").exits(0);
        let answer: serde_json::Value = serde_json::from_str(&outcome.out).expect("JSON");
        assert_eq!((&answer["fine"], &answer["pairwise"]), (&true.into(), &true.into()), "{device}");
    }
    // A mode that a device can't draw is refused in every combination, with its reason.
    let said = check("post", "meta-quest-3", "instanced").exits(1);
    assert!(said.out.contains("can't draw instanced: its profile doesn't say that"), "{}", said.out);
}
