//! FXAA leaves alone what is flat, smooths what is hard, and is its twin (NU-5).

use framewright_passes::twin::fxaa::fxaa;
use framewright_tests::render::{Setup, device, render, rgb};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const EXTENT: [usize; 2] = [64, 48];

pub(super) type Picture = Vec<[f64; 3]>;

/// The halves, the halves smoothed, noise, and that smoothed.
pub(super) fn smoothed(set: &[(&str, &str)]) -> Result<Option<[Picture; 4]>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let (scene, extent) = (empty_scene(), EXTENT.map(|side| side as u32));
    let setup = Setup { pipeline: "tests/pipelines/fxaa.ron", set, scene: &scene, extent };
    let pictures = render(device, &setup)?.into_iter().map(|output| rgb(&output));
    let pictures: Vec<Picture> = pictures.collect();
    Ok(Some(pictures.try_into().map_err(|_| "not four outputs")?))
}

pub(super) fn texel(picture: &Picture, x: i32, y: i32) -> [f64; 3] {
    let [width, height] = EXTENT.map(|side| side as i32);
    picture[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize]
}

fn places() -> impl Iterator<Item = [i32; 2]> {
    let [width, height] = EXTENT.map(|side| side as i32);
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

#[test]
fn a_flat_image_is_unchanged_bit_for_bit() -> Result<(), Box<dyn Error>> {
    for level in ["0.0", "0.37", "1.0", "50.0"] {
        let Some([flat, smooth, ..]) = smoothed(&[("bright", level), ("dark", level), ("subpixel", "1.0")])? else {
            return Ok(());
        };
        assert!(flat == smooth, "{level}");
    }
    Ok(())
}

#[test]
fn texels_far_from_an_edge_are_unchanged_and_those_at_it_lie_between_both_sides() -> Result<(), Box<dyn Error>> {
    for (x, y) in [("0.2", "1.0"), ("1.0", "0.3"), ("-0.1", "1.0"), ("1.0", "-0.45")] {
        for subpixel in ["0.0", "0.75"] {
            let offset = (32.0 * x.parse::<f64>()? + 24.0 * y.parse::<f64>()? + 0.137).to_string();
            let set = [("slope_x", x), ("slope_y", y), ("offset", &*offset), ("subpixel", subpixel)];
            let Some([hard, smooth, ..]) = smoothed(&set)? else { return Ok(()) };
            let mut between = 0;
            for [i, k] in places() {
                let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
                let flat = around.into_iter().all(|(dx, dy)| texel(&hard, i + dx, k + dy) == texel(&hard, i, k));
                let found = texel(&smooth, i, k)[0];
                assert!(!flat || texel(&smooth, i, k) == texel(&hard, i, k), "({i}, {k}) is far from the edge");
                assert!((0.1..=0.8).contains(&((found * 1e6).round() / 1e6)), "({i}, {k}): {found}");
                between += u32::from(found > 0.1001 && found < 0.7999);
            }
            assert!(between > 20, "slope {x}, {y}: {between} texels lie between");
        }
    }
    Ok(())
}

/// How much of a texel lies beyond the border, by 64 × 64 places in it.
fn coverage([x, y]: [i32; 2], slope: [f64; 2], offset: f64) -> f64 {
    let place = |step: i32| (f64::from(step) + 0.5) / 64.0;
    let inside =
        |at: i32| slope[0] * (f64::from(x) + place(at % 64)) + slope[1] * (f64::from(y) + place(at / 64)) > offset;
    f64::from((0..64 * 64).filter(|at| inside(*at)).count() as u32) / 4096.0
}

/// The error metric: root of the mean squared difference from a picture of 4,096 samples a texel, in linear light.
#[test]
fn edges_come_nearer_to_the_converged_picture() -> Result<(), Box<dyn Error>> {
    for slope in [[0.2, 1.0], [1.0, 0.3], [-0.1, 1.0], [0.07, 1.0]] {
        let offset = 32.0 * slope[0] + 24.0 * slope[1] + 0.137;
        let [x, y, o] = [slope[0], slope[1], offset].map(|number: f64| number.to_string());
        let Some([hard, smooth, ..]) = smoothed(&[("slope_x", &x), ("slope_y", &y), ("offset", &o)])? else {
            return Ok(());
        };
        let error = |picture: &Picture| {
            let squares = places().map(|[x, y]| {
                let expected = 0.1 + 0.7 * coverage([x, y], slope, offset);
                (texel(picture, x, y)[0] - expected).powi(2)
            });
            (squares.sum::<f64>() / (EXTENT[0] * EXTENT[1]) as f64).sqrt()
        };
        let (before, after) = (error(&hard), error(&smooth));
        println!("slope {slope:?}: {before:.4} before, {after:.4} after");
        assert!(after < 0.6 * before, "slope {slope:?}: {before} before, {after} after");
    }
    Ok(())
}

/// Where two decisions are nearly even the GPU's 32 bits may take the other one: at one texel in a thousand.
#[test]
fn on_noise_and_on_edges_it_is_its_twin() -> Result<(), Box<dyn Error>> {
    for subpixel in ["0.0", "0.75", "1.0"] {
        let Some([hard, smooth, noise, calm]) = smoothed(&[("subpixel", subpixel)])? else { return Ok(()) };
        for (shown, before, after) in [("edge", &hard, &smooth), ("noise", &noise, &calm)] {
            let amount = subpixel.parse()?;
            let off = |[x, y]: &[i32; 2]| {
                let expected = fxaa(|x, y| texel(before, x, y), [*x, *y], amount);
                let found = texel(after, *x, *y);
                (0..3).any(|channel| (found[channel] - expected[channel]).abs() > 1e-5 * (1.0 + expected[channel]))
            };
            let off: Vec<[i32; 2]> = places().filter(off).collect();
            assert!(1000 * off.len() <= EXTENT[0] * EXTENT[1], "{shown} at {subpixel}: {off:?}");
        }
    }
    Ok(())
}
