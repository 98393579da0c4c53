//! HDR10's signal is held against its twin over everything that an image can hold (NU-4, NU-5), and the twin against the
//! standards' own figures.

use framewright_passes::twin::hdr10::{PQ_PEAK, decode_pq, encode_hdr10, encode_pq};
use framewright_passes::twin::radiance::guard_radiance;
use framewright_tests::render::{Setup, device, render};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

/// A sixteenth of a step of 10 bits. A power of 79 magnifies the error of a logarithm, which Vulkan allows to be 2⁻²¹ between
/// 0.5 and 2, to 3·10⁻⁵.
const BOUND: f64 = 1.0 / 1023.0 / 16.0;

/// Radiance that went in, and the signal, texel by texel.
type Signals = Vec<[[f32; 4]; 2]>;

fn signals(reference_white: &str) -> Result<Option<Signals>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let set = [("reference_white", reference_white)];
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/hdr10.ron", set: &set, scene: &scene, extent: [8, 8] };
    let outputs = render(device, &setup)?;
    let texels = |output: usize| -> Vec<[f32; 4]> {
        let (words, _) = outputs[output].bytes.as_chunks::<4>();
        let floats: Vec<f32> = words.iter().map(|word| f32::from_ne_bytes(*word)).collect();
        floats.as_chunks::<4>().0.to_vec()
    };
    Ok(Some(texels(0).into_iter().zip(texels(1)).map(|(radiance, signal)| [radiance, signal]).collect()))
}

#[test]
fn the_signal_on_the_gpu_is_its_twin() -> Result<(), Box<dyn Error>> {
    let mut largest = 0.0_f64;
    for reference_white in ["203.0", "80.0", "10000.0", "1e-3"] {
        let Some(texels) = signals(reference_white)? else { return Ok(()) };
        for [radiance, signal] in texels {
            let guarded = [0, 1, 2].map(|channel| guard_radiance(f64::from(radiance[channel])));
            let expected = encode_hdr10(guarded, reference_white.parse()?);
            for (found, expected) in signal.into_iter().zip(expected) {
                let apart = (f64::from(found) - expected).abs();
                assert!(apart <= BOUND, "{radiance:?} became {found} instead of {expected}");
                largest = largest.max(apart);
            }
        }
    }
    println!("largest difference: {largest:e}, a share of {} of the bound", largest / BOUND);
    Ok(())
}

#[test]
fn whatever_goes_in_a_signal_between_zero_and_one_comes_out() -> Result<(), Box<dyn Error>> {
    for reference_white in ["0.0", "-5.0", "1e30", "203.0"] {
        let Some(texels) = signals(reference_white)? else { return Ok(()) };
        assert!(texels.iter().flat_map(|[_, signal]| signal).all(|signal| (0.0..=1.0).contains(signal)));
    }
    Ok(())
}

/// Report ITU-R BT.2408-7, table 1: 203 cd/m² at 58 % of the signal, and 10-bit code values of BT.2100.
#[test]
fn the_twin_has_the_standards_figures() {
    assert!((encode_pq(203.0 / PQ_PEAK) - 0.58).abs() < 0.001);
    assert!((encode_pq(100.0 / PQ_PEAK) - 0.508).abs() < 0.0005);
    assert!((encode_pq(1000.0 / PQ_PEAK) - 0.7518).abs() < 0.0005);
    assert!((encode_pq(1.0) - 1.0).abs() < 1e-12);
    assert!(encode_pq(0.0) < 1e-6);
    for step in 1..=1000 {
        let luminance = f64::from(step) / 1000.0;
        assert!((decode_pq(encode_pq(luminance)) - luminance).abs() < 1e-9 * luminance, "{luminance}");
    }
}

#[test]
fn grey_stays_grey_and_colours_of_rec_709_lie_within_rec_2020() {
    let grey = encode_hdr10([1.0; 3], 203.0);
    assert!(grey.iter().all(|channel| (channel - 0.58).abs() < 0.001), "{grey:?}");
    for pure in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        assert!(encode_hdr10(pure, 203.0).iter().all(|channel| *channel > 0.1), "{pure:?}");
    }
}
