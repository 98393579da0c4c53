//! Shaders that make one depth of a texel's samples are held against what the samples are (IQ-10, IQ-14).

use framewright_passes::twin::depth_samples::{greatest_depth, least_depth, mean_depth};
use framewright_tests::render::{Setup, device, floats, render};
use framewright_tests::shapes::{material, scene, sphere, square};
use glam::{Mat4, Vec3};
use std::error::Error;

/// The samples of every texel, and what `zero`, `min`, `max` and `average` made of them.
type Resolved = Vec<([f64; 4], [f64; 4])>;

fn resolved() -> Result<Option<Resolved>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    // Slanted edges before one another, before nothing, and a surface that recedes.
    let floor = Mat4::from_rotation_x(-1.2) * Mat4::from_scale(Vec3::splat(6.0));
    let tilted = Mat4::from_translation(Vec3::new(0.4, 0.3, 1.0)) * Mat4::from_rotation_z(0.4);
    let objects = vec![(0, 0, floor), (0, 0, tilted), (1, 0, Mat4::from_translation(Vec3::new(-1.0, 0.5, 0.5)))];
    let scene = scene(vec![square(), sphere(16)], vec![material([1.0; 4])], objects);
    let setup = Setup { pipeline: "tests/pipelines/depth_resolves.ron", set: &[], scene: &scene, extent: [67, 45] };
    let outputs = render(device, &setup)?.into_iter().map(|output| floats(&output));
    let outputs: Vec<Vec<f64>> = outputs.collect();
    let [samples, zero, least, greatest, mean] = &outputs[..] else { return Err("not five outputs".into()) };
    let samples = samples.as_chunks::<4>().0.iter();
    let texel = |(at, samples): (usize, &[f64; 4])| (*samples, [zero[at], least[at], greatest[at], mean[at]]);
    Ok(Some(samples.enumerate().map(texel).collect()))
}

#[test]
fn sample_zero_the_least_and_the_greatest_are_bit_for_bit_those_of_the_samples() -> Result<(), Box<dyn Error>> {
    let Some(resolved) = resolved()? else { return Ok(()) };
    for (samples, [zero, least, greatest, _]) in &resolved {
        assert_eq!([*zero, *least, *greatest], [samples[0], least_depth(samples), greatest_depth(samples)]);
    }
    let told_apart =
        |(samples, _): &&([f64; 4], _)| samples[0] != least_depth(samples) && samples[0] != greatest_depth(samples);
    assert!(resolved.iter().filter(told_apart).count() > 5, "edges where the three differ");
    Ok(())
}

#[test]
fn the_average_is_the_mean_of_the_samples() -> Result<(), Box<dyn Error>> {
    let Some(resolved) = resolved()? else { return Ok(()) };
    for (samples, [.., mean]) in &resolved {
        let expected = mean_depth(samples);
        // Three sums, each rounded by half of 2⁻²³ at most; the division by 4 is exact.
        assert!((mean - expected).abs() <= 1.5 / 8_388_608.0 * expected, "{samples:?} became {mean}, not {expected}");
    }
    let edges = resolved.iter().filter(|(samples, _)| samples.iter().any(|depth| *depth != samples[0]));
    assert!(edges.count() > 50, "texels whose samples differ");
    Ok(())
}
