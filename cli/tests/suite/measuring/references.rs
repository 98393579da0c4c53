//! The references of `measure`: kept, shared among choices, and rounded as the output is (NU-1).

use super::{measure, number, results, row};
use crate::testing::{Place, Vulkan};
use framewright_passes::srgb;

#[test]
fn references_are_read_back_unless_they_are_damaged() {
    let place = Place::new();
    let sweep = |values: &str| measure(&place, &["--sweep", values, "-o", "swept"]).map(|out| out.exits(0));
    if sweep("msaa=1").is_none() {
        return;
    }
    let picture = row(&results(&place, "swept"), &[("msaa", "1")])["reference"].as_str().expect("a path").to_owned();
    let file = place.path("swept").join(&picture).with_extension("exr");
    let errors = || row(&results(&place, "swept"), &[("msaa", "1")])["reference_errors"].clone();
    let (drawn, own, made) = (std::fs::read(&file).expect("read"), errors(), || {
        std::fs::metadata(&file).and_then(|data| data.modified()).expect("a time")
    });
    let first = made();
    sweep("msaa=1,4");
    assert_eq!(made(), first, "it was drawn again");
    assert_eq!(row(&results(&place, "swept"), &[("msaa", "4")])["reference_errors"], own);
    let mut damaged = drawn.clone();
    *damaged.last_mut().expect("bytes") ^= 1;
    for wrong in [&damaged, &drawn[..drawn.len() / 2]] {
        std::fs::write(&file, wrong).expect("written");
        std::fs::remove_file(place.path("swept/results.json")).expect("removed");
        sweep("msaa=4");
        assert!(std::fs::read(&file).expect("read") == drawn, "it was not drawn again");
    }
}

/// A picture of 8 bits is held against its reference in 8 bits, and the reference is kept unrounded.
#[test]
fn pictures_are_held_against_references_in_the_steps_of_the_output() {
    let place = Place::new();
    let Some(out) = measure(&place, &["--sweep", "msaa=1", "--flicker", "2", "-o", "swept"]) else { return };
    out.exits(0);
    let results = results(&place, "swept");
    let row = row(&results, &[("msaa", "1")]);
    let reference = row["reference"].as_str().expect("a path");
    let picture = format!("swept/{}", row["picture"].as_str().expect("a path"));
    let errors = |reference: &str| {
        let reference = format!("swept/{reference}");
        let out = place.run(&["compare", &reference, &picture, "--format", "json"]).exits(0).out;
        serde_json::from_str::<serde_json::Value>(&out).expect("JSON")["errors"].clone()
    };
    assert_eq!(row["errors"], errors(reference));
    let unrounded = reference.replace(".png", ".exr");
    assert!((number(&errors(&unrounded)["rmse"]) / number(&row["errors"]["rmse"]) - 1.0).abs() < 0.02);
    let light = exr::prelude::read_first_rgba_layer_from_file(
        place.path("swept").join(&unrounded),
        |size, _| Vec::with_capacity(size.area()),
        |texels: &mut Vec<f32>, _, (red, _, _, _): (f32, f32, f32, f32)| texels.push(red),
    );
    let texels = light.expect("read").layer_data.channel_data.pixels;
    let between = |light: f32| {
        let steps = 255.0 * srgb::encode(light.into());
        (steps - steps.round()).abs() > 0.1
    };
    assert!(texels.iter().filter(|light| between(**light)).count() > texels.len() / 2);
    // Nothing moves: what stands still in all frames doesn't flicker.
    assert_eq!(number(&row["flicker"]["worst"]), 0.0);
}

#[test]
fn each_look_has_a_reference_of_its_own_and_choices_of_quality_share_one() {
    let place = Place::new();
    let sweep = ["--sweep", "blur=0,2", "--sweep", "msaa=1,4", "--frames", "1", "-o", "swept"];
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let arguments = ["measure", "image_quality", "--scene", "spheres_and_cubes", "--size", "32x18"];
    place.run_with(&variables, &[&arguments[..], &sweep].concat()).exits(0);
    let results = results(&place, "swept");
    let reference = |blur: &str, msaa: &str| &row(&results, &[("blur", blur), ("msaa", msaa)])["reference"];
    for blur in ["0", "2"] {
        assert!(reference(blur, "1").is_string() && reference(blur, "1") == reference(blur, "4"), "{results}");
    }
    assert_ne!(reference("0", "1"), reference("2", "1"));
}
