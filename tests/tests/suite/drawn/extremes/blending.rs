//! Light that no format holds, in what no shader guards: stores, averages of samples, and blends. Filters, resolves by shaders
//! and tone mappers stand in `shipped_numbers`, `bloom`, `resolves` and `tone_mapping_operators`.

use super::outputs;
use framewright_passes::twin::radiance::{LARGEST_HALF, guard_radiance};
use framewright_tests::render::floats;
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

/// NU-4: what a shipped shader stores is in every format of colour the nearest of the numbers that this holds, or the next one
/// towards 0, and never more than that.
#[test]
fn every_format_of_colour_holds_guarded_light_up_to_its_largest_number() -> Result<(), Box<dyn Error>> {
    // The largest number, the share of a number that a step is, and the smallest step.
    for (format, largest, share, least) in [
        ("R32G32B32A32_SFLOAT", LARGEST_HALF, 0.0, f64::from(f32::MIN_POSITIVE)),
        ("R16G16B16A16_SFLOAT", LARGEST_HALF, 1.0 / 1024.0, 2_f64.powi(-24)),
        ("B10G11R11_UFLOAT_PACK32", 65024.0, 1.0 / 64.0, 2_f64.powi(-20)),
        ("R8G8B8A8_UNORM", 1.0, 0.0, 1.0 / 255.0),
        ("R8G8B8A8_SRGB", 1.0, 0.02, 1.0 / 255.0),
    ] {
        let images = format!(r#"(name: "stored", format: {format}, size: Output),"#);
        let Some(found) = red(&images, &drawn("stored", 1, 0), "stored")? else { return Ok(()) };
        for (at, found) in found.into_iter().enumerate() {
            let value = value(at % SIDE, at / SIDE, 1);
            let expected = guard_radiance(value).min(largest);
            let close = (found - expected).abs() <= share * expected + least;
            assert!(close && found <= largest, "{format}: {value:e} is stored as {found:e}, not {expected:e}");
        }
    }
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
