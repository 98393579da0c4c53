//! Formulas that need nothing but numbers: `formulas.frag` draws each for 65,536 random arguments, which are the same here bit
//! by bit.

use super::Unit::{Steps, Ulp};
use super::arguments::Arguments;
use super::{Compared, QUOTIENT, ROUNDING, Row, within};
use framewright_passes::scene::PointLight;
use framewright_passes::twin::radiance::{guard_alpha, guard_radiance, guard_signed};
use framewright_passes::twin::stereo::Part;
use framewright_passes::twin::tone_mapping::{filmic, modified_reinhard, neutral, reinhard, reinhard_luminance};
use framewright_passes::twin::{
    alpha_coverage, ambient_occlusion, cross_fade, distance, effects, exposure, g_buffer, hdr10, lighting, motion,
    overlay, scale, sun_shadow, temporal, weighted_resolve,
};
use framewright_tests::render::{Setup, device, render, rgba};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::Device;
use glam::{DVec2, DVec3};
use std::error::Error;

pub(super) const SIDE: u32 = 256;
const NEAR: f32 = 0.1;
const FAR: f32 = 50.0;

/// The results of a formula on the GPU, each held against the twin.
fn compared(
    device: &Device,
    formula: u32,
    twin: impl Fn(&Arguments, [f64; 4]) -> Vec<Compared>,
) -> Result<Vec<Compared>, Box<dyn Error>> {
    let number = formula.to_string();
    let mut scene = empty_scene();
    (scene.camera.near, scene.camera.far) = (NEAR, Some(FAR));
    let set = [("formula", &*number)];
    let setup = Setup { pipeline: "tests/pipelines/formulas.ron", set: &set, scene: &scene, extent: [8, 8] };
    let texels = rgba(&render(device, &setup)?[0]);
    Ok((0..).zip(texels).flat_map(|(at, found)| twin(&Arguments { at }, found)).collect())
}

/// Each number held against its own, in steps of its own size, or of another.
fn own(found: &[f64], expected: &[f64]) -> Vec<Compared> {
    found.iter().zip(expected).map(|(found, expected)| Compared::own(*found, *expected)).collect()
}

fn beside(found: &[f64], expected: &[f64], scale: f64) -> Vec<Compared> {
    own(found, expected).into_iter().map(|one| Compared { scale, ..one }).collect()
}

const LIGHT: &str = "light 2⁻²⁴ to 2¹⁶";

pub(super) fn rows() -> Result<Option<Vec<Row>>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let mut rows = tone(device)?;
    rows.extend(light(device)?);
    rows.extend(places(device)?);
    Ok(Some(rows))
}

