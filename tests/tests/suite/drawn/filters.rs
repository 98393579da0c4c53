//! The shipped filters are held against their twins, texel by texel (NU-5).

use framewright_passes::twin::filters::{blur, downsample};
use framewright_tests::render::{Setup, device, floats, render};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::Texels;
use std::error::Error;

/// Width and height of the filtered image.
const EXTENT: [i32; 2] = [64, 48];

/// One output, as 32-bit floats.
pub(super) struct Image {
    pub(super) width: i32,
    pub(super) height: i32,
    pub(super) channels: Vec<f64>,
}

impl Image {
    pub(super) fn of(output: &Texels) -> Image {
        let [width, height, _] = output.extent.map(u32::cast_signed);
        Image { width, height, channels: floats(output) }
    }

    /// A channel of a texel; beyond the border that of the border.
    pub(super) fn at(&self, x: i32, y: i32, channel: usize) -> f64 {
        let texel = y.clamp(0, self.height - 1) * self.width + x.clamp(0, self.width - 1);
        self.channels[4 * texel as usize + channel]
    }
}

/// Noise, and what the filters made of it, in the order of the pipeline's outputs.
pub(super) struct Filtered {
    pub(super) noise: Image,
    pub(super) half: Image,
    pub(super) across: Image,
    down: Image,
    mixed: Image,
    copied: Image,
}

pub(super) fn filtered(strength: &str) -> Result<Option<Filtered>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let set = [("strength", strength)];
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/filters.ron", set: &set, scene: &scene, extent: [8, 8] };
    let images: Vec<Image> = render(device, &setup)?.iter().map(Image::of).collect();
    let [noise, half, across, down, mixed, copied] = images.try_into().map_err(|_| "not six outputs")?;
    Ok(Some(Filtered { noise, half, across, down, mixed, copied }))
}

/// Holds every channel of every texel against a formula of its place. `brightest` is the largest number that goes into it.
fn demand(shown: &str, image: &Image, expected: impl Fn(i32, i32, usize) -> f64) {
    for y in 0..image.height {
        for x in 0..image.width {
            for (channel, brightest) in [1.0, 60000.0, 1000.0, 1.0].into_iter().enumerate() {
                let (found, expected) = (image.at(x, y, channel), expected(x, y, channel));
                // Some 20 roundings of 2⁻²⁴ each.
                let close = (found - expected).abs() <= 2e-6 * brightest;
                assert!(close, "{shown} ({x}, {y}) channel {channel}: {found} instead of {expected}");
            }
        }
    }
}

#[test]
fn every_filter_is_its_twin() -> Result<(), Box<dyn Error>> {
    let Some(Filtered { noise, half, across, down, mixed, copied }) = filtered("0.25")? else { return Ok(()) };
    assert_eq!([noise.width, noise.height], EXTENT);
    assert_eq!([half.width, half.height], EXTENT.map(|side| side / 2));
    demand("half", &half, |x, y, channel| {
        downsample([(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| noise.at(2 * x + dx, 2 * y + dy, channel)))
    });
    demand("across", &across, |x, y, channel| blur(|step| noise.at(x + step, y, channel)));
    demand("down", &down, |x, y, channel| blur(|step| noise.at(x, y + 2 * step, channel)));
    demand("mixed", &mixed, |x, y, channel| 0.75 * noise.at(x, y, channel) + 0.25 * across.at(x, y, channel));
    assert!(copied.channels == noise.channels, "an unfiltered copy changes nothing");
    Ok(())
}

#[test]
fn soft_focus_runs_from_the_sharp_image_to_the_soft_one() -> Result<(), Box<dyn Error>> {
    let Some(sharp) = filtered("0.0")? else { return Ok(()) };
    demand("strength 0", &sharp.mixed, |x, y, channel| sharp.noise.at(x, y, channel));
    let Some(soft) = filtered("1.0")? else { return Ok(()) };
    demand("strength 1", &soft.mixed, |x, y, channel| soft.across.at(x, y, channel));
    Ok(())
}

#[test]
fn a_blur_moves_light_but_neither_adds_nor_takes_any() -> Result<(), Box<dyn Error>> {
    let weights: f64 = blur(|_| 1.0);
    assert!((weights - 1.0).abs() < 1e-15);
    let one_lit_texel: f64 = (-4..=4).map(|at| blur(|step| f64::from(u8::from(at + step == 0)))).sum();
    assert!((one_lit_texel - 1.0).abs() < 1e-15);
    Ok(())
}
