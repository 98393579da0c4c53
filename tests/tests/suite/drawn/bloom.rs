//! Bloom and the Gaussian blur are held against their twins, texel by texel (NU-5), and against every value that an image can
//! hold (NU-4).

use crate::drawn::filters::Image;
use framewright_passes::twin::bloom::{mixed, shrunk, tent};
use framewright_passes::twin::filters::gauss;
use framewright_passes::twin::radiance::LARGEST_HALF;
use framewright_tests::render::{Setup, device, render};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

impl Image {
    /// Light at a place in texels, between the middles of texels mixed linearly along both axes.
    pub(super) fn light(&self, x: f64, y: f64) -> [f64; 3] {
        let (left, top) = ((x - 0.5).floor(), (y - 0.5).floor());
        let (across, down) = (x - 0.5 - left, y - 0.5 - top);
        let (left, top) = (left as i32, top as i32);
        std::array::from_fn(|channel| {
            let row = |y| self.at(left, y, channel) * (1.0 - across) + self.at(left + 1, y, channel) * across;
            row(top) * (1.0 - down) + row(top + 1) * down
        })
    }
}

/// The pipeline's outputs.
pub(super) struct Filtered {
    pub(super) noise: Image,
    pub(super) plain: Image,
    pub(super) calm: Image,
    pub(super) grown: Image,
    mixed: Image,
    pub(super) blurred: Image,
    shrunk_values: Image,
    grown_values: Image,
}

pub(super) fn filtered(radius: &str, share: &str) -> Result<Option<Filtered>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let set = [("radius", radius), ("share", share)];
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/bloom.ron", set: &set, scene: &scene, extent: [8, 8] };
    let images: Vec<Image> = render(device, &setup)?.iter().map(Image::of).collect();
    let [noise, plain, calm, grown, mixed, blurred, shrunk_values, grown_values] =
        images.try_into().map_err(|_| "not eight outputs")?;
    Ok(Some(Filtered { noise, plain, calm, grown, mixed, blurred, shrunk_values, grown_values }))
}

/// The largest number that goes into each channel of the noise.
const BRIGHTEST: [f64; 4] = [1.0, 60000.0, 1000.0, 1.0];
/// The bound for every filter, as a share of the brightest number that goes into it: some 60 roundings of 2⁻²⁴ each.
const ROUNDINGS: f64 = 4e-6;

/// Holds every texel against a formula of its place, of as many channels as that gives.
fn demand<const N: usize>(shown: &str, image: &Image, expected: impl Fn(i32, i32) -> [f64; N]) {
    for y in 0..image.height {
        for x in 0..image.width {
            for (channel, expected) in expected(x, y).into_iter().enumerate() {
                let found = image.at(x, y, channel);
                let close = (found - expected).abs() <= ROUNDINGS * BRIGHTEST[channel];
                assert!(close, "{shown} ({x}, {y}) channel {channel}: {found} instead of {expected}");
            }
        }
    }
}

/// The colour part: the calm variant weighs by luminance, so a rounding of the bright green channel moves the others too.
#[test]
fn shrinking_is_its_twin_with_and_without_calming() -> Result<(), Box<dyn Error>> {
    let Some(Filtered { noise, plain, calm, .. }) = filtered("1.0", "0.25")? else { return Ok(()) };
    assert_eq!([plain.width, plain.height], [noise.width / 2, noise.height / 2]);
    for (shown, image, partial) in [("plain", &plain, false), ("calm", &calm, true)] {
        demand(shown, image, |x, y| {
            let middle = [x, y].map(|at| f64::from(2 * at + 1));
            shrunk(|dx, dy| noise.light(middle[0] + dx, middle[1] + dy), partial)
        });
    }
    Ok(())
}

