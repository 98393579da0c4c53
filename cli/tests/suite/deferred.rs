//! The shipped pipeline `deferred`: what its frame is made of, and what each part of it does to the picture.

use crate::testing::{Place, Vulkan};
use image::RgbImage;
use serde_json::Value;

/// Names of the passes of a frame of the courtyard, and the picture; silent under the validation layer.
fn drawn(vulkan: Vulkan, set: &[&str]) -> Option<(Vec<String>, RgbImage)> {
    let variables = vulkan.variables()?;
    let place = Place::new();
    let mut arguments = vec!["run", "deferred", "--scene", "courtyard", "--size", "240x136", "-o", "a.png"];
    arguments.extend(["--validate", "--report", "report.json", "--set", "shadow_size=1024"]);
    arguments.extend(set.iter().flat_map(|set| ["--set", *set]));
    place.run_with(&variables, &arguments).exits(0);
    let report = std::fs::read_to_string(place.path("report.json")).expect("written");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    let passes = report["passes"].as_array().expect("a list").iter();
    let names = passes.map(|pass| pass["name"].as_str().expect("a name").to_owned()).collect();
    Some((names, image::open(place.path("a.png")).expect("a picture").into_rgb8()))
}

/// How many pixels became clearly brighter and clearly darker.
fn changed(before: &RgbImage, after: &RgbImage) -> [usize; 2] {
    let sum = |pixel: &image::Rgb<u8>| pixel.0.map(i32::from).iter().sum::<i32>();
    let by: Vec<i32> = before.pixels().zip(after.pixels()).map(|(before, after)| sum(after) - sum(before)).collect();
    [by.iter().filter(|by| **by > 12).count(), by.iter().filter(|by| **by < -12).count()]
}

/// IQ-25, and the frame of 25 passes by which render graphs are compared; here are masked and transparent objects too.
#[test]
fn the_frame_has_cascades_depth_surfaces_occlusion_light_bloom_and_smoothed_edges() {
    let Some((mut names, _)) = drawn(Vulkan::LAVAPIPE_CURRENT, &["overlay=true"]) else { return };
    let mut expected: Vec<String> = ["opaque", "masked"]
        .iter()
        .flat_map(|list| (0..4).map(move |cascade| format!("sun.{list}[{cascade}]")))
        .chain((0..6).map(|level| format!("glow.bloom.shrink[{level}]")))
        .chain((0..5).map(|level| format!("glow.bloom.grow[{level}]")))
        .collect();
    let others =
        ["depth_prepass", "opaque", "masked", "occlude.gather", "occlude.blur", "lighting", "sky", "transparent"];
    let last = ["glow.bloom.mix", "show.curve.tone_map", "smooth.fxaa", "show_open.overlay"];
    expected.extend(others.iter().chain(&last).map(|name| (*name).to_owned()));
    names.sort();
    expected.sort();
    assert_eq!(names, expected);
}

/// NU-6: what is off is not there.
#[test]
fn each_part_does_its_own_to_the_picture_on_both_drivers_and_is_gone_when_it_is_off() {
    for vulkan in [Vulkan::LAVAPIPE_CURRENT, Vulkan::SWIFTSHADER_CURRENT] {
        let Some((names, with)) = drawn(vulkan, &[]) else { return };
        let without = |set: &str, part: &str| {
            let (left, picture) = drawn(vulkan, &[set]).expect("the driver is there");
            assert!(names.iter().any(|name| name.starts_with(part)), "{part} is missing: {names:?}");
            assert!(left.iter().all(|name| !name.starts_with(part)), "{part} is there with {set}: {left:?}");
            changed(&with, &picture)
        };
        let [brighter, darker] = without("shadows=false", "sun.");
        assert!(
            brighter > 800 && darker * 10 < brighter,
            "without shadows {brighter} pixels are brighter, {darker} darker"
        );
        let [brighter, darker] = without("ambient_occlusion=0", "occlude");
        assert!(
            brighter > 80 && darker * 10 < brighter,
            "without occlusion {brighter} pixels are brighter, {darker} darker"
        );
        let [brighter, darker] = without("anti_aliasing=false", "smooth");
        assert!(brighter > 100 && darker > 100, "with rough edges {brighter} pixels are brighter, {darker} darker");
    }
}
