//! Each filter of the final scale is held against its definition at scales from 0.25 to 4 and odd sizes (IQ-1, IQ-4, NU-5).

use framewright_passes::twin::scale::{area, bilinear, catmull_rom, middle, sharpened};
use framewright_tests::render::{Setup, device, floats, render};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::Texels;
use std::error::Error;

const SCALES: [&str; 8] = ["0.25", "0.5", "0.7", "1", "1.5", "2", "3", "4"];
/// NU-4: down to a single pixel, of which a scale of 0.25 is a single texel.
const TARGETS: [[u32; 2]; 5] = [[37, 23], [16, 10], [1, 1], [1, 9], [9, 1]];
/// The largest number that `noise_of_texels.frag` draws into each channel.
const BRIGHTEST: [f64; 3] = [1.0, 1.0, 40.0];
const OUTPUTS: usize = 7;

pub(super) struct Image {
    pub(super) extent: [u32; 2],
    channels: Vec<f64>,
}

impl Image {
    /// Of 32-bit floats, or of 8 bits in their own steps.
    fn of(output: &Texels, eight_bits: bool) -> Image {
        let [width, height, _] = output.extent;
        let channels = match eight_bits {
            true => output.bytes.iter().map(|byte| f64::from(*byte)).collect(),
            false => floats(output),
        };
        Image { extent: [width, height], channels }
    }

    /// A channel of a texel; beyond the border that of the border.
    pub(super) fn at(&self, x: i32, y: i32, channel: usize) -> f64 {
        let [width, height] = self.extent.map(u32::cast_signed);
        let texel = y.clamp(0, height - 1) * width + x.clamp(0, width - 1);
        self.channels[4 * texel as usize + channel]
    }
}

/// The source, and what each filter made of it.
pub(super) fn scaled(scale: &str, extent: [u32; 2]) -> Result<Option<[Image; OUTPUTS]>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let (set, scene) = ([("scale", scale)], empty_scene());
    let setup = Setup { pipeline: "tests/pipelines/scale.ron", set: &set, scene: &scene, extent };
    let outputs = render(device, &setup)?;
    let images: Vec<Image> = outputs.iter().enumerate().map(|(at, output)| Image::of(output, at >= 5)).collect();
    Ok(Some(images.try_into().map_err(|_| "not seven outputs")?))
}

/// Holds every channel of every pixel against all that it may be: `allowed` gives the least and the greatest number.
fn demand(shown: &str, target: &Image, bound: f64, allowed: impl Fn([u32; 2], usize) -> [f64; 2]) {
    let [width, height] = target.extent;
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        for (channel, brightest) in BRIGHTEST.into_iter().enumerate() {
            let found = target.at(x.cast_signed(), y.cast_signed(), channel);
            let [least, greatest] = allowed([x, y], channel);
            let bound = bound * brightest;
            let within = least - bound <= found && found <= greatest + bound;
            assert!(within, "{shown} ({x}, {y}) channel {channel}: {found} instead of {least} to {greatest}");
        }
    }
}

#[test]
fn the_size_follows_the_scale_rounded_down() -> Result<(), Box<dyn Error>> {
    for (scale, expected) in [("0.25", [9, 5]), ("0.7", [25, 16]), ("1", [37, 23]), ("1.5", [55, 34]), ("4", [148, 92])]
    {
        let Some([noise, ..]) = scaled(scale, [37, 23])? else { return Ok(()) };
        assert_eq!(noise.extent, expected, "{scale}");
    }
    Ok(())
}

#[test]
fn the_area_filter_is_the_mean_of_what_a_pixel_covers_at_every_scale() -> Result<(), Box<dyn Error>> {
    for (scale, extent) in SCALES.iter().flat_map(|scale| TARGETS.map(|extent| (scale, extent))) {
        let Some([noise, _, _, found, ..]) = scaled(scale, extent)? else { return Ok(()) };
        demand(&format!("area at {scale}"), &found, 2e-6, |pixel, channel| {
            [area(|x, y| noise.at(x, y, channel), pixel, noise.extent, extent); 2]
        });
    }
    Ok(())
}

#[test]
fn catmull_rom_is_its_curve_along_both_axes_at_every_scale() -> Result<(), Box<dyn Error>> {
    for (scale, extent) in SCALES.iter().flat_map(|scale| TARGETS.map(|extent| (scale, extent))) {
        let Some([noise, .., found, _, _]) = scaled(scale, extent)? else { return Ok(()) };
        demand(&format!("Catmull-Rom at {scale}"), &found, 1e-5, |pixel, channel| {
            [sharpened(|x, y| noise.at(x, y, channel), pixel, noise.extent, extent).max(0.0); 2]
        });
    }
    Ok(())
}

/// Samplers hold places between texels in 8 bits, and drivers differ in how they round them: a 128th of the brightest number
/// for each axis.
#[test]
fn bilinear_lies_between_four_texels() -> Result<(), Box<dyn Error>> {
    for (scale, extent) in SCALES.iter().flat_map(|scale| TARGETS.map(|extent| (scale, extent))) {
        let Some([noise, _, found, ..]) = scaled(scale, extent)? else { return Ok(()) };
        demand(&format!("bilinear at {scale}"), &found, 2.0 / 128.0, |pixel, channel| {
            [bilinear(|x, y| noise.at(x, y, channel), pixel, noise.extent, extent); 2]
        });
    }
    Ok(())
}

