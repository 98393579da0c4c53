//! The tone mapping shaders are held against their twins over everything that an image can hold (IQ-21, NU-4, NU-5).

use framewright_passes::twin::radiance::guard_radiance;
use framewright_passes::twin::tone_mapping::{modified_reinhard, reinhard};
use framewright_tests::render::{Setup, device, render};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

/// Largest relative error of a 32-bit result. Vulkan allows a division 2.5 units in the last place, additions and
/// multiplications half a unit: nine units for the longer formula, of 2⁻²³ each at most.
const RELATIVE: f64 = 9.0 / 8_388_608.0;
/// Results below the smallest normal float may be flushed to zero.
const ABSOLUTE: f64 = f32::MIN_POSITIVE as f64;

/// Radiance that went in, and what modified and plain Reinhard made of it, for each channel of each texel.
fn mapped(exposure: &str, white_point: &str) -> Result<Option<Vec<[f32; 3]>>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let set = [("exposure", exposure), ("white_point", white_point)];
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/tone_mapping.ron", set: &set, scene: &scene, extent: [8, 8] };
    let outputs = render(device, &setup)?;
    let floats = |output: usize| -> Vec<f32> {
        let (words, _) = outputs[output].bytes.as_chunks::<4>();
        words.iter().map(|word| f32::from_ne_bytes(*word)).collect()
    };
    let [radiance, modified, plain] = [0, 1, 2].map(floats);
    let triples = radiance.into_iter().zip(modified).zip(plain).map(|((a, b), c)| [a, b, c]);
    // Every fourth is alpha.
    Ok(Some(triples.enumerate().filter(|(at, _)| at % 4 != 3).map(|(_, triple)| triple).collect()))
}

fn assert_close(found: f32, expected: f64, of: f32) {
    let bound = RELATIVE * expected + ABSOLUTE;
    assert!((f64::from(found) - expected).abs() <= bound, "{of:e} became {found:e} instead of {expected:e}");
}

#[test]
fn the_inputs_hold_every_kind_of_number() -> Result<(), Box<dyn Error>> {
    let Some(values) = mapped("1.0", "1.0")? else { return Ok(()) };
    let inputs = || values.iter().map(|[radiance, ..]| *radiance);
    assert_eq!(values.len(), 3 * 65536);
    assert!(inputs().any(|it| it == 0.0 && it.is_sign_negative()));
    assert!(inputs().any(f32::is_nan));
    assert!(inputs().any(|it| it.is_nan() && it.is_sign_negative()));
    assert!(inputs().any(|it| it == f32::INFINITY) && inputs().any(|it| it == f32::NEG_INFINITY));
    assert!(inputs().any(|it| it == 65504.0) && inputs().any(|it| it > 1e38) && inputs().any(|it| it == -65504.0));
    assert!(inputs().any(|it| it == 2_f32.powi(-24)), "the smallest half");
    Ok(())
}

#[test]
fn tone_mapping_on_the_gpu_is_its_twin() -> Result<(), Box<dyn Error>> {
    for white_point in ["1.0", "1.0000001", "4.0", "100.0", "1e30"] {
        let Some(values) = mapped("1.0", white_point)? else { return Ok(()) };
        for [radiance, modified, plain] in values {
            let guarded = guard_radiance(f64::from(radiance));
            assert_close(modified, modified_reinhard(guarded, white_point.parse()?), radiance);
            assert_close(plain, reinhard(guarded), radiance);
        }
    }
    Ok(())
}

#[test]
fn exposure_multiplies_radiance_before_the_curve() -> Result<(), Box<dyn Error>> {
    for exposure in ["0.0", "0.125", "2.0", "1e30", "-1.0"] {
        let Some(values) = mapped(exposure, "4.0")? else { return Ok(()) };
        for [radiance, modified, _] in values {
            // Drivers may flush numbers below the smallest normal float before they are multiplied.
            if radiance.is_subnormal() && modified == 0.0 {
                continue;
            }
            // Guarded twice: what is multiplied, and the product.
            let exposed = guard_radiance(guard_radiance(f64::from(radiance)) * exposure.parse::<f64>()?);
            assert_close(modified, modified_reinhard(exposed, 4.0), radiance);
        }
    }
    Ok(())
}

#[test]
fn every_result_lies_between_zero_and_one_and_zero_stays_zero() -> Result<(), Box<dyn Error>> {
    for white_point in ["0.0", "1.0", "100.0"] {
        let Some(values) = mapped("1.0", white_point)? else { return Ok(()) };
        for [radiance, modified, plain] in values {
            assert!((0.0..=1.0).contains(&modified) && (0.0..=1.0).contains(&plain), "{radiance}: {modified}, {plain}");
            if radiance == 0.0 {
                assert_eq!([modified, plain], [0.0, 0.0]);
            }
        }
    }
    Ok(())
}
