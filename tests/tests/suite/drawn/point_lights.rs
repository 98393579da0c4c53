//! The light of many point lights, of which each fragment looks at few, is that of all of them.

use framewright_passes::scene::{PointLight, Scene, load};
use framewright_tests::render::{Setup, device, in_repository, render};
use std::error::Error;

/// Lights over the floor of the shipped scene, some without a range, some that reach far.
fn lit(count: u32) -> Result<Scene, Box<dyn Error>> {
    let mut scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    let light = |number: u32| {
        let (turn, share) = (f64::from(number) * 2.399_963, f64::from(number) / f64::from(count));
        let out = share.sqrt() * 14.0;
        let position = [turn.cos() * out, 0.1 + 0.37 * f64::from(number % 7), turn.sin() * out];
        let range = match number % 97 {
            0 => None,
            1 => Some(1e3),
            _ => Some(0.3 + 0.01 * (number % 90) as f32),
        };
        let color = [(number % 3) as f32 * 0.5, 0.4, (number % 5) as f32 * 0.25];
        PointLight { position, color, intensity: 0.3, range, shadows: false }
    };
    scene.point_lights = (0..count).map(light).collect();
    Ok(scene)
}

/// How many lights a fragment looks at on average, if that gives what all lights give.
fn looked_at(scene: &Scene, extent: [u32; 2], scale: &str) -> Result<Option<f64>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let set = [("scale", scale)];
    let outputs = render(device, &Setup { pipeline: "tests/pipelines/point_lights.ron", set: &set, scene, extent })?;
    let pixels = |output: usize| -> Vec<[f32; 4]> {
        let words = outputs[output].bytes.as_chunks::<4>().0.iter();
        let floats: Vec<f32> = words.map(|word| f32::from_ne_bytes(*word)).collect();
        floats.as_chunks::<4>().0.to_vec()
    };
    let (mut sum, mut shown, mut bright) = (0.0, 0.0, 0);
    for (number, (by_clusters, one_by_one)) in pixels(0).iter().zip(pixels(1)).enumerate() {
        let bits = |color: &[f32; 4]| [color[0], color[1], color[2]].map(f32::to_bits);
        assert_eq!(bits(by_clusters), bits(&one_by_one), "pixel {number}: {by_clusters:?}, {one_by_one:?}");
        if one_by_one[3] > 0.0 {
            sum += f64::from(by_clusters[3]);
            shown += 1.0;
            bright += usize::from(by_clusters[1] > 0.05);
        }
    }
    assert!(bright > 500, "only {bright} pixels show any light");
    Ok(Some(sum / shown))
}

#[test]
fn two_thousand_lights_in_clusters_give_what_all_give_bit_by_bit_at_any_size() -> Result<(), Box<dyn Error>> {
    let scene = lit(2000)?;
    for (extent, scale) in [([120, 80], "1"), ([120, 80], "0.45"), ([60, 130], "1")] {
        let Some(looked_at) = looked_at(&scene, extent, scale)? else { return Ok(()) };
        assert!((40.0..200.0).contains(&looked_at), "of 2000 lights a fragment looks at {looked_at}");
    }
    Ok(())
}

#[test]
fn lights_of_which_none_has_a_range_are_all_looked_at() -> Result<(), Box<dyn Error>> {
    let mut scene = lit(64)?;
    scene.point_lights.iter_mut().for_each(|light| light.range = None);
    let Some(looked_at) = looked_at(&scene, [80, 60], "1")? else { return Ok(()) };
    assert!((looked_at - 64.0).abs() < 1e-9, "{looked_at}");
    Ok(())
}
