//! Depth stripes, as a blend and as a copy, of depth with one sample and of what drawing it again with one leaves, are held
//! against their twin (IQ-12, IQ-16).

use framewright_passes::scene::Scene;
use framewright_passes::twin::effects::stripe;
use framewright_tests::render::{Setup, device, floats, render};
use framewright_tests::shapes::{material, scene, sphere, square};
use glam::{Mat4, Vec3};
use std::error::Error;

/// The error that Vulkan allows a sine, 2⁻¹¹, twice over since it is squared: a quarter of an 8-bit step.
const SINE: f64 = 2.0 / 2048.0;

/// Texel by texel the depth, and white light through the stripes in both forms.
type Striped = Vec<(f64, [f64; 2])>;

fn floor_and_sphere() -> Scene {
    let floor = Mat4::from_translation(Vec3::NEG_Y) * Mat4::from_rotation_x(-1.5) * Mat4::from_scale(Vec3::splat(9.0));
    let objects = vec![(0, 0, floor), (1, 0, Mat4::from_translation(Vec3::new(-0.5, 0.4, 1.5)))];
    scene(vec![square(), sphere(16)], vec![material([1.0; 4])], objects)
}

fn striped(msaa: &str, period: &str) -> Result<Option<Striped>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let (set, scene) = ([("msaa", msaa), ("period", period)], floor_and_sphere());
    let setup = Setup { pipeline: "tests/pipelines/depth_stripes.ron", set: &set, scene: &scene, extent: [67, 45] };
    let channels = render(device, &setup)?.into_iter().map(|output| floats(&output).into_iter().step_by(4).collect());
    let red: Vec<Vec<f64>> = channels.collect();
    let [depth, blended, copied] = &red[..] else { return Err("not three outputs".into()) };
    Ok(Some((0..depth.len()).map(|at| (depth[at], [blended[at], copied[at]])).collect()))
}

/// The light that a stripe lets through, and how far phases may be off: distances have some four roundings.
fn expected(depth: f64, period: f64) -> (f64, f64) {
    let near = f64::from(floor_and_sphere().camera.near);
    let periods = if depth > 0.0 { near / (depth * period) } else { 0.0 };
    (stripe(depth, near, period), SINE + std::f64::consts::PI * periods * 2_f64.powi(-21))
}

#[test]
fn stripes_are_their_twin_as_a_blend_and_as_a_copy() -> Result<(), Box<dyn Error>> {
    for (msaa, period) in [("1", "1.0"), ("1", "0.37"), ("4", "1.0"), ("4", "0.25")] {
        let Some(texels) = striped(msaa, period)? else { return Ok(()) };
        for (depth, found) in &texels {
            let (expected, bound) = expected(*depth, period.parse()?);
            for light in found {
                assert!((light - expected).abs() <= bound, "{msaa}×, {depth}: {light} instead of {expected}");
            }
        }
        let dark = texels.iter().filter(|(_, [blended, _])| *blended < 0.1).count();
        let bright = texels.iter().filter(|(depth, [blended, _])| *depth > 0.0 && *blended > 0.9).count();
        assert!(dark > 30 && bright > 30, "{msaa}×, period {period}: {dark} dark and {bright} bright texels");
    }
    Ok(())
}

/// IQ-12: the depth is what one sample would have left.
#[test]
fn samples_change_nothing_about_the_stripes() -> Result<(), Box<dyn Error>> {
    let [Some(one), Some(four)] = [striped("1", "1.0")?, striped("4", "1.0")?] else { return Ok(()) };
    assert!(one == four);
    Ok(())
}

#[test]
fn where_nothing_was_drawn_there_are_no_stripes() -> Result<(), Box<dyn Error>> {
    for msaa in ["1", "4"] {
        let Some(texels) = striped(msaa, "1.0")? else { return Ok(()) };
        let empty: Vec<_> = texels.iter().filter(|(depth, _)| *depth == 0.0).collect();
        assert!(empty.len() > 100);
        assert!(empty.iter().all(|(_, found)| *found == [1.0; 2]));
    }
    Ok(())
}

#[test]
fn stripes_that_can_not_be_told_apart_are_none() {
    assert_eq!(stripe(0.0, 0.1, 1.0), 1.0);
    assert_eq!(stripe(1e-30, 0.1, 1.0), 1.0);
    assert_eq!(stripe(0.1, 0.1, 1e-9), 1.0);
    assert!(stripe(0.1, 0.1, 1.0) < 1e-20 && (stripe(0.2, 0.1, 1.0) - 1.0).abs() < 1e-12);
}
