//! `--stereo`: pictures of both eyes beside each other, on both drivers (ST-1).

mod support;

use image::{DynamicImage, GenericImageView};
use std::path::Path;
use support::{Place, Vulkan};

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
        let Some(variables) = vulkan.variables() else { return };
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
    place.run(&["check", "forward", "--stereo", "three"]).exits(2).mentions("multi-pass");
    place.run(&["check", "forward", "--stereo", "multi-pass"]).exits(0);
}
