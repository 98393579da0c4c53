//! Formulas over images: filters, scales, averages over time, and the filter of shadows.

use super::Unit::{Steps, Ulp};
use super::{Compared, Row, within};
use crate::drawn::filters::Image;
use crate::drawn::{bloom, filters, scale};
use framewright_passes::twin::accumulate::{self, accumulated};
use framewright_passes::twin::bloom::{mixed, shrunk, tent};
use framewright_passes::twin::filters::{blur, downsample, gauss};
use framewright_passes::twin::scale::{area, bilinear, sharpened};
use framewright_passes::twin::sun_shadow::uncovered;
use framewright_tests::render::{Setup, device, render, rgba};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

/// The largest number that `noise.frag` draws into each channel.
const BRIGHTEST: [f64; 4] = [1.0, 60000.0, 1000.0, 1.0];
/// How much the surface rises along rows and columns of the map in `filtered_shadow.frag`.
const SLOPE: [f64; 2] = [0.0625, -0.125];

/// Each texel of an image held against a formula of its place, in steps of the largest numbers.
fn texels<const N: usize>(image: &Image, expected: impl Fn(i32, i32) -> [f64; N]) -> Vec<Compared> {
    let places = (0..image.height).flat_map(|y| (0..image.width).map(move |x| (x, y)));
    let compared = places.flat_map(|(x, y)| {
        let expected = expected(x, y).into_iter().enumerate();
        expected.map(move |(at, expected)| (x, y, at, expected))
    });
    let compared =
        compared.map(|(x, y, at, expected)| Compared { found: image.at(x, y, at), expected, scale: BRIGHTEST[at] });
    compared.collect()
}

pub(super) fn rows() -> Result<Vec<Row>, Box<dyn Error>> {
    let mut rows = blurs()?;
    rows.extend(blooms()?);
    rows.extend(scales()?);
    rows.extend(averages()?);
    Ok(rows)
}

