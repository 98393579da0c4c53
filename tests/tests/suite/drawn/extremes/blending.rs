//! Light that no format holds, in what no shader guards: stores, averages of samples, and blends. Filters, resolves by shaders
//! and tone mappers stand in `shipped_numbers`, `bloom`, `resolves` and `tone_mapping_operators`.

use super::outputs;
use framewright_graph::vulkan::Format::{self, *};
use framewright_graph::vulkan::Usage;
use framewright_passes::twin::radiance::{LARGEST_HALF, guard_radiance};
use framewright_tests::render::{device, floats};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const SIDE: usize = 16;
/// As in `hdr_values.frag`.
const VALUES: [f64; SIDE] = [
    0.0,
    -0.0,
    1.401_298_464_324_817e-45,
    5.960_464_477_539_063e-8,
    0.5,
    1.0,
    100.0,
    65504.0,
    65520.0,
    1e6,
    1e38,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    -1.0,
    -65520.0,
];

fn value(x: usize, y: usize, shift: usize) -> f64 {
    VALUES[(x + y * shift) % SIDE]
}

/// The red channel of each output of a pipeline of these images and passes, 16 × 16 texels each.
fn red(images: &str, passes: &str, shown: &str) -> Result<Option<Vec<f64>>, Box<dyn Error>> {
    let text = format!(
        r#"Pipeline(
            version: 1,
            images: [{images} (name: "seen", format: R32G32B32A32_SFLOAT, size: Output)],
            passes: [{passes}
                (name: "see", draw: FullScreen("copy"), sample: {{"source": (image: "{shown}", filter: Nearest)}}, color: ["seen"]),
            ],
            outputs: ["seen"],
        )"#
    );
    let shown = outputs(&text, &empty_scene(), [SIDE as u32; 2])?;
    Ok(shown.map(|shown| floats(&shown[0]).into_iter().step_by(4).collect()))
}

fn drawn(target: &str, shift: usize, by_sample: usize) -> String {
    format!(
        r#"(name: "draw_{target}", draw: FullScreen("hdr_values"), color: ["{target}"],
            params: {{"shift": {shift}, "guarded": true, "by_sample": {by_sample}}}),"#
    )
}

