//! Reports that only a picture shows: drawn on a real driver.

use framewright_passes::scene::Material;
use framewright_tests::render::{Setup, device, render};
use framewright_tests::shapes::{material, scene, square};
use glam::Mat4;
use std::error::Error;

/// The texel in the middle of the shipped forward pipeline's picture of one glowing square, and of a corner.
fn middle_and_corner(msaa: &str, see_through: bool) -> Result<Option<[[u8; 4]; 2]>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let mut glowing = vec![Material { emissive: [1.0, 0.5, 0.25], ..material([0.0, 0.0, 0.0, 1.0]) }];
    let mut objects = vec![(0, 0, Mat4::IDENTITY)];
    if see_through {
        let alpha = framewright_passes::scene::AlphaMode::Blend;
        glowing.push(Material { alpha, ..material([0.0, 0.0, 0.0, 0.0]) });
        objects.push((0, 1, Mat4::from_translation(glam::Vec3::Z)));
    }
    let scene = scene(vec![square()], glowing, objects);
    let set = [("msaa", msaa), ("tone_mapping", "false")];
    let setup = Setup { pipeline: "examples/pipelines/forward.ron", set: &set, scene: &scene, extent: [33, 33] };
    let outputs = render(device, &setup)?;
    let (texels, _) = outputs[0].bytes.as_chunks::<4>();
    Ok(Some([texels[16 * 33 + 16], texels[0]]))
}

/// The screen was black under MSAA when nothing transparent was drawn.
#[test]
fn godot_81910_the_picture_is_there_with_and_without_something_transparent() -> Result<(), Box<dyn Error>> {
    for see_through in [false, true] {
        for msaa in ["1", "4"] {
            let Some([middle, corner]) = middle_and_corner(msaa, see_through)? else { return Ok(()) };
            assert_eq!((middle[0], corner), (255, [0, 0, 0, 255]), "{msaa}×, transparent: {see_through}: {middle:?}");
            assert!(middle[1] > middle[2] && middle[2] > 100, "{middle:?}");
        }
    }
    Ok(())
}
