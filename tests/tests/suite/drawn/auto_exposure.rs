//! The shipped automatic exposure is held against its twins: the histogram texel by texel, the adaptation frame by frame
//! (NU-5).

use framewright_graph::compile::Options;
use framewright_graph::vulkan::Aspects;
use framewright_passes::twin::exposure::{BINS, adapted, average_stop, luminance, place_of, scale};
use framewright_passes::twin::tone_mapping::modified_reinhard;
use framewright_tests::render::{Setup, device, draw, silent};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

/// As in `tests/pipelines/exposure.ron`.
const KEY: f64 = 0.18;
const SECONDS: f64 = 0.1;
const ADAPTATION: f64 = 0.4;
const USED_TO: f64 = 2.0;

/// The contents that some frames leave.
struct Left {
    noise: Vec<[f64; 4]>,
    shown: Vec<[f64; 4]>,
    bins: [u32; BINS],
    at_once: Exposure,
    slowly: Exposure,
}

/// The buffer of an exposure.
struct Exposure {
    scale: f64,
    stop: f64,
    started: u32,
}

fn words(bytes: &[u8]) -> impl Iterator<Item = u32> {
    bytes.as_chunks::<4>().0.iter().map(|word| u32::from_ne_bytes(*word))
}

fn exposure(bytes: &[u8]) -> Result<Exposure, Box<dyn Error>> {
    let [scale, stop, started] = words(bytes).take(3).collect::<Vec<_>>().try_into().map_err(|_| "three words")?;
    let [scale, stop] = [scale, stop].map(|bits| f64::from(f32::from_bits(bits)));
    Ok(Exposure { scale, stop, started })
}

fn texels(bytes: &[u8]) -> Vec<[f64; 4]> {
    let channels: Vec<f64> = words(bytes).map(|bits| f64::from(f32::from_bits(bits))).collect();
    channels.as_chunks::<4>().0.to_vec()
}

fn left(frames: u32) -> Result<Option<Left>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/exposure.ron", set: &[], scene: &scene, extent: [8, 8] };
    let (_, mut executor) = draw(device, &setup, &Options::default(), frames)?;
    let bins: Vec<u32> = words(&executor.read_buffer("bins")?).collect();
    let left = Left {
        noise: texels(&executor.read_image("noise", Aspects::COLOR, 0)?.bytes),
        shown: texels(&executor.read_image("shown", Aspects::COLOR, 0)?.bytes),
        bins: bins.try_into().map_err(|_| "as many bins")?,
        at_once: exposure(&executor.read_buffer("at_once")?)?,
        slowly: exposure(&executor.read_buffer("slowly")?)?,
    };
    silent(device)?;
    Ok(Some(left))
}

#[test]
fn every_texel_is_counted_once_in_the_bin_of_its_luminance() -> Result<(), Box<dyn Error>> {
    let Some(Left { noise, bins, .. }) = left(3)? else { return Ok(()) };
    assert_eq!(noise.len(), 64 * 48);
    assert_eq!(bins.iter().sum::<u32>(), 64 * 48, "each frame counts anew");
    // So close to where bins meet, rounding decides.
    let (mut sure, mut perhaps) = ([0; BINS], [0; BINS]);
    for [red, green, blue, _] in noise {
        let place = place_of(luminance([red, green, blue]));
        if (place - place.round()).abs() < 1e-3 {
            perhaps[place.round() as usize] += 1;
            perhaps[(place.round() as usize).saturating_sub(1)] += 1;
        } else {
            sure[place as usize] += 1;
        }
    }
    for (bin, count) in bins.into_iter().enumerate() {
        assert!((sure[bin]..=sure[bin] + perhaps[bin]).contains(&count), "bin {bin}: {count}, surely {}", sure[bin]);
    }
    assert!(bins.iter().filter(|count| **count > 0).count() > 40, "{bins:?}");
    Ok(())
}

#[test]
fn the_first_frame_adapts_at_once_to_the_average_without_the_ends() -> Result<(), Box<dyn Error>> {
    let Some(Left { bins, at_once, .. }) = left(1)? else { return Ok(()) };
    let average = average_stop(&bins, 0.1, 0.02);
    assert!((average - average_stop(&bins, 0.0, 0.0)).abs() > 0.1, "the ends would count");
    // Sums of 3,000 stops, each rounded by 2⁻²⁴ of the sum.
    assert!((at_once.stop - average).abs() < 1e-4, "{} instead of {average}", at_once.stop);
    assert!((at_once.scale / scale(KEY, average) - 1.0).abs() < 1e-4, "{}", at_once.scale);
    assert_eq!(at_once.started, 1);
    Ok(())
}

#[test]
fn what_the_eye_is_used_to_follows_from_frame_to_frame() -> Result<(), Box<dyn Error>> {
    let mut before = USED_TO;
    for frames in [1, 2, 5, 40] {
        let Some(Left { bins, slowly, .. }) = left(frames)? else { return Ok(()) };
        let average = average_stop(&bins, 0.0, 0.0);
        let expected = adapted(USED_TO, average, frames, SECONDS, ADAPTATION);
        assert!((slowly.stop - expected).abs() < 1e-4, "after {frames} frames {} instead of {expected}", slowly.stop);
        assert!((slowly.stop - average).abs() < (before - average).abs(), "after {frames} frames no closer");
        before = slowly.stop;
    }
    Ok(())
}

#[test]
fn the_picture_is_shown_with_the_exposure_of_its_own_frame() -> Result<(), Box<dyn Error>> {
    let Some(Left { noise, shown, slowly, .. }) = left(2)? else { return Ok(()) };
    for (noise, shown) in noise.into_iter().zip(shown) {
        for channel in 0..3 {
            let expected = modified_reinhard((noise[channel] * slowly.scale).min(65504.0), 8.0);
            assert!((shown[channel] - expected).abs() < 1e-5, "{} instead of {expected}", shown[channel]);
        }
    }
    Ok(())
}