fn tone(device: &Device) -> Result<Vec<Row>, Box<dyn Error>> {
    let curve = |formula, name, allowed, curve: fn(f64) -> f64| -> Result<Row, Box<dyn Error>> {
        let all = compared(device, formula, |of, found| own(&found[..3], &of.light(0).map(curve)))?;
        Ok(Row::of(name, LIGHT, Ulp, allowed, all))
    };
    Ok(vec![
        curve(0, "tone_mapping::reinhard", within(1, 1), reinhard)?,
        Row::of(
            "tone_mapping::modified_reinhard",
            "light 2⁻²⁴ to 2¹⁶, white points 1 to 2¹⁰⁰",
            Ulp,
            within(4, 3),
            compared(device, 1, |of, found| {
                own(&found[..3], &of.light(0).map(|light| modified_reinhard(light, of.wide(3, 0, 100))))
            })?,
        ),
        curve(2, "tone_mapping::filmic", within(12, 1), filmic)?,
        Row::of(
            "tone_mapping::neutral",
            LIGHT,
            Steps,
            // Some 25 roundings and 3 quotients of numbers up to 1.
            255.0 * 40.0 * ROUNDING,
            compared(device, 3, |of, found| own(&found[..3], &neutral(of.light(0))))?,
        ),
        Row::of(
            "tone_mapping::reinhard_luminance",
            LIGHT,
            Ulp,
            within(9, 1),
            compared(device, 27, |of, found| own(&found[..3], &reinhard_luminance(of.light(0))))?,
        ),
        Row::of(
            "hdr10::encode_pq",
            "0 to 1, and 2⁻⁶⁰ to 1",
            Steps,
            // Logarithms of numbers from 0.5 to 1 may be off by 2⁻²¹, and a quotient in them by 2.5 ulp, 79 times as much: 9e-5.
            0.023,
            compared(device, 4, |of, found| {
                own(&found[..2], &[hdr10::encode_pq(of.even(0)), hdr10::encode_pq(of.wide(1, -60, 0))])
            })?,
        ),
        Row::of(
            "hdr10::encode_hdr10",
            "light 2⁻²⁴ to 2¹⁶, white at 203 cd/m²",
            Steps,
            // As encode_pq.
            0.024,
            compared(device, 5, |of, found| own(&found[..3], &hdr10::encode_hdr10(of.light(0), 203.0)))?,
        ),
        Row::of(
            "exposure::luminance",
            LIGHT,
            Ulp,
            within(8, 0),
            compared(device, 6, |of, found| own(&found[..1], &[exposure::luminance(of.light(0))]))?,
        ),
        Row::of(
            "exposure::place_of",
            "luminance 2⁻³⁰ to 2¹⁶; a step is a bin",
            Steps,
            // Eight times 3 ulp of a logarithm up to 16, and two roundings.
            6e-5,
            compared(device, 7, |of, found| {
                let place = exposure::place_of(of.wide(0, -30, 16));
                // How far outside of the bin that was found, which ends a whole number later.
                let outside = (found[0] - place).max(place - (found[0] + 1.0)).max(0.0);
                own(&[outside / 255.0], &[0.0])
            })?,
        ),
        Row::of(
            "weighted_resolve::compressed",
            LIGHT,
            Ulp,
            within(2, 1),
            compared(device, 19, |of, found| own(&found[..3], &weighted_resolve::compressed(of.light(0))))?,
        ),
        Row::of(
            "weighted_resolve::expanded",
            "colours 0 to 65504/65505, expanded, and compressed in 64 bits",
            Steps,
            // Some 10 roundings, a quotient, and its tone mapping.
            255.0 * 20.0 * ROUNDING,
            compared(device, 28, |of, found| {
                let color = of.even3(0).map(|channel| 65504.0 / 65505.0 * channel);
                let light = weighted_resolve::expanded(color);
                let [found, expected] = [[found[0], found[1], found[2]], light].map(weighted_resolve::compressed);
                own(&found, &expected)
            })?,
        ),
        Row::of(
            "temporal::mixed",
            "light 2⁻²⁴ to 2¹⁶, shares 0 to 1",
            Ulp,
            within(9, 3),
            compared(device, 20, |of, found| own(&found[..3], &temporal::mixed(of.light(0), of.light(3), of.even(6))))?,
        ),
        Row::of(
            "temporal::allowed_history",
            "light 0 to 1, one standard deviation, allowances 0 to 0.25",
            Ulp,
            // Means and deviations of nine colours: some 26 and 64 roundings, and the way back to light, which has up to four times as much.
            220.0,
            compared(device, 25, |of, found| {
                let around = [0, 1, 2, 3, 4, 5, 6, 7, 8].map(|number| of.even3(3 * number));
                let allowance = 0.25 * of.even(30);
                beside(&found[..3], &temporal::allowed_history(of.even3(27), &around, 1.0, allowance), 1.0)
            })?,
        ),
        Row::of(
            "temporal::change_allowed",
            "changes 0 to 1, 0 to 2 texels a frame; share_after too",
            Ulp,
            within(4, 2),
            compared(device, 26, |of, found| {
                let allowed = temporal::change_allowed(of.even(0), 0.5 * of.even(1));
                let share = temporal::share_after(0.01 + of.even(2), 0.25 * of.even(3), 2.0 * of.even(4));
                beside(&found[..2], &[allowed, share], 1.0)
            })?,
        ),
    ])
}

