//! `image_quality` on the command line: what its frames list, and choices that make no picture.

use crate::testing::{Place, Vulkan};
use serde_json::Value;

/// The work of a frame, in its order: passes with their draws, resolves in between.
fn listing(vulkan: Vulkan, more: &[&str]) -> Option<Vec<String>> {
    let variables = vulkan.variables()?;
    let place = Place::new();
    let how = ["run", "image_quality", "--scene", "spheres_and_cubes", "--size", "160x90", "--report", "report.json"];
    place.run_with(&variables, &[&how[..], more].concat()).exits(0);
    let report = std::fs::read_to_string(place.path("report.json")).expect("written");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    let passes = report["passes"].as_array().expect("a list").iter();
    let told = passes.map(|pass| match pass["kind"].as_str() {
        Some("resolve") => "resolve".to_owned(),
        _ => format!("{} {}", pass["name"].as_str().expect("a name"), pass["draws"]),
    });
    Some(told.collect())
}

const SCENE: [&str; 4] = ["opaque 58", "masked 3", "sky 1", "transparent 4"];

/// IQ-9, IQ-24: as a frame debugger shows it, with 3 resolves as it is written and 1 as it is compiled.
#[test]
fn the_listing_of_a_blur_shows_resolves_in_their_place_and_draws_counted() {
    let blur = ["--set", "hdr=false", "--set", "tone_mapping=clip", "--set", "blur=5"];
    let draws: Vec<String> = (0..5).map(|draw| format!("soften.blur[{draw}] 1")).collect();
    let resolve = ["resolve".to_owned()];
    let scene = SCENE.map(str::to_owned);
    for vulkan in [Vulkan::LAVAPIPE, Vulkan::SWIFTSHADER] {
        let Some(compiled) = listing(vulkan, &blur) else { return };
        assert_eq!(compiled, [&scene[..], &resolve, &draws].concat());
        let Some(written) = listing(vulkan, &[&blur[..], &["--naive", "resolves"]].concat()) else { return };
        let three = [&scene[..], &resolve, &draws[..2], &resolve, &draws[2..4], &resolve, &draws[4..]];
        assert_eq!(written, three.concat());
    }
}

/// IQ-12, IQ-16, IQ-24: a depth-only pass stands before the stripes. As a copy they are two draws between two resolves, as a
/// blend one draw and a resolve in the end, where the depth-only pass comes first of all, so that the rest is one scope; what is
/// transparent comes after them, with samples.
#[test]
fn the_listing_of_depth_stripes_shows_a_depth_only_pass_before_them_and_transparent_objects_after_them() {
    for vulkan in [Vulkan::LAVAPIPE, Vulkan::SWIFTSHADER] {
        let Some(copied) = listing(vulkan, &["--set", "mapped=pixels", "--set", "depth_stripes=copied"]) else {
            return;
        };
        let again = ["opaque (depth only) 58", "masked (depth only) 3"];
        let expected = [
            &SCENE[..3],
            &["resolve"],
            &again,
            &["copied_stripes.stripes 1", "stripes_back 1", "transparent 4", "resolve", "map.curve.tone_map 1"],
        ];
        assert_eq!(copied, expected.concat());
        let Some(blended) = listing(vulkan, &["--set", "mapped=pixels", "--set", "depth_stripes=blended"]) else {
            return;
        };
        let expected =
            [&again, &SCENE[..3], &["stripes.stripes 1", "transparent 4", "resolve", "map.curve.tone_map 1"]];
        assert_eq!(blended, expected.concat());
        let Some(one) = listing(vulkan, &["--set", "depth_stripes=blended", "--set", "msaa=1"]) else { return };
        assert_eq!(one, [&SCENE[..3], &["stripes.stripes 1", "transparent 4", "map_samples.tone_map 1"]].concat());
    }
}

/// Formats, resolves and coverage that are chosen: drawn under the current validation layer, which finds nothing.
#[test]
fn every_precision_resolve_and_coverage_is_drawn_silently_on_both_drivers() {
    let choices = [
        ["color_precision=Smallest", "depth_precision=Smallest", "light_resolve=Weighted"],
        ["color_precision=Exact", "depth_precision=Balanced", "alpha_to_coverage=true"],
        ["hdr=false", "color_precision=Exact", "depth_stripes=blended"],
    ];
    for vulkan in [Vulkan::LAVAPIPE_CURRENT, Vulkan::SWIFTSHADER_CURRENT] {
        let Some(variables) = vulkan.variables() else { return };
        for choice in choices {
            let set = choice.iter().flat_map(|choice| ["--set", choice]);
            let how = ["run", "image_quality", "--scene", "spheres_and_cubes", "--size", "96x54", "--validate"];
            let arguments: Vec<&str> = how.into_iter().chain(set).collect();
            let said = Place::new().run_with(&variables, &arguments).exits(0).out;
            assert!(said.contains("validation: silent; "), "{choice:?}: {said}");
        }
    }
}

#[test]
fn a_choice_that_makes_no_picture_is_refused_with_what_is_allowed() {
    let cases = [
        ("render_scale=0", "it is a number from 0.25 to 4"),
        ("render_scale=-1", "it is a number from 0.25 to 4"),
        ("render_scale=NaN", "it is a number from 0.25 to 4"),
        ("render_scale=1e9", "it is a number from 0.25 to 4"),
        ("render_scale=inf", "it is a number from 0.25 to 4"),
        ("render_scale=-inf", "it is a number from 0.25 to 4"),
        ("white_point=0.5", "it is a number from 1 to 100"),
        ("white_point=NaN", "it is a number from 1 to 100"),
        ("blur=-1", "it is a whole number from 0 to 5"),
        ("blur=10000", "it is a whole number from 0 to 5"),
        ("msaa=3", "it is one of 1, 2, 4, 8"),
        (
            "tone_mapping=sepia",
            "it is one of `clip`, `reinhard`, `reinhard_luminance`, `white_point`, `filmic`, `neutral`, `over_bright`",
        ),
    ];
    for (set, help) in cases {
        Place::new().run(&["check", "image_quality", "--set", set]).exits(2).mentions("doesn't allow").mentions(help);
    }
}

/// The parameters that a file gives to the library's tone mapping.
#[test]
fn a_tone_mapping_that_is_not_there_is_refused_with_those_that_are() {
    let cases = [
        (
            "\"operator\": \"'sepia'\"",
            "error: parameter `operator` doesn't allow `'sepia'`",
            "it is one of `clip`, `reinhard`, `reinhard_luminance`, `white_point`, `filmic`, `neutral`",
        ),
        (
            "\"white_point\": 0.5",
            "error: parameter `white_point` doesn't allow `0.5`",
            "it is a number of at least 1\n",
        ),
        ("\"white_point\": NaN", "error: parameter `white_point` is a finite number, found `NaN`", ""),
    ];
    for (with, message, help) in cases {
        let place = Place::new();
        let text = format!(
            r#"Pipeline(
                version: 1,
                include: ["library/tone_mapping.ron"],
                images: [
                    (name: "color", format: Color(hdr: true), size: Output),
                    (name: "screen", format: Output, size: Output),
                ],
                passes: [
                    (name: "sky", draw: Sky, color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
                    (use: "tone_mapping", name: "map", with: {{"source": "color", "target": "screen", {with}}}),
                ],
                outputs: ["screen"],
            )"#
        );
        place.file("p.ron", text);
        place.run(&["check", "p.ron"]).exits(1).mentions(message).mentions(help).mentions(" p.ron:10:");
    }
}
