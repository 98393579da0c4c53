//! Resolves that tone-map each sample before they average are held against their twins (IQ-20, IQ-22).

use framewright_passes::twin::radiance::guard_radiance;
use framewright_passes::twin::tone_mapping::{filmic, modified_reinhard, neutral, reinhard, reinhard_luminance};
use framewright_passes::twin::weighted_resolve::{compressed, expanded, mean_compressed, weighted_mean};
use framewright_tests::render::{Setup, device, render, rgb};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

type Picture = Vec<[f64; 3]>;

/// The samples of each texel, and what became of them.
struct Resolved {
    samples: Vec<[[f64; 3]; 4]>,
    weighted: Picture,
    small: Picture,
    shown: Picture,
    inserted: Picture,
}

fn resolved(operator: &str) -> Result<Option<Resolved>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let (set, scene) = ([("operator", operator)], empty_scene());
    let setup = Setup { pipeline: "tests/pipelines/resolves.ron", set: &set, scene: &scene, extent: [8, 8] };
    let pictures = render(device, &setup)?.into_iter().map(|output| rgb(&output));
    let pictures: Vec<Picture> = pictures.collect();
    let [a, b, c, d, weighted, small, shown, inserted] =
        <[Picture; 8]>::try_from(pictures).map_err(|_| "not eight outputs")?;
    let guarded = |texel: [[f64; 3]; 4]| texel.map(|sample| sample.map(guard_radiance));
    let samples = (0..a.len()).map(|at| guarded([a[at], b[at], c[at], d[at]])).collect();
    Ok(Some(Resolved { samples, weighted, small, shown, inserted }))
}

/// Some twenty roundings of 2⁻²⁴, and what is lost of denormals.
fn close(found: [f64; 3], expected: [f64; 3]) -> bool {
    found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= 2e-6 * expected + 1e-30)
}

#[test]
fn the_samples_differ_and_hold_every_kind_of_number() -> Result<(), Box<dyn Error>> {
    let Some(Resolved { samples, .. }) = resolved("clip")? else { return Ok(()) };
    assert_eq!(samples.len(), 32 * 24);
    assert!(samples.iter().filter(|texel| texel.iter().any(|sample| *sample != texel[0])).count() > 700);
    let all = || samples.iter().flatten().flatten();
    assert!(all().any(|it| *it == 65504.0) && all().any(|it| *it == 0.0) && all().any(|it| *it == 12.0));
    Ok(())
}

#[test]
fn a_weighted_resolve_is_the_mean_of_tone_mapped_samples_taken_back() -> Result<(), Box<dyn Error>> {
    let Some(Resolved { samples, weighted, small, .. }) = resolved("clip")? else { return Ok(()) };
    for ((samples, weighted), small) in samples.iter().zip(weighted).zip(small) {
        assert!(close(weighted, weighted_mean(samples)), "{samples:?} became {weighted:?}");
        assert!(close(small, mean_compressed(samples)), "{samples:?} became {small:?} tone-mapped");
    }
    Ok(())
}

/// The pass that `resolve: Weighted` inserts for a pass that samples the plain name.
#[test]
fn what_is_inserted_is_bit_for_bit_what_the_fragment_draws() -> Result<(), Box<dyn Error>> {
    let Some(Resolved { weighted, inserted, .. }) = resolved("clip")? else { return Ok(()) };
    let bits = |picture: &Picture| picture.iter().flatten().map(|it| it.to_bits()).collect::<Vec<_>>();
    assert!(bits(&weighted) == bits(&inserted));
    Ok(())
}

#[test]
fn the_weighted_mean_of_grey_is_the_inverse_of_the_tone_mapped_mean() {
    for levels in [[0.0, 1.0, 12.0, 1000.0], [0.5; 4], [0.0, 0.0, 0.0, 65504.0], [65504.0; 4]] {
        let samples = levels.map(|level| [level; 3]);
        let (direct, inverse) = (weighted_mean(&samples), expanded(mean_compressed(&samples)));
        assert!((direct[0] - inverse[0]).abs() <= 1e-9 * direct[0], "{direct:?} and {inverse:?}");
    }
    for radiance in [[0.0, 0.5, 2.0], [1.0, 1.0, 1.0], [65504.0, 3.0, 0.25]] {
        let back = expanded(compressed(radiance));
        assert!(back.iter().zip(radiance).all(|(back, there)| (back - there).abs() <= 1e-9 * there), "{back:?}");
    }
}

/// The remedy: the mean of one lamp among three dark samples is nearer to the dark than to the lamp, however bright that is.
#[test]
fn one_bright_sample_does_not_drown_the_others() {
    for lamp in [10.0, 1000.0, 65504.0] {
        let samples = [[0.25; 3], [0.25; 3], [0.25; 3], [lamp; 3]];
        let plain = (0.75 + lamp) / 4.0;
        let [mean, ..] = weighted_mean(&samples);
        assert!(mean < 1.0 && plain > 1.0 && mean > 0.25, "{mean}, plain {plain}");
    }
}

#[test]
fn equal_samples_stay_what_they_are() -> Result<(), Box<dyn Error>> {
    for level in [0.0, 0.25, 7.0, 65504.0] {
        let [mean, ..] = weighted_mean(&[[level; 3]; 4]);
        assert!((mean - level).abs() <= 1e-12 * level);
    }
    Ok(())
}

#[test]
fn tone_mapping_that_resolves_averages_what_each_sample_would_be_shown_as() -> Result<(), Box<dyn Error>> {
    type Operator = fn([f64; 3]) -> [f64; 3];
    let operators: [(&str, Operator); 6] = [
        ("clip", |light| light.map(|channel| channel.min(1.0))),
        ("reinhard", |light| light.map(reinhard)),
        ("white_point", |light| light.map(|channel| modified_reinhard(channel, 8.0))),
        ("filmic", |light| light.map(filmic)),
        ("neutral", neutral),
        ("reinhard_luminance", reinhard_luminance),
    ];
    for (name, operator) in operators {
        let Some(Resolved { samples, shown, .. }) = resolved(name)? else { return Ok(()) };
        for (samples, shown) in samples.iter().zip(shown) {
            let each = samples.map(|sample| operator(sample.map(|channel| 0.5 * channel)));
            let mean = [0, 1, 2].map(|channel| each.iter().map(|sample| sample[channel]).sum::<f64>() / 4.0);
            let near = shown.iter().zip(mean).all(|(found, expected)| (found - expected).abs() <= 2e-6);
            assert!(near, "{name}: {samples:?} became {shown:?} instead of {mean:?}");
        }
    }
    Ok(())
}
