//! Each operator of tone mapping is held against its twin over everything that an image can hold (IQ-21, NU-4, NU-5).

use framewright_passes::twin::radiance::guard_radiance;
use framewright_passes::twin::tone_mapping::{filmic, modified_reinhard, neutral, reinhard, reinhard_luminance};
use framewright_tests::render::{Setup, device, render, rgb};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

/// Half a thousandth of an 8-bit step: some twelve roundings of numbers up to 1.
const BOUND: f64 = 2e-6;

/// Numbers of operators as in `include/tone_mapping.glsl`.
const OPERATORS: [(&str, Operator); 6] = [
    ("0", |light, _| light.map(|channel| channel.min(1.0))),
    ("1", |light, _| light.map(reinhard)),
    ("2", |light, white_point| light.map(|channel| modified_reinhard(channel, white_point))),
    ("3", |light, _| light.map(filmic)),
    ("4", |light, _| neutral(light)),
    ("5", |light, _| reinhard_luminance(light)),
];

/// Light and a white point to what is shown.
type Operator = fn([f64; 3], f64) -> [f64; 3];

/// Radiance that went in, and what was shown of it.
type Texels = Vec<[[f64; 3]; 2]>;

fn shown(operator: &str, exposure: &str, white_point: &str) -> Result<Option<Texels>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let set = [("operator", operator), ("exposure", exposure), ("white_point", white_point)];
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/tone_mapping.ron", set: &set, scene: &scene, extent: [8, 8] };
    let outputs = render(device, &setup)?;
    let texels = |output: usize| rgb(&outputs[output]);
    Ok(Some(texels(0).into_iter().zip(texels(3)).map(|(light, found)| [light, found]).collect()))
}

#[test]
fn every_operator_on_the_gpu_is_its_twin() -> Result<(), Box<dyn Error>> {
    for (number, operator) in OPERATORS {
        for (exposure, white_point) in
            [("1.0", "4.0"), ("0.125", "100.0"), ("1e30", "1.0"), ("1.0", "1.0000001"), ("1.0", "1e30")]
        {
            let Some(texels) = shown(number, exposure, white_point)? else { return Ok(()) };
            for [light, found] in texels {
                let exposed = light.map(|channel| {
                    let channel = guard_radiance(channel);
                    // Drivers may flush numbers below the smallest normal float before they are multiplied.
                    let kept = if channel < f64::from(f32::MIN_POSITIVE) { [0.0, channel] } else { [channel; 2] };
                    kept.map(|channel| guard_radiance(channel * exposure.parse::<f64>().unwrap_or(f64::NAN)))
                });
                let white_point = white_point.parse()?;
                let either = [0, 1].map(|kept| operator(exposed.map(|channel| channel[kept]), white_point));
                let close = |expected: &[f64; 3]| (0..3).all(|at| (found[at] - expected[at]).abs() <= BOUND);
                assert!(
                    either.iter().any(close),
                    "operator {number}: {light:?} became {found:?} instead of {either:?}"
                );
            }
        }
    }
    Ok(())
}

#[test]
fn whatever_goes_in_every_operator_gives_zero_to_one_and_leaves_zero_at_zero() -> Result<(), Box<dyn Error>> {
    for (number, _) in OPERATORS {
        for exposure in ["1.0", "1e30", "-1.0"] {
            let Some(texels) = shown(number, exposure, "100.0")? else { return Ok(()) };
            for [light, found] in texels {
                assert!(found.iter().all(|channel| (0.0..=1.0).contains(channel)), "{number}: {light:?}: {found:?}");
                let black = light.map(guard_radiance) == [0.0; 3];
                assert!(!black || found == [0.0; 3], "{number}: {light:?}: {found:?}");
            }
        }
    }
    Ok(())
}

#[test]
fn off_is_the_identity_up_to_white_bit_for_bit() -> Result<(), Box<dyn Error>> {
    let Some(texels) = shown("0", "1.0", "1.0")? else { return Ok(()) };
    for [light, found] in texels {
        for channel in 0..3 {
            let guarded = guard_radiance(light[channel]);
            // Denormals may be flushed.
            let flushed = guarded < f64::from(f32::MIN_POSITIVE) && found[channel] == 0.0;
            assert!(flushed || found[channel] == guarded.min(1.0), "{light:?} became {found:?}");
        }
    }
    Ok(())
}

#[test]
fn a_number_that_names_no_operator_cuts_off() -> Result<(), Box<dyn Error>> {
    let Some(off) = shown("0", "1.0", "1.0")? else { return Ok(()) };
    for number in ["-1", "6"] {
        let Some(found) = shown(number, "1.0", "1.0")? else { return Ok(()) };
        assert!(found.iter().zip(&off).all(|(found, off)| found[1] == off[1]), "{number}");
    }
    Ok(())
}
