//! Fragments of the shipped library are held against the twins of their shaders, texel by texel (NU-5).

use framewright_passes::twin::filters::gauss;
use framewright_passes::twin::tone_mapping::{filmic, modified_reinhard, neutral, reinhard, reinhard_luminance};
use framewright_tests::render::{Setup, device, render, rgb};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const EXTENT: [usize; 2] = [64, 48];
/// The largest number that `noise.frag` draws into each channel.
const BRIGHTEST: [f64; 3] = [1.0, 60000.0, 1000.0];
/// The bound for one blur along one axis, as a share of the brightest number: some 60 roundings of 2⁻²⁴ each.
const ROUNDINGS: f64 = 4e-6;

type Picture = Vec<[f64; 3]>;

/// The pipeline's outputs.
fn drawn(times: &str, radius: &str) -> Result<Option<Vec<Picture>>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let (set, scene) = ([("times", times), ("radius", radius)], empty_scene());
    let setup = Setup { pipeline: "tests/pipelines/library.ron", set: &set, scene: &scene, extent: [8, 8] };
    let pictures = render(device, &setup)?.into_iter().map(|output| rgb(&output));
    Ok(Some(pictures.collect()))
}

/// A Gaussian along the axis `across`, in 64 bits; beyond the border lies that of the border.
fn blurred(picture: &Picture, across: bool, radius: f64) -> Picture {
    let [width, height] = EXTENT.map(|side| side as i32);
    let at = |x: i32, y: i32| picture[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize];
    let texel = |x: i32, y: i32| {
        [0, 1, 2].map(|channel| {
            let along = |step: i32| if across { at(x + step, y) } else { at(x, y + step) };
            gauss(|step| along(step)[channel], radius)
        })
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect()
}

#[test]
fn blurring_several_times_is_as_many_gaussians_along_both_axes() -> Result<(), Box<dyn Error>> {
    for (times, radius) in [(1, "2.5"), (3, "2.5"), (2, "7.0"), (2, "0.0")] {
        let Some(pictures) = drawn(&times.to_string(), radius)? else { return Ok(()) };
        let radius = radius.parse()?;
        let expected =
            (0..times).fold(pictures[0].clone(), |it, _| blurred(&blurred(&it, true, radius), false, radius));
        for (at, (found, expected)) in pictures[1].iter().zip(&expected).enumerate() {
            for channel in 0..3 {
                let bound = f64::from(2 * times) * ROUNDINGS * BRIGHTEST[channel];
                let apart = (found[channel] - expected[channel]).abs();
                assert!(apart <= bound, "{times} times {radius}, texel {at}: {found:?} instead of {expected:?}");
            }
        }
    }
    Ok(())
}

/// Nine units in the last place, as in the tests of the shader itself; of curves for three channels together, half a
/// thousandth of an 8-bit step.
#[test]
fn each_operator_of_tone_mapping_is_its_curve() -> Result<(), Box<dyn Error>> {
    let Some(pictures) = drawn("1", "1.0")? else { return Ok(()) };
    let [noise, _, clipped, compressed, bent, film, mapped, ratios] = &pictures[..] else {
        return Err("not eight outputs".into());
    };
    type Curve = fn(f64) -> f64;
    type Together = fn([f64; 3]) -> [f64; 3];
    let curves: [(&Picture, Curve); 4] = [
        (clipped, |light| (2.0 * light).min(1.0)),
        (compressed, reinhard),
        (bent, |light| modified_reinhard(light, 4.0)),
        (film, filmic),
    ];
    for (picture, curve) in curves {
        for (light, found) in noise.iter().flatten().zip(picture.iter().flatten()) {
            let expected = curve(*light);
            assert!((found - expected).abs() <= 9.0 / 8_388_608.0 * expected, "{light} became {found}, not {expected}");
        }
    }
    let together: [(&Picture, Together); 2] = [(mapped, neutral), (ratios, reinhard_luminance)];
    for (picture, curve) in together {
        for (light, found) in noise.iter().zip(picture) {
            let expected = curve(*light);
            let close = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= 2e-6);
            assert!(close, "{light:?} became {found:?}, not {expected:?}");
        }
    }
    Ok(())
}