/// The same numbers as they are, as a user's shader may store them.
fn drawn_unguarded(target: &str, shift: usize, by_sample: usize) -> String {
    drawn(target, shift, by_sample).replace(r#""guarded": true"#, r#""guarded": false"#)
}

/// What `copy` makes of a number that was stored in half floats. In these no driver holds what is beyond the largest: one stores the
/// largest, another infinity or NaN.
fn demand_read(found: f64, expected: f64, rounding: f64, of: &str) {
    let is_held = expected.abs() <= LARGEST_HALF;
    let close = (found - expected).abs() <= rounding * expected.abs() + 2_f64.powi(-24);
    let beyond = found.abs() == LARGEST_HALF || found == 0.0;
    assert!(if is_held { close } else { beyond }, "{of}: {found:e}, not {expected:e}");
}

/// NU-4: what a shipped shader stores is in every format of colour the nearest of the numbers that this holds, or the next one
/// towards 0, and never more than that.
#[test]
fn every_format_of_colour_holds_guarded_light_up_to_its_largest_number() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut drawn_to = 0;
    for format in Format::ALL.iter().copied().filter(|format| !format.is_depth() && !format.is_integer()) {
        let support = device.profile().format(format).cloned();
        if !support.is_some_and(|it| it.samples.contains(&1) && it.usage.contains(Usage::SAMPLED)) {
            continue;
        }
        drawn_to += 1;
        // The largest number, the share of a number that a step is, and the smallest step.
        let (largest, share, least) = match format {
            R32_SFLOAT | R32G32_SFLOAT | R32G32B32A32_SFLOAT => (LARGEST_HALF, 0.0, f64::from(f32::MIN_POSITIVE)),
            R16_SFLOAT | R16G16_SFLOAT | R16G16B16A16_SFLOAT => (LARGEST_HALF, 1.0 / 1024.0, 2_f64.powi(-24)),
            B10G11R11_UFLOAT_PACK32 => (65024.0, 1.0 / 64.0, 2_f64.powi(-20)),
            E5B9G9R9_UFLOAT_PACK32 => (65408.0, 1.0 / 256.0, 2_f64.powi(-24)),
            R16_UNORM | R16G16_UNORM | R16G16B16A16_UNORM => (1.0, 0.0, 1.0 / 65535.0),
            R16_SNORM | R16G16_SNORM | R16G16B16A16_SNORM => (1.0, 0.0, 1.0 / 32767.0),
            A2R10G10B10_UNORM_PACK32 | A2B10G10R10_UNORM_PACK32 => (1.0, 0.0, 1.0 / 1023.0),
            R8G8B8A8_SRGB | B8G8R8A8_SRGB => (1.0, 0.02, 1.0 / 255.0),
            R8_UNORM | R8G8_UNORM | R8G8B8A8_UNORM | B8G8R8A8_UNORM => (1.0, 0.0, 1.0 / 255.0),
            R8_SNORM | R8G8_SNORM | R8G8B8A8_SNORM => (1.0, 0.0, 1.0 / 127.0),
            other => return Err(format!("{} is no format of this test", other.name()).into()),
        };
        let format = format.name();
        let images = format!(r#"(name: "stored", format: {format}, size: Output),"#);
        let Some(found) = red(&images, &drawn("stored", 1, 0), "stored")? else { return Ok(()) };
        for (at, found) in found.into_iter().enumerate() {
            let value = value(at % SIDE, at / SIDE, 1);
            let expected = guard_radiance(value).min(largest);
            let close = (found - expected).abs() <= share * expected + least;
            assert!(close && found <= largest, "{format}: {value:e} is stored as {found:e}, not {expected:e}");
        }
    }
    assert!(drawn_to >= 10, "{drawn_to} formats");
    Ok(())
}

/// NU-4: the plain average of guarded samples is their mean: in half floats the sum of four of 65,504 overflows nothing.
#[test]
fn the_plain_average_of_samples_is_their_mean_up_to_the_largest_half() -> Result<(), Box<dyn Error>> {
    for (format, rounding) in [("R16G16B16A16_SFLOAT", 1.0 / 1024.0), ("R32G32B32A32_SFLOAT", 1e-6)] {
        for by_sample in [1, 4, 5, 16] {
            let images = format!(r#"(name: "samples", format: {format}, size: Output, samples: 4),"#);
            let Some(found) = red(&images, &drawn("samples", 3, by_sample), "samples")? else { return Ok(()) };
            for (at, found) in found.into_iter().enumerate() {
                let samples = [0, 1, 2, 3].map(|it| guard_radiance(value(at % SIDE + it * by_sample, at / SIDE, 3)));
                let expected = samples.iter().sum::<f64>() / 4.0;
                let close = (found - expected).abs() <= rounding * expected + 2_f64.powi(-24);
                assert!(close, "{format}: {samples:?} became {found:e}, not {expected:e}");
            }
        }
    }
    Ok(())
}

/// NU-4: a blend adds after the shader's guard, so it may overflow a half float; what is read of it next is the sum as far as a
/// half float holds it. Beyond that it is the largest half, or, on a driver whose conversion makes NaN of what is too large, 0.
#[test]
fn blends_are_read_as_their_sum_as_far_as_a_half_float_holds_it() -> Result<(), Box<dyn Error>> {
    for blend in ["Additive", "Premultiplied", "Alpha"] {
        for (format, rounding) in [("R16G16B16A16_SFLOAT", 1.0 / 1024.0), ("R32G32B32A32_SFLOAT", 1e-6)] {
            let images = format!(r#"(name: "sum", format: {format}, size: Output),"#);
            let second = drawn("sum", 3, 0)
                .replace("draw_sum", "again")
                .replace(r#"color: ["sum"]"#, &format!(r#"color: [(image: "sum", blend: {blend})]"#));
            let passes = drawn("sum", 1, 0) + &second;
            let Some(found) = red(&images, &passes, "sum")? else { return Ok(()) };
            let mut beyond = Vec::new();
            for (at, found) in found.into_iter().enumerate() {
                let [old, new] = [1, 3].map(|shift| guard_radiance(value(at % SIDE, at / SIDE, shift)));
                // Alpha is 1.
                let sum = if blend == "Additive" { old + new } else { new };
                if sum > LARGEST_HALF {
                    beyond.push(found);
                    continue;
                }
                let close = (found - sum).abs() <= rounding * sum + 2_f64.powi(-24);
                assert!(close, "{format}, {blend}: {old:e} and {new:e} are read as {found:e}, not {sum:e}");
            }
            assert_eq!(beyond.is_empty(), blend != "Additive");
            assert!(
                beyond.iter().all(|found| *found == LARGEST_HALF || *found == 0.0),
                "{format}, {blend}: {beyond:?}"
            );
            println!("{format}, {blend}: beyond the largest half {:?}", beyond.first());
        }
    }
    Ok(())
}

/// NU-4: numbers that no shader guards are stored and read as they are where the format holds them. What it doesn't hold is read as the
/// largest half, or as 0 where a driver stores NaN; nothing that isn't finite comes out of a shipped shader.
#[test]
fn unguarded_numbers_are_read_as_they_are_or_as_the_largest_or_0() -> Result<(), Box<dyn Error>> {
    for (format, rounding) in [("R16G16B16A16_SFLOAT", 1.0 / 1024.0), ("R32G32B32A32_SFLOAT", 0.0)] {
        let images = format!(r#"(name: "stored", format: {format}, size: Output),"#);
        let Some(found) = red(&images, &drawn_unguarded("stored", 1, 0), "stored")? else { return Ok(()) };
        for (at, found) in found.into_iter().enumerate() {
            let value = value(at % SIDE, at / SIDE, 1);
            let expected = if value.is_nan() { 0.0 } else { value };
            demand_read(found, expected, rounding, &format!("{format}, {value:e}"));
        }
    }
    Ok(())
}

/// NU-4: the plain average of unguarded samples is their mean where all of them, and it, are held; else what is read of it is finite.
#[test]
fn unguarded_samples_are_averaged_or_leave_something_finite() -> Result<(), Box<dyn Error>> {
    for (format, rounding) in [("R16G16B16A16_SFLOAT", 1.0 / 512.0), ("R32G32B32A32_SFLOAT", 1e-6)] {
        for by_sample in [1, 5] {
            let images = format!(r#"(name: "samples", format: {format}, size: Output, samples: 4),"#);
            let Some(found) = red(&images, &drawn_unguarded("samples", 3, by_sample), "samples")? else {
                return Ok(());
            };
            for (at, found) in found.into_iter().enumerate() {
                let samples = [0, 1, 2, 3].map(|it| value(at % SIDE + it * by_sample, at / SIDE, 3));
                let mean = samples.iter().sum::<f64>() / 4.0;
                let largest = samples.iter().fold(0.0_f64, |most, one| most.max(one.abs()));
                if samples.iter().all(|one| one.abs() <= LARGEST_HALF) {
                    let close = (found - mean).abs() <= rounding * largest + 2_f64.powi(-24);
                    assert!(close, "{format}: {samples:?} became {found:e}, not {mean:e}");
                }
                assert!(found.abs() <= LARGEST_HALF, "{format}: {samples:?} became {found:e}");
            }
        }
    }
    Ok(())
}

/// NU-4: so it is with a sum of what is unguarded.
#[test]
fn unguarded_sums_are_read_as_they_are_or_as_the_largest_or_0() -> Result<(), Box<dyn Error>> {
    for (format, share) in [("R16G16B16A16_SFLOAT", 1.0 / 512.0), ("R32G32B32A32_SFLOAT", 1e-6)] {
        let images = format!(r#"(name: "sum", format: {format}, size: Output),"#);
        let second = drawn_unguarded("sum", 3, 0)
            .replace("draw_sum", "again")
            .replace(r#"color: ["sum"]"#, r#"color: [(image: "sum", blend: Additive)]"#);
        let passes = drawn_unguarded("sum", 1, 0) + &second;
        let Some(found) = red(&images, &passes, "sum")? else { return Ok(()) };
        for (at, found) in found.into_iter().enumerate() {
            let [old, new] = [1, 3].map(|shift| value(at % SIDE, at / SIDE, shift));
            if old.abs() <= LARGEST_HALF && new.abs() <= LARGEST_HALF {
                // One that is stored first is rounded, and so is the sum.
                let rounding = (old.abs() + new.abs()) * share;
                let sum = old + new;
                let close = (found - sum).abs() <= rounding + 2_f64.powi(-23);
                let beyond = sum.abs() > LARGEST_HALF && (found.abs() == LARGEST_HALF || found == 0.0);
                let held = if sum.abs() > LARGEST_HALF { beyond } else { close };
                assert!(held, "{format}: {old:e} and {new:e} are read as {found:e}");
            }
            assert!(found.abs() <= LARGEST_HALF, "{format}: {old:e} and {new:e} are read as {found:e}");
        }
    }
    Ok(())
}