fn light(device: &Device) -> Result<Vec<Row>, Box<dyn Error>> {
    let light = |range| PointLight { position: [0.0; 3], color: [1.0; 3], intensity: 1.0, range, shadows: false };
    Ok(vec![
        Row::of(
            "radiance::guard_radiance",
            "every kind of 32-bit number; guard_signed and guard_alpha too",
            Ulp,
            0.0,
            compared(device, 23, |of, found| {
                let [a, b, c] = [0, 1, 2].map(|which| of.float(which));
                own(&found[..3], &[guard_radiance(a), guard_signed(b), guard_alpha(c)])
            })?,
        ),
        Row::of(
            "alpha_coverage::covered_by",
            "alpha, cutoff and width 0 to 1",
            Ulp,
            // A quotient up to 0.5, and a rounding.
            2.0,
            compared(device, 8, |of, found| {
                let [alpha, cutoff, width] = of.even3(0);
                let expected = alpha_coverage::covered_by(alpha, cutoff, width);
                beside(&found[..1], &[expected], 1.0)
            })?,
        ),
        Row::of(
            "cross_fade::fades_out",
            "shares −1 to 1, 256 × 256 pixels; fade_threshold too",
            Ulp,
            QUOTIENT,
            compared(device, 9, |of, found| {
                let pixel = of.texel();
                let fades = f64::from(u8::from(cross_fade::fades_out(2.0 * of.even(0) - 1.0, pixel)));
                own(&found[..2], &[cross_fade::fade_threshold(pixel), fades])
            })?,
        ),
        Row::of(
            "random::random",
            "65,536 whole numbers",
            Ulp,
            QUOTIENT,
            compared(device, 10, |of, found| own(&found[..3], &of.even3(0)))?,
        ),
        Row::of(
            "effects::grain",
            "256 × 256 pixels",
            Ulp,
            // Two quotients and two sums below 2.
            4.0,
            compared(device, 10, |of, found| beside(&found[3..], &[effects::grain(of.texel(), 7)], 1.0))?,
        ),
        Row::of(
            "effects::stripe",
            "distances of 1/16 to 16 periods",
            Steps,
            // A sine may be off by 2⁻¹¹, twice over since it is squared; a phase up to 16 has three quotients.
            0.27,
            compared(device, 11, |of, found| own(&found[..1], &[stripe(of.wide(0, -4, 4))]))?,
        ),
        Row::of(
            "effects::stripe",
            "distances of 16 to 32,768 periods",
            Steps,
            // The same with a phase up to 32,768.
            32.0,
            compared(device, 11, |of, found| own(&found[1..2], &[stripe(of.wide(1, 4, 15))]))?,
        ),
        Row::of(
            "sun_shadow::faded",
            "uncovered 0 to 1, 0.8 to 1.05 of the reach",
            Ulp,
            // A rounding of the distance, ten times as much, and a quotient.
            1.5,
            compared(device, 29, |of, found| {
                let expected = sun_shadow::faded(of.even(0), 0.8 + 0.25 * of.even(1));
                // The distance from the end of the reach is taken from 1, and is a tenth of it at most.
                beside(&found[..1], &[expected], 10.0)
            })?,
        ),
        Row::of(
            "lighting::highlight",
            "all directions",
            Steps,
            // The 64th power of a cosine: a logarithm off by 2⁻²¹, and its argument by some 14 roundings.
            0.2,
            compared(device, 14, |of, found| {
                own(&found[..1], &[lighting::highlight(of.unit(0), of.unit(3), of.unit(6))])
            })?,
        ),
        Row::of(
            "lighting::falloff",
            "squared distances 2⁻²⁰ to 2²⁰ m² without range, to 1 m² with a range of 1 m",
            Ulp,
            within(3, 1),
            compared(device, 15, |of, found| {
                let squared = [of.wide(0, -20, 20), of.wide(1, -20, 0)];
                let expected =
                    [light(None).falloff(squared[0].sqrt(), 0.01), light(Some(1.0)).falloff(squared[1].sqrt(), 0.01)];
                let scale = squared[1].max(1e-4).recip();
                [own(&found[..1], &expected[..1]), beside(&found[1..2], &expected[1..], scale)].concat()
            })?,
        ),
        Row::of(
            "ambient_occlusion::occlusion_by",
            "places within the radius; as a share of what one touching it would count",
            Ulp,
            // A squared distance of 10 roundings, to the third power, times a rise of 20.
            100.0,
            compared(device, 22, |of, found| {
                let towards = DVec3::from(of.even3(0));
                let expected = ambient_occlusion::occlusion_by(towards, of.unit(3), 1.0, 1.0);
                beside(&found[..1], &[expected], (towards.length_squared() + 1e-4).recip())
            })?,
        ),
        Row::of(
            "ambient_occlusion::spiral_turn",
            "256 × 256 texels",
            Ulp,
            QUOTIENT,
            compared(device, 22, |of, found| {
                own(&found[2..3], &[ambient_occlusion::spiral_turn(of.texel().map(u32::cast_signed))])
            })?,
        ),
    ])
}

/// Of a near distance of 0.1 m, and a period of 1 m.
fn stripe(periods: f64) -> f64 {
    effects::stripe(0.1 / periods, 0.1, 1.0)
}

/// Of an image or of a part.
fn two_places(of: &Arguments) -> [[f64; 2]; 2] {
    [[of.even(4), of.even(5)], [of.even(6), of.even(7)]]
}

