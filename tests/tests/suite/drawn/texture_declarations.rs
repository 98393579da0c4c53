//! One shader serves flat images, layers and samples: its declaration is left to the pass. Every texel is held against the sum
//! of what was drawn.

use framewright_tests::render::{Setup, device, render};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const EXTENT: [u32; 2] = [32, 24];

/// The colour that `sample_values.frag` draws.
fn drawn(x: u32, y: u32, layer: u32, number: u32) -> [f64; 3] {
    let number = ((layer * 8 + number) * EXTENT[1] + y) * EXTENT[0] + x;
    [number, number * number % 65521, number % 7].map(f64::from)
}

/// The sum of what was drawn into a texel of all its layers and samples, and a number that tells how many those are.
fn summed(x: u32, y: u32, layers: u32, samples: u32) -> [f64; 4] {
    let all = (0..layers).flat_map(|layer| (0..samples).map(move |number| drawn(x, y, layer, number)));
    let [r, g, b] = all.fold([0.0; 3], |sum, value| [0, 1, 2].map(|channel| sum[channel] + value[channel]));
    [r, g, b, f64::from(100 * layers + samples)]
}

fn demand(msaa: u32, layers: u32) -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let (samples, count) = (msaa.to_string(), layers.to_string());
    let set = [("msaa", &*samples), ("layers", &*count)];
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/textures.ron", set: &set, scene: &scene, extent: EXTENT };
    let outputs = render(device, &setup)?;
    let texels: Vec<Vec<[f32; 4]>> = outputs
        .iter()
        .map(|output| {
            let (words, _) = output.bytes.as_chunks::<4>();
            let floats: Vec<f32> = words.iter().map(|word| f32::from_ne_bytes(*word)).collect();
            floats.as_chunks::<4>().0.to_vec()
        })
        .collect();
    for (y, x) in (0..EXTENT[1]).flat_map(|y| (0..EXTENT[0]).map(move |x| (y, x))) {
        let at = (y * EXTENT[0] + x) as usize;
        let found = |output: usize| texels[output][at].map(f64::from);
        assert_eq!(found(0), summed(x, y, 1, 1), "flat ({x}, {y})");
        assert_eq!(found(1), summed(x, y, layers, 1), "layered ({x}, {y})");
        assert_eq!(found(2), summed(x, y, 1, msaa), "sampled ({x}, {y})");
        let sum = summed(x, y, 1, msaa);
        let [mean @ .., kind] = found(3);
        // Drivers average as they like; a mean of four numbers of 24 bits may be rounded twice.
        let close = |(found, sum): (f64, &f64)| (found - sum / f64::from(msaa)).abs() <= sum * 2_f64.powi(-22);
        assert!(mean.into_iter().zip(&sum[..3]).all(close), "resolved ({x}, {y}): {mean:?} of {sum:?}");
        assert_eq!(kind, 101.0, "resolved ({x}, {y})");
    }
    Ok(())
}

#[test]
fn one_shader_sums_a_flat_image_layers_and_samples() -> Result<(), Box<dyn Error>> {
    demand(4, 3)
}

#[test]
fn single_samples_of_an_image_with_one_sample_are_its_texels() -> Result<(), Box<dyn Error>> {
    demand(1, 3)
}

#[test]
fn one_layer_is_a_flat_image() -> Result<(), Box<dyn Error>> {
    demand(4, 1)
}