/// Where the middle of a pixel lies on the border of two texels either may be taken.
#[test]
fn nearest_takes_the_texel_in_the_middle() -> Result<(), Box<dyn Error>> {
    for (scale, extent) in SCALES.iter().flat_map(|scale| TARGETS.map(|extent| (scale, extent))) {
        let Some([noise, found, ..]) = scaled(scale, extent)? else { return Ok(()) };
        for (y, x) in (0..extent[1]).flat_map(|y| (0..extent[0]).map(move |x| (y, x))) {
            let pixel = [x, y];
            let [across, down] = [0, 1].map(|axis| {
                let place = middle(pixel[axis], noise.extent[axis], extent[axis]) + 0.5;
                [place - 1e-3, place + 1e-3].map(|place| place.floor() as i32)
            });
            let candidates =
                across.iter().flat_map(|x| down.map(|y| [0, 1, 2].map(|channel| noise.at(*x, y, channel))));
            let texel = [0, 1, 2].map(|channel| found.at(x.cast_signed(), y.cast_signed(), channel));
            assert!(candidates.into_iter().any(|it| it == texel), "{scale}, ({x}, {y}): {texel:?}");
        }
    }
    Ok(())
}

/// IQ-4: each pixel of what is shown is the mean of its own four texels, within one 8-bit step.
#[test]
fn scale_two_is_the_mean_of_two_by_two_texels_within_one_step_of_8_bits() -> Result<(), Box<dyn Error>> {
    let linear = |step: f64| match step / 255.0 {
        low if low <= 0.04045 => low / 12.92,
        high => ((high + 0.055) / 1.055).powf(2.4),
    };
    let encoded = |light: f64| match light {
        low if low <= 0.003_130_8 => 255.0 * 12.92 * low,
        high => 255.0 * (1.055 * high.powf(1.0 / 2.4) - 0.055),
    };
    for extent in TARGETS {
        let Some([noise, _, _, means, _, texels, shown]) = scaled("2", extent)? else { return Ok(()) };
        for (y, x) in (0..extent[1].cast_signed()).flat_map(|y| (0..extent[0].cast_signed()).map(move |x| (y, x))) {
            for channel in 0..3 {
                let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| (2 * x + dx, 2 * y + dy));
                let light = four.map(|(x, y)| noise.at(x, y, channel)).iter().sum::<f64>() / 4.0;
                assert!((means.at(x, y, channel) - light).abs() <= 1e-6 * light, "({x}, {y}) channel {channel}");
                let bits = four.map(|(x, y)| linear(texels.at(x, y, channel))).iter().sum::<f64>() / 4.0;
                let (found, expected) = (shown.at(x, y, channel), encoded(bits));
                assert!((found - expected).abs() <= 1.0, "({x}, {y}) channel {channel}: {found}, not {expected}");
            }
        }
    }
    Ok(())
}

/// Beyond scale 2 a bilinear tap leaves texels out: at 3 it shows one of nine, as if the scale were 1.
#[test]
fn at_scale_three_only_the_area_filter_sees_every_texel() -> Result<(), Box<dyn Error>> {
    let extent = [37, 23];
    let Some([noise, _, bilinear, area, ..]) = scaled("3", extent)? else { return Ok(()) };
    let (mut of_bilinear, mut of_area) = (0.0_f64, 0.0_f64);
    for (y, x) in (0..23).flat_map(|y| (0..37).map(move |x| (y, x))) {
        let nine = (0..9).map(|at| noise.at(3 * x + at % 3, 3 * y + at / 3, 0)).sum::<f64>() / 9.0;
        of_area = of_area.max((area.at(x, y, 0) - nine).abs());
        of_bilinear = of_bilinear.max((bilinear.at(x, y, 0) - nine).abs());
        assert!((bilinear.at(x, y, 0) - noise.at(3 * x + 1, 3 * y + 1, 0)).abs() < 2.0 / 128.0);
    }
    assert!(of_area < 1e-6 && of_bilinear > 0.3, "area {of_area}, bilinear {of_bilinear}");
    Ok(())
}

#[test]
fn at_scale_one_every_filter_but_the_samplers_own_is_the_identity() -> Result<(), Box<dyn Error>> {
    let Some([noise, nearest, _, area, catmull_rom, ..]) = scaled("1", [37, 23])? else { return Ok(()) };
    for found in [nearest, area, catmull_rom] {
        assert!(found.channels.iter().zip(&noise.channels).all(|(found, noise)| (found - noise).abs() <= 1e-6 * noise));
    }
    Ok(())
}

#[test]
fn the_curve_of_catmull_and_rom_adds_up_to_one_and_passes_through_what_is_given() {
    assert_eq!([0.0, 1.0, -1.0, 2.0, 5.0].map(catmull_rom), [1.0, 0.0, 0.0, 0.0, 0.0]);
    for share in (0..100).map(|step| f64::from(step) / 100.0) {
        let sum: f64 = (-2..=3).map(|texel| catmull_rom(f64::from(texel) - share)).sum();
        assert!((sum - 1.0).abs() < 1e-12);
        // A straight line stays one.
        let line: f64 = (-2..=3).map(|texel| f64::from(texel) * catmull_rom(f64::from(texel) - share)).sum();
        assert!((line - share).abs() < 1e-12);
    }
}