fn places(device: &Device) -> Result<Vec<Row>, Box<dyn Error>> {
    let (near, far) = (f64::from(NEAR), f64::from(FAR));
    Ok(vec![
        Row::of(
            "g_buffer::octahedral",
            "all directions",
            Ulp,
            // A direction of 8 roundings, a sum of three, and a quotient.
            13.0,
            compared(device, 12, |of, found| beside(&found[..2], &g_buffer::octahedral(of.unit(0)).to_array(), 1.0))?,
        ),
        Row::of(
            "g_buffer::from_octahedral",
            "all directions, there and back",
            Ulp,
            // The same three times over, of numbers that add up, brought back to length 1.
            60.0,
            compared(device, 13, |of, found| beside(&found[..3], &of.unit(0).to_array(), 1.0))?,
        ),
        Row::of(
            "motion::motion",
            "places in the picture",
            Ulp,
            // Half the difference of two quotients up to 1.
            3.0,
            compared(device, 16, |of, found| {
                let place = |which| {
                    let [x, y, w] = of.even3(which);
                    DVec2::new(2.0 * x - 1.0, 2.0 * y - 1.0) / (1.0 + w) * 0.5
                };
                beside(&found[..2], &motion::motion(place(0), Some(place(3))).to_array(), 1.0)
            })?,
        ),
        Row::of(
            "overlay::shade_of_distance",
            "depth 2⁻²⁰ to 1",
            Ulp,
            within(2, 1),
            compared(device, 17, |of, found| {
                own(&found[..1], &[overlay::shade_of_distance(of.wide(0, -20, 0), 0.1, 20.0)])
            })?,
        ),
        Row::of(
            "overlay::shade_of_signed",
            "−1 to 1",
            Ulp,
            0.0,
            compared(device, 17, |of, found| {
                beside(&found[1..], &of.even3(1).map(|it| overlay::shade_of_signed(2.0 * it - 1.0, 1.0)), 1.0)
            })?,
        ),
        Row::of(
            "distance::infinite_depth",
            "depth 2⁻²⁰ to 1, planes at 0.1 and 50 m",
            Ulp,
            within(20, 2),
            compared(device, 18, |of, found| {
                own(&found[..2], &[near, distance::infinite_depth(of.wide(0, -20, 0), near, Some(far))])
            })?,
        ),
        Row::of(
            "scale::catmull_rom",
            "−2 to 2",
            Ulp,
            // Some 6 roundings of numbers up to 4.
            8.0,
            compared(device, 21, |of, found| beside(&found[..1], &[scale::catmull_rom(4.0 * of.even(0) - 2.0)], 1.0))?,
        ),
        Row::of(
            "stereo::screen_uv",
            "places in the right eye's picture, Part::half; screen_pos too",
            Ulp,
            // A quotient up to 1, of a sum of three.
            4.0,
            compared(device, 24, |of, found| {
                let [x, y, w] = of.even3(0);
                let half = Part::half(true);
                let clip = [2.0 * x - 1.0, 2.0 * y - 1.0, 0.0, 1.0 + 3.0 * w];
                let ([a, b], [c, d]) = (half.screen_uv([x, y]), half.screen_pos(clip));
                beside(&found, &[a, b, c, d], 1.0)
            })?,
        ),
        Row::of(
            "stereo::screen_uv",
            "two places at once, in parts at random",
            Ulp,
            // A product, a sum, and the part itself.
            2.0,
            compared(device, 31, |of, found| {
                let [one, other] = two_places(of);
                let ([a, b], [c, d]) = (of.part(0).screen_uv(one), of.part(0).screen_uv(other));
                beside(&found, &[a, b, c, d], 1.0)
            })?,
        ),
        Row::of(
            "stereo::own_uv",
            "places in an image, of parts of a 16th and more",
            Ulp,
            // A quotient of a difference.
            3.0,
            compared(device, 32, |of, found| beside(&found[..2], &of.part(0).own_uv(two_places(of)[0]), 16.0))?,
        ),
        Row::of(
            "stereo::nearest_within",
            "two places at once, in parts at random of images of 1 to 4,096 texels",
            Ulp,
            // A quotient, and the ends of the part.
            4.0,
            compared(device, 30, |of, found| {
                let texels = [1 + of.bits(8) % 4096, 1 + of.bits(9) % 64];
                let [[a, b], [c, d]] = two_places(of).map(|place| of.part(0).nearest_within(place, texels));
                beside(&found, &[a, b, c, d], 1.0)
            })?,
        ),
    ])
}
