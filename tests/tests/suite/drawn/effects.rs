//! Small effects of the library are held against their twins, texel by texel (IQ-17, IQ-23, NU-4, NU-5).

use framewright_graph::compile::Options;
use framewright_passes::twin::bloom::tent;
use framewright_passes::twin::effects::{grain, over_bright, vignette};
use framewright_passes::twin::radiance::guard_radiance;
use framewright_tests::render::{Setup, device, draw, render, rgb, silent};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const EXTENT: [usize; 2] = [64, 48];
/// The largest number that `noise.frag` draws into each channel.
const BRIGHTEST: [f64; 3] = [1.0, 60000.0, 1000.0];

type Picture = Vec<[f64; 3]>;

const PIPELINE: &str = "tests/pipelines/effects.ron";

/// The pipeline's outputs in the frame of this number, from 1 on.
fn drawn(frame: u32, strength: &str, amount: &str) -> Result<Option<Vec<Picture>>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let (set, scene) = ([("strength", strength), ("amount", amount)], empty_scene());
    let setup = Setup { pipeline: PIPELINE, set: &set, scene: &scene, extent: [8, 8] };
    if frame == 1 {
        return Ok(Some(render(device, &setup)?.iter().map(rgb).collect()));
    }
    let (plan, mut executor) = draw(device, &setup, &Options::default(), frame)?;
    let outputs: Result<Vec<_>, _> = (0..plan.outputs.len()).map(|output| executor.read(output)).collect();
    silent(device)?;
    Ok(Some(outputs?.iter().map(rgb).collect()))
}

#[test]
fn the_over_bright_view_shows_just_what_is_beyond_white() -> Result<(), Box<dyn Error>> {
    let Some(pictures) = drawn(1, "1", "0.5")? else { return Ok(()) };
    for (light, found) in pictures[0].iter().flatten().zip(pictures[1].iter().flatten()) {
        let expected = over_bright(guard_radiance(*light));
        // One rounding.
        assert!((found - expected).abs() <= expected / 8_388_608.0, "{light} became {found} instead of {expected}");
        assert!(*light > 1.0 || *found == 0.0, "{light} is not beyond white and became {found}");
    }
    Ok(())
}

/// A tent of 3 × 3 texels; beyond the border lies that of the border.
fn blurred(picture: &Picture) -> Picture {
    let [width, height] = EXTENT.map(|side| side as i32);
    let texel = |x: i32, y: i32| picture[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize];
    let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    all.map(|(x, y)| tent(|dx, dy| texel(x + dx as i32, y + dy as i32), 1.0)).collect()
}

#[test]
fn a_blur_of_strength_n_is_n_small_blurs_and_of_strength_0_none() -> Result<(), Box<dyn Error>> {
    for strength in [0, 1, 2, 5] {
        let Some(pictures) = drawn(1, &strength.to_string(), "0.5")? else { return Ok(()) };
        let expected = (0..strength).fold(pictures[2].clone(), |picture, _| blurred(&picture));
        for (at, (found, expected)) in pictures[3].iter().zip(&expected).enumerate() {
            for channel in 0..3 {
                let bound = f64::from(strength) * 4e-6 * BRIGHTEST[channel];
                let apart = (found[channel] - expected[channel]).abs();
                assert!(apart <= bound, "strength {strength}, texel {at}: {found:?} instead of {expected:?}");
            }
        }
    }
    Ok(())
}

#[test]
fn grain_is_its_twin_by_pixel_and_frame_and_none_at_strength_0() -> Result<(), Box<dyn Error>> {
    for (frame, amount) in [(1, "0.5"), (3, "0.5"), (1, "1.0"), (2, "0.0")] {
        let Some(pictures) = drawn(frame, "1", amount)? else { return Ok(()) };
        let strength: f64 = amount.parse()?;
        for (at, (light, found)) in pictures[2].iter().zip(&pictures[4]).enumerate() {
            let pixel = [at % EXTENT[0], at / EXTENT[0]].map(|place| place as u32);
            let factor = 1.0 + strength * grain(pixel, frame);
            for channel in 0..3 {
                let expected = guard_radiance(light[channel] * factor);
                let close = (found[channel] - expected).abs() <= 1e-6 * light[channel];
                assert!(close, "frame {frame}, {pixel:?}: {light:?} became {found:?}, by {factor}");
            }
        }
    }
    Ok(())
}

#[test]
fn grain_brightens_as_much_as_it_darkens_and_moves_from_frame_to_frame() {
    let places = || (0..200).flat_map(|y| (0..200).map(move |x| [x, y]));
    let all: Vec<f64> = places().map(|pixel| grain(pixel, 7)).collect();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    let spread = all.iter().map(|it| it * it).sum::<f64>() / all.len() as f64;
    // A triangle from −1 to 1 has a variance of 1/6; the mean of 40,000 is within five of its deviations.
    assert!(mean.abs() < 0.0103 && (spread - 1.0 / 6.0).abs() < 0.005, "mean {mean}, variance {spread}");
    let kin = |other: &dyn Fn([u32; 2]) -> f64| {
        let sum: f64 = places().map(|pixel| grain(pixel, 7) * other(pixel)).sum();
        sum / all.len() as f64 / spread
    };
    let relatives: [&dyn Fn([u32; 2]) -> f64; 4] =
        [&|pixel| grain(pixel, 8), &|[x, y]| grain([x + 1, y], 7), &|[x, y]| grain([x, y + 1], 7), &|[x, y]| {
            grain([y, x], 7)
        }];
    for (at, relative) in relatives.iter().enumerate() {
        let kinship = kin(relative);
        assert!(kinship.abs() < 0.03, "{at}: {kinship}");
    }
}

#[test]
fn a_vignette_darkens_by_the_fourth_power_of_the_cosine() -> Result<(), Box<dyn Error>> {
    for amount in ["0.0", "0.5", "1.0"] {
        let Some(pictures) = drawn(1, "1", amount)? else { return Ok(()) };
        for (at, found) in pictures[5].iter().enumerate() {
            let place = [at % EXTENT[0], at / EXTENT[0]].map(|place| place as f64 + 0.5);
            let uv = [place[0] / EXTENT[0] as f64, place[1] / EXTENT[1] as f64];
            let expected = vignette(uv, amount.parse()?, EXTENT[0] as f64 / EXTENT[1] as f64);
            assert!(
                found.iter().all(|channel| (channel - expected).abs() <= 1e-6),
                "{uv:?}: {found:?}, not {expected}"
            );
        }
    }
    // In the corner of any picture; in the middle nothing is lost.
    assert!((vignette([1.0, 1.0], 0.5, 1.6) - 0.64).abs() < 1e-12);
    assert_eq!(vignette([0.5, 0.5], 1.0, 1.6), 1.0);
    Ok(())
}
