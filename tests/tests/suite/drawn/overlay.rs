//! The debug overlay: what stands in its rectangle, and that nothing changes around it.

use framewright_passes::twin::overlay::{shade_of_distance, shade_of_signed};
use framewright_tests::render::{Setup, device, render, rgba};
use framewright_tests::shapes::{empty_scene, material, scene, square};
use glam::{Mat4, Vec3};
use std::error::Error;

const EXTENT: [usize; 2] = [64, 48];

#[test]
fn depth_is_shown_as_distance_and_colour_as_it_is_and_the_rest_is_untouched() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut glow = material([0.0, 0.0, 0.0, 1.0]);
    glow.emissive = [0.5, 3.0, 0.25];
    // It lies askew: distances vary. Above and below it is nothing.
    let place = Mat4::from_rotation_y(0.9) * Mat4::from_scale(Vec3::new(4.0, 1.0, 1.0));
    let scene = scene(vec![square()], vec![glow], vec![(0, 0, place)]);
    let extent = EXTENT.map(|side| side as u32);
    let setup = Setup { pipeline: "tests/pipelines/overlay.ron", set: &[], scene: &scene, extent };
    let outputs = render(device, &setup)?;
    let floats = |output: usize| -> Vec<f32> {
        let (words, _) = outputs[output].bytes.as_chunks::<4>();
        words.iter().map(|word| f32::from_ne_bytes(*word)).collect()
    };
    let [lit, depth, screen] = [0, 1, 2].map(floats);
    let texel = |image: &[f32], x: usize, y: usize| -> [f32; 3] {
        std::array::from_fn(|channel| image[4 * (y * EXTENT[0] + x) + channel])
    };
    let near = f64::from(scene.camera.near);
    let mut distances = Vec::new();
    for y in 0..EXTENT[1] {
        for x in 0..EXTENT[0] {
            let found = texel(&screen, x, y);
            if (32..48).contains(&x) && y < 12 {
                // Every fourth texel from the third on: the middle of the small pixel lies at its upper left corner.
                let around = [(1, 1), (2, 1), (1, 2), (2, 2)];
                let shades = around.map(|(dx, dy)| {
                    let depth = depth[(4 * y + dy) * EXTENT[0] + 4 * (x - 32) + dx];
                    shade_of_distance(f64::from(depth), near, 20.0)
                });
                let close = |shade: &f64| (f64::from(found[0]) - shade).abs() <= 1e-6;
                assert!(shades.iter().any(close) && found[0] == found[1], "({x}, {y}): {found:?}, not {shades:?}");
                distances.push(found[0]);
            } else if x < 32 && y >= 24 {
                let around = [(0, 0), (1, 0), (0, 1), (1, 1)];
                let colors = around.map(|(dx, dy)| texel(&lit, 2 * x + dx, 2 * (y - 24) + dy).map(|value| 0.5 * value));
                assert!(colors.contains(&found), "({x}, {y}): {found:?}, not {colors:?}");
            } else {
                assert_eq!(found, texel(&lit, x, y), "({x}, {y})");
            }
        }
    }
    // The square's nearest and farthest edges are 5 ∓ 4 sin 0.9 m away.
    assert!(distances.contains(&1.0) && distances.iter().any(|shade| (0.1..0.2).contains(shade)));
    Ok(())
}

#[test]
fn distance_is_what_the_projection_made_depth_of() {
    for (distance, expected) in [(0.1, 0.005), (5.0, 0.25), (20.0, 1.0), (1e6, 1.0)] {
        assert!((shade_of_distance(0.1 / distance, 0.1, 20.0) - expected).abs() < 1e-12, "{distance}");
    }
    assert_eq!(shade_of_distance(0.0, 0.1, 20.0), 1.0);
}

#[test]
fn one_component_is_shown_as_grey_and_values_of_either_sign_around_grey() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/overlay_channels.ron", set: &[], scene: &scene, extent: [8, 4] };
    let output = render(device, &setup)?.swap_remove(0);
    let texels = rgba(&output);
    let signed = [-0.5, 0.5, -3.0].map(|value| shade_of_signed(value, 1.0));
    for (at, texel) in texels.iter().enumerate() {
        let expected = match (at % 8, at / 8) {
            (_, 2..) => [0.0; 3],
            // 0.2 of 255 steps is a whole number of them.
            (..4, _) => [0.2; 3],
            (_, _) => signed,
        };
        let close = texel.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-6);
        assert!(close, "texel {at}: {texel:?}, not {expected:?}");
    }
    Ok(())
}

#[test]
fn values_of_either_sign_are_shown_from_black_to_white() {
    let shades = [-2.0, -1.0, 0.0, 0.5, 1.0, f64::INFINITY, f64::NAN].map(|value| shade_of_signed(value, 1.0));
    assert_eq!(shades, [0.0, 0.0, 0.5, 0.75, 1.0, 1.0, 0.5]);
}
