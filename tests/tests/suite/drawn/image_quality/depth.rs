//! The ways to see depth of several samples, and their effect on stripes: compared with pictures of 256 samples a pixel.

use crate::drawn::image_quality::{MANY, Picture, Set, picture};
use framewright_passes::scene::{Material, Scene};
use framewright_tests::shapes::{material, scene, square};
use glam::{Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [64, 48];
const STRIPES: Set<'_> = &[("tone_mapping", "clip"), ("depth_stripes", "blended")];
/// As settings name them.
const WAYS: [&str; 6] = ["DepthOnly", "SampleZero", "Min", "Max", "Average", "Samples"];

/// A floor that leads away, and panels that stand before it and before nothing; all shine alike, so only stripes tell them apart.
fn panels() -> Scene {
    let lamp = Material { emissive: [0.8; 3], ..material([0.0, 0.0, 0.0, 1.0]) };
    let floor = Mat4::from_translation(Vec3::new(0.0, -0.5, 0.0))
        * Mat4::from_rotation_x(-1.3)
        * Mat4::from_scale(Vec3::splat(5.0));
    let panel = |x: f32, z: f32, turned: f32| {
        (
            0,
            0,
            Mat4::from_translation(Vec3::new(x, 0.1, z))
                * Mat4::from_rotation_z(turned)
                * Mat4::from_scale(Vec3::splat(0.6)),
        )
    };
    scene(
        vec![square()],
        vec![lamp],
        vec![(0, 0, floor), panel(-1.2, 0.3, 0.3), panel(0.2, 1.1, -0.5), panel(1.4, -0.4, 0.9)],
    )
}

fn stripes(way: &str, msaa: &str, times: u32) -> Result<Option<Picture>, Box<dyn Error>> {
    let set = [STRIPES, &[("depth_resolve", way), ("msaa", msaa)]].concat();
    picture(&set, &panels(), EXTENT.map(|side| side * times))
}

/// IQ-14: which of them is taken is a choice between pictures, measured here, and times, which the report tells.
#[test]
fn each_way_to_see_depth_has_its_error_and_every_sample_the_least() -> Result<(), Box<dyn Error>> {
    let Some(large) = stripes("DepthOnly", "1", MANY)? else { return Ok(()) };
    let exact = large.shrunk(MANY as usize);
    let mut errors = Vec::new();
    for way in WAYS {
        let Some(found) = stripes(way, "4", 1)? else { return Ok(()) };
        errors.push(found.error_from(&exact));
    }
    let told: Vec<String> = WAYS.iter().zip(&errors).map(|(way, error)| format!("{way} {error:.4}")).collect();
    println!("stripes of 4 samples: {}", told.join(", "));
    let [depth_only, one_of_them @ .., samples] = &errors[..] else { return Err("six ways".into()) };
    assert!(*samples < 0.6 * depth_only, "{told:?}");
    assert!(one_of_them.iter().all(|error| *depth_only < 0.95 * error), "{told:?}");
    Ok(())
}