#[test]
fn growing_and_mixing_are_their_twin_at_every_share_and_radius() -> Result<(), Box<dyn Error>> {
    // Places on a grid of quarter texels, which every driver's filter hits exactly.
    for (radius, share) in [("1.0", "0.25"), ("2.0", "1.0"), ("0.5", "0.6"), ("0.0", "0.0")] {
        let Some(Filtered { noise, plain, grown, mixed: bloomed, .. }) = filtered(radius, share)? else {
            return Ok(());
        };
        let (radius, share): (f64, f64) = (radius.parse()?, share.parse()?);
        let around = |x: i32, y: i32| {
            let middle = [x, y].map(|at| (f64::from(at) + 0.5) / 2.0);
            tent(|dx, dy| plain.light(middle[0] + dx, middle[1] + dy), radius)
        };
        let own = |x, y| [0, 1, 2].map(|channel| noise.at(x, y, channel));
        demand("grown", &grown, |x, y| mixed(own(x, y), around(x, y), share));
        demand("mixed", &bloomed, |x, y| {
            let [r, g, b] = mixed(own(x, y), around(x, y), share);
            [r, g, b, noise.at(x, y, 3)]
        });
    }
    Ok(())
}

#[test]
fn the_gaussian_is_its_twin_at_every_radius() -> Result<(), Box<dyn Error>> {
    for radius in ["0.0", "0.25", "1.0", "2.5", "7.0", "64.0"] {
        let Some(Filtered { noise, blurred, .. }) = filtered(radius, "0.25")? else { return Ok(()) };
        let radius = radius.parse()?;
        demand("blurred", &blurred, |x, y| {
            [0, 1, 2, 3].map(|channel| gauss(|step| noise.at(x, y + step, channel), radius))
        });
    }
    Ok(())
}

/// NU-4: what can't be light becomes 0 or the largest half, and stays where it is: nothing spreads over the image.
#[test]
fn infinities_and_what_is_no_number_leave_no_trace() -> Result<(), Box<dyn Error>> {
    let Some(Filtered { shrunk_values, grown_values, .. }) = filtered("1.0", "0.5")? else { return Ok(()) };
    for image in [shrunk_values, grown_values] {
        assert!(image.channels.iter().all(|value| (0.0..=LARGEST_HALF).contains(value)));
        assert!(image.channels.iter().any(|value| *value > 1000.0));
    }
    Ok(())
}

#[test]
fn bloom_moves_light_but_neither_adds_nor_takes_any() {
    for value in [0.0, 0.5, 65504.0] {
        let flat = |_: f64, _: f64| [value; 3];
        for light in [shrunk(flat, false), shrunk(flat, true), tent(flat, 1.7), mixed([value; 3], tent(flat, 1.0), 0.3)]
        {
            assert!(light.iter().all(|light| (light - value).abs() <= 1e-15 * value), "{light:?}");
        }
    }
    // All that one texel of an image of twice the size gives to smaller ones: a quarter of itself, over four times the area.
    let all: f64 = (-4..=4)
        .flat_map(|y| (-4..=4).map(move |x| (x, y)))
        .map(|(x, y)| {
            let lit = |px: f64, py: f64| f64::from(px.floor() == 0.0) * f64::from(py.floor() == 0.0);
            let sample = |dx: f64, dy: f64| {
                let at = [2.0 * f64::from(x) + dx, 2.0 * f64::from(y) + dy];
                let corners = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)];
                [corners.iter().map(|(cx, cy)| 0.25 * lit(at[0] + cx, at[1] + cy)).sum(), 0.0, 0.0]
            };
            shrunk(sample, false)[0]
        })
        .sum();
    assert!((all - 0.25).abs() < 1e-12, "{all}");
}

#[test]
fn calming_dims_a_single_bright_texel_and_leaves_an_even_image_alone() {
    let spark = |x: f64, y: f64| if (x, y) == (1.0, 1.0) { [1000.0; 3] } else { [0.1; 3] };
    assert!(shrunk(spark, true)[0] < 0.02 * shrunk(spark, false)[0]);
}