fn blurs() -> Result<Vec<Row>, Box<dyn Error>> {
    let Some(of) = filters::filtered("0.25")? else { return Ok(Vec::new()) };
    let halves = |x, y, channel| {
        downsample([(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| of.noise.at(2 * x + dx, 2 * y + dy, channel)))
    };
    let across = |x, y, channel| blur(|step| of.noise.at(x + step, y, channel));
    let mut far = Vec::new();
    for radius in ["0.25", "2.5", "64.0"] {
        let Some(of) = bloom::filtered(radius, "0.25")? else { return Ok(Vec::new()) };
        let radius = radius.parse()?;
        far.extend(texels(&of.blurred, |x, y| {
            [0, 1, 2, 3].map(|at| gauss(|step| of.noise.at(x, y + step, at), radius))
        }));
    }
    Ok(vec![
        Row::of(
            "filters::downsample",
            "noise 0 to 60,000",
            Ulp,
            within(55, 1),
            texels(&of.half, |x, y| [0, 1, 2, 3].map(|at| halves(x, y, at))),
        ),
        Row::of(
            "filters::blur",
            "noise 0 to 60,000",
            Ulp,
            // Nine weights: an exponential has 3 ulp and twice its argument, which is 2 at most.
            within(55, 1),
            texels(&of.across, |x, y| [0, 1, 2, 3].map(|at| across(x, y, at))),
        ),
        // As many as 129 taps, and as many weights.
        Row::of("filters::gauss", "noise 0 to 60,000, radius 0.25 to 64", Ulp, within(315, 1), far),
    ])
}

fn blooms() -> Result<Vec<Row>, Box<dyn Error>> {
    let Some(of) = bloom::filtered("1.0", "0.25")? else { return Ok(Vec::new()) };
    let shrink = |x: i32, y: i32, partial| {
        let middle = [x, y].map(|at| f64::from(2 * at + 1));
        shrunk(|dx, dy| of.noise.light(middle[0] + dx, middle[1] + dy), partial)
    };
    let all = [texels(&of.plain, |x, y| shrink(x, y, false)), texels(&of.calm, |x, y| shrink(x, y, true))].concat();
    let grown = texels(&of.grown, |x, y| {
        let middle = [x, y].map(|at| (f64::from(at) + 0.5) / 2.0);
        let around = tent(|dx, dy| of.plain.light(middle[0] + dx, middle[1] + dy), 1.0);
        mixed([0, 1, 2].map(|channel| of.noise.at(x, y, channel)), around, 0.25)
    });
    Ok(vec![
        Row::of("bloom::shrunk", "noise 0 to 60,000, calmed and not", Ulp, within(70, 2), all),
        Row::of("bloom::tent", "noise 0 to 60,000, a quarter mixed in", Ulp, within(35, 1), grown),
    ])
}

fn scales() -> Result<Vec<Row>, Box<dyn Error>> {
    let [mut of_area, mut of_curve, mut of_bilinear] = [Vec::new(), Vec::new(), Vec::new()];
    for size in ["0.25", "0.7", "1.5", "4"] {
        let extent = [37, 23];
        let Some([noise, _, linear, mean, curve, ..]) = scale::scaled(size, extent)? else { return Ok(Vec::new()) };
        let places = || (0..extent[1]).flat_map(|y| (0..extent[0]).map(move |x| [x, y]));
        for ([x, y], channel) in places().flat_map(|place| [0, 1].map(|channel| (place, channel))) {
            let texel = |x, y| noise.at(x, y, channel);
            let one = |image: &scale::Image, expected: f64| Compared {
                found: image.at(x.cast_signed(), y.cast_signed(), channel),
                expected,
                scale: 1.0,
            };
            of_area.push(one(&mean, area(texel, [x, y], noise.extent, extent)));
            of_curve.push(one(&curve, sharpened(texel, [x, y], noise.extent, extent).max(0.0)));
            of_bilinear.push(one(&linear, bilinear(texel, [x, y], noise.extent, extent)));
        }
    }
    Ok(vec![
        Row::of("scale::area", "noise 0 to 1, scales 0.25 to 4", Ulp, within(20, 2), of_area),
        Row::of("scale::sharpened", "noise 0 to 1, scales 0.25 to 4", Ulp, within(90, 2), of_curve),
        // Samplers move places to the nearest of 256 in a texel, and round the weights of both axes.
        Row::of("scale::bilinear", "noise 0 to 1, scales 0.25 to 4; the device's own filter", Steps, 4.0, of_bilinear),
    ])
}

fn averages() -> Result<Vec<Row>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(Vec::new()) };
    let scene = empty_scene();
    let [mut over_time, mut of_means, mut of_shadows] = [Vec::new(), Vec::new(), Vec::new()];
    for (share, taps) in [("0.0", 1), ("0.5", 2), ("0.95", 3), ("1.0", 5), ("-1.0", 7), ("2.0", 3)] {
        let width = taps.to_string();
        let set = [("share", share), ("taps", &*width)];
        let setup = Setup { pipeline: "tests/pipelines/accumulate.ron", set: &set, scene: &scene, extent: [8, 8] };
        let [now, before, averaged, shadowed, means] =
            <[_; 5]>::try_from(render(device, &setup)?).map_err(|_| "not five outputs")?.map(|output| rgba(&output));
        for ((now, before), found) in now.iter().zip(&before).zip(averaged) {
            let expected = accumulated([now[0], now[1], now[2]], *before, share.parse()?);
            let each =
                (0..4).map(|at| Compared { found: found[at], expected: expected[at], scale: now[at].max(before[at]) });
            over_time.extend(each);
        }
        for ((now, before), found) in now.iter().zip(&before).zip(means) {
            let expected = accumulate::averaged([now[0], now[1], now[2]], *before, taps.into());
            let scale = |at: usize| now[at].max(before[at]);
            of_means.extend((0..4).map(|at| Compared { found: found[at], expected: expected[at], scale: scale(at) }));
        }
        for [x, y, depth, found] in shadowed {
            let caster = |x: i32, y: i32| now[(y * 64 + x) as usize][0];
            of_shadows.push(Compared { found, expected: uncovered(caster, [x, y], depth, SLOPE, taps), scale: 1.0 });
        }
    }
    Ok(vec![
        Row::of(
            "accumulate::accumulated",
            "noise 0 to 60,000, shares −1 to 2, all of alpha",
            Ulp,
            within(5, 0),
            over_time,
        ),
        Row::of("accumulate::averaged", "noise 0 to 60,000, of 1 to 7 frames", Ulp, within(3, 1), of_means),
        Row::of(
            "sun_shadow::uncovered",
            "places and depths at random in noise, a slope, 1 to 7 taps",
            Ulp,
            within(70, 1),
            of_shadows,
        ),
    ])
}
