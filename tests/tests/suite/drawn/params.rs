//! Shaders read what a pipeline file gives as parameters, of every type (EM-5).

use framewright_graph::compile::Options;
use framewright_tests::render::{Setup, device, draw, silent};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

fn told(set: &[(&str, &str)]) -> Result<Option<Vec<f32>>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/params_of_every_type.ron", set, scene: &scene, extent: [8, 8] };
    let (_, mut executor) = draw(device, &setup, &Options::default(), 1)?;
    let bytes = executor.read_buffer("values")?;
    silent(device)?;
    Ok(Some(bytes.as_chunks().0.iter().map(|word| f32::from_ne_bytes(*word)).collect()))
}

#[test]
fn scalars_vectors_and_matrices_arrive_as_the_file_gives_them() -> Result<(), Box<dyn Error>> {
    let Some(values) = told(&[])? else { return Ok(()) };
    let mut expected: Vec<f32> = (1_u8..=51).map(f32::from).collect();
    // `on`, `cell`, `sides` and `last`.
    expected[4] = 1.0;
    expected[5] = -6.0;
    (expected[10], expected[11]) = (1.0, 0.0);
    expected.splice(12..50, (13_u8..=50).map(f32::from));
    expected[50] = -51.0;
    assert_eq!(values, expected);
    Ok(())
}

#[test]
fn settings_change_components() -> Result<(), Box<dyn Error>> {
    let Some(values) = told(&[("red", "0.5"), ("count", "100"), ("left", "false")])? else { return Ok(()) };
    assert_eq!(values[..3], [0.5, 2.0, 2.5]);
    assert_eq!(values[7..10], [100.0, 9.0, 102.0]);
    assert_eq!(values[10], 0.0);
    Ok(())
}

/// The picture of `kernel.ron` as GLSL, HLSL and SPIR-V draw it.
fn kernel(set: &[(&str, &str)]) -> Result<Option<[Vec<f32>; 3]>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/kernel.ron", set, scene: &scene, extent: [8, 8] };
    let (_, mut executor) = draw(device, &setup, &Options::default(), 1)?;
    let mut numbers = |output| -> Result<Vec<f32>, Box<dyn Error>> {
        let bytes = executor.read(output)?.bytes;
        Ok(bytes.as_chunks().0.iter().map(|word| f32::from_ne_bytes(*word)).collect())
    };
    let pictures = [numbers(0)?, numbers(1)?, numbers(2)?];
    silent(device)?;
    Ok(Some(pictures))
}

/// What the kernel of this middle weight makes of the places of 8 × 8 texels.
fn by_hand(middle: f32) -> Vec<f32> {
    // Odd taps are turned by a quarter, to the left of where they point.
    let taps = [(middle, 0, 0), (0.25, 0, 2), (0.5, 0, 1), (middle / 4.0, 3, 0), (2.0, -1, -1)];
    let at = |x: i8, y: i8| [f32::from(x), f32::from(y), f32::from(x) * f32::from(y)];
    let texel = |x: i8, y: i8| {
        let mut sum = [0.0; 3];
        for (weight, right, down) in taps {
            let found = at((x + right).clamp(0, 7), (y + down).clamp(0, 7));
            sum = [0, 1, 2].map(|channel| sum[channel] + weight * found[channel]);
        }
        [sum[0], 2.0 * sum[1], 0.5 * sum[2], 3.0 + 16.0 * 5.0]
    };
    (0..8).flat_map(|y| (0..8).flat_map(move |x| texel(x, y))).collect()
}

#[test]
fn arrays_and_structures_arrive_element_by_element_in_each_language() -> Result<(), Box<dyn Error>> {
    for (set, middle) in [(&[][..], 1.0), (&[("middle", "8")][..], 8.0)] {
        let Some(pictures) = kernel(set)? else { return Ok(()) };
        for (picture, language) in pictures.iter().zip(["GLSL", "HLSL", "SPIR-V"]) {
            assert_eq!(*picture, by_hand(middle), "{language}, {middle}");
        }
    }
    Ok(())
}
