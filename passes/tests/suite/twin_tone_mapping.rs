//! Claims about the tone mapping curves (IQ-21), over everything that the guard lets through.

use framewright_passes::srgb::{decode, encode};
use framewright_passes::twin::exposure::luminance;
use framewright_passes::twin::radiance::{LARGEST_HALF, guard_radiance};
use framewright_passes::twin::tone_mapping::{filmic, modified_reinhard, neutral, reinhard, reinhard_luminance};

/// Every finite half float from 0 on, smallest first.
fn halves() -> impl Iterator<Item = f64> {
    (0_u32..0x7c00).map(|bits| {
        let (exponent, mantissa) = (bits >> 10, f64::from(bits & 0x3ff));
        if exponent == 0 {
            mantissa * 2_f64.powi(-24)
        } else {
            (1024.0 + mantissa) * 2_f64.powi(exponent.cast_signed() - 25)
        }
    })
}

#[test]
fn the_range_runs_from_zero_to_the_largest_half() {
    assert_eq!(halves().next(), Some(0.0));
    assert_eq!(halves().last(), Some(LARGEST_HALF));
}

#[test]
fn zero_stays_exactly_zero() {
    assert_eq!(reinhard(0.0), 0.0);
    for white_point in [1.0, 4.0, 100.0, f64::INFINITY] {
        assert_eq!(modified_reinhard(0.0, white_point), 0.0);
    }
}

#[test]
fn the_curves_rise_and_stay_between_zero_and_one() {
    let mut before = [-1.0; 4];
    for radiance in halves() {
        let now = [
            reinhard(radiance),
            modified_reinhard(radiance, 1.0),
            modified_reinhard(radiance, 4.0),
            modified_reinhard(radiance, 100.0),
        ];
        for (now, before) in now.iter().zip(before) {
            assert!((0.0..=1.0).contains(now) && *now >= before, "{radiance} becomes {now} after {before}");
        }
        before = now;
    }
}

#[test]
fn radiance_one_becomes_one_half_under_reinhard() {
    assert_eq!(reinhard(1.0), 0.5);
}

#[test]
fn reinhard_approaches_one_and_never_overflows() {
    let brightest = reinhard(LARGEST_HALF);
    assert!(brightest < 1.0 && brightest > 0.9999);
}

#[test]
fn the_white_point_becomes_one_and_everything_brighter_stays_there() {
    for white_point in [1.0, 2.0, 4.0, 10.0, 100.0] {
        assert!((modified_reinhard(white_point, white_point) - 1.0).abs() < 1e-15);
        for radiance in halves().filter(|radiance| *radiance > white_point) {
            assert!((modified_reinhard(radiance, white_point) - 1.0).abs() < 1e-15);
        }
    }
}

#[test]
fn a_white_point_of_one_is_the_identity_on_zero_to_one() {
    for radiance in halves().filter(|radiance| *radiance <= 1.0) {
        let mapped = modified_reinhard(radiance, 1.0);
        assert!((mapped - radiance).abs() <= 2.0 * f64::EPSILON * radiance, "{radiance} became {mapped}");
    }
}

#[test]
fn a_white_point_below_one_counts_as_one() {
    for white_point in [0.5, 0.0, -3.0, f64::NEG_INFINITY] {
        assert_eq!(modified_reinhard(0.75, white_point), modified_reinhard(0.75, 1.0));
    }
}

#[test]
fn an_endless_white_point_is_reinhard() {
    for radiance in halves() {
        assert_eq!(modified_reinhard(radiance, f64::INFINITY), reinhard(radiance));
        // The difference is c²/(1 + c)/w², less than c/w².
        assert!((modified_reinhard(radiance, 1e12) - reinhard(radiance)).abs() <= radiance * 1e-24 + f64::EPSILON);
    }
}

#[test]
fn behind_the_guard_no_input_becomes_nan() {
    for radiance in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, -0.0, 5e-324] {
        let guarded = guard_radiance(radiance);
        for mapped in [reinhard(guarded), modified_reinhard(guarded, 1.0), modified_reinhard(guarded, 100.0)] {
            assert!((0.0..=1.0).contains(&mapped), "{radiance} became {mapped}");
        }
    }
}

#[test]
fn the_filmic_curve_rises_from_zero_to_white_as_published() {
    assert_eq!(filmic(0.0), 0.0);
    // "1 on input maps to ~0.8 on output".
    assert!((filmic(1.0) - 0.8038).abs() < 1e-4);
    // (2.51 − 2.43)x² − 0.56x − 0.14 = 0.
    let white = (0.56 + f64::sqrt(0.56 * 0.56 + 4.0 * 0.08 * 0.14)) / 0.16;
    assert!(filmic(0.999 * white) < 1.0 && filmic(1.001 * white) == 1.0);
    let curve: Vec<f64> = halves().map(filmic).collect();
    assert!(curve.is_sorted() && curve.iter().all(|it| (0.0..=1.0).contains(it)));
}

/// Colours of every brightness: a channel is a share of the brightest.
fn colours() -> impl Iterator<Item = [f64; 3]> {
    let shares = [[1.0, 1.0, 1.0], [1.0, 0.5, 0.25], [0.1, 0.9, 1.0], [0.0, 1.0, 0.0], [1.0, 1e-3, 0.999]];
    shares.into_iter().flat_map(|shares| halves().step_by(7).map(move |light| shares.map(|share| share * light)))
}

#[test]
fn neutral_takes_what_glossy_surfaces_reflect_from_colours_that_are_not_bright() {
    for radiance in [[0.08, 0.08, 0.08], [0.8, 0.8, 0.8], [0.1, 0.5, 0.79], [0.3, 0.08, 0.6]] {
        let expected = radiance.map(|channel| channel - 0.04);
        assert!(neutral(radiance).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{radiance:?}");
    }
    assert_eq!(neutral([0.0; 3]), [0.0; 3]);
}

/// Worked out by hand from the specification's formulas with F90 = 0.04, Ks = 0.76 and Kd = 0.15, where
/// pn = 1 − 0.24² / (p − 0.52) and g = 1 / (0.15 (p − pn) + 1).
#[test]
fn neutral_gives_what_the_specification_does() {
    let cases = [
        // x = 2 is more than 0.08, so f = 0.04 and p = 1.96: pn = 1 − 0.0576 / 1.44. Grey has no colour to lose.
        ([2.0, 2.0, 2.0], [0.96, 0.96, 0.96]),
        // x = 0, so f = 0 and p = 2: pn = 1 − 0.0576 / 1.48 = 0.961081, g = 1 / (0.15 · 1.038919 + 1) = 0.865173;
        // red becomes pn, the others (1 − g) pn = 0.134827 · 0.961081.
        ([2.0, 0.0, 0.0], [0.961_081, 0.129_579, 0.129_579]),
        // x = 0.02, so f = 0.02 − 0.0004 / 0.16 = 0.0175 and p = 0.9825: pn = 1 − 0.0576 / 0.4625 = 0.875459,
        // g = 1 / (0.15 · 0.107041 + 1) = 0.984198; green becomes 0.4825 pn/p g + (1 − g) pn = 0.423139 + 0.013834, and blue
        // 0.0025 pn/p g + (1 − g) pn = 0.002192 + 0.013834.
        ([1.0, 0.5, 0.02], [0.875_459, 0.436_973, 0.016_027]),
        // x = 0.05, so f = 0.05 − 0.0025 / 0.16 = 0.034375, and nothing is compressed.
        ([0.05, 0.05, 0.05], [0.015_625, 0.015_625, 0.015_625]),
    ];
    for (radiance, expected) in cases {
        let mapped = neutral(radiance);
        assert!(mapped.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{radiance:?} became {mapped:?}");
    }
}

#[test]
fn neutral_stays_between_zero_and_one_and_keeps_the_hue() {
    for radiance in colours() {
        let mapped = neutral(radiance);
        assert!(mapped.iter().all(|channel| (0.0..1.0).contains(channel)), "{radiance:?} became {mapped:?}");
        // The hue: where between the least and the largest channel the third lies.
        let hue = |[r, g, b]: [f64; 3]| (r - b) / (g - b);
        let (before, after) = (hue(radiance), hue(mapped));
        let distinct = (mapped[1] - mapped[2]).abs() > 1e-3;
        assert!(!distinct || (before - after).abs() < 1e-9 * (1.0 + before.abs()), "{radiance:?} became {mapped:?}");
    }
}

#[test]
fn neutral_brightens_with_the_light_and_ends_in_white() {
    let largest = |radiance: [f64; 3]| neutral(radiance).into_iter().fold(0.0, f64::max);
    for shares in [[1.0, 1.0, 1.0], [1.0, 0.5, 0.25], [0.0, 1.0, 0.0]] {
        let curve: Vec<f64> = halves().map(|light| largest(shares.map(|share: f64| share * light))).collect();
        assert!(curve.windows(2).all(|pair| pair[1] >= pair[0] - 1e-12));
        let white = neutral(shares.map(|share| share * LARGEST_HALF));
        assert!(white.iter().all(|channel| *channel > 0.999), "{white:?}");
    }
}

/// What the operator is for: the luminance becomes that of `reinhard`, and hues stay. The price is saturated colours that are cut off.
#[test]
fn reinhard_on_luminance_compresses_the_luminance_and_keeps_ratios() {
    for radiance in colours() {
        let mapped = reinhard_luminance(radiance);
        assert!(mapped.iter().all(|channel| (0.0..=1.0).contains(channel)), "{radiance:?} became {mapped:?}");
        if mapped.iter().all(|channel| *channel < 1.0) {
            let (found, expected) = (luminance(mapped), reinhard(luminance(radiance)));
            assert!((found - expected).abs() < 1e-12, "{radiance:?}: luminance {found} instead of {expected}");
            let apart = (mapped[0] * radiance[1] - mapped[1] * radiance[0]).abs();
            assert!(apart <= 1e-12 * (1.0 + radiance[0]), "{radiance:?} became {mapped:?}");
        }
    }
    // Of grey it is the curve of each channel; of bright blue it is not.
    assert_eq!(reinhard_luminance([1.0; 3]), [0.5; 3]);
    assert_eq!(reinhard_luminance([0.0, 0.0, 4.0])[2], 1.0);
}

/// The number from 0 to 255 that an 8-bit sRGB image stores.
fn stored(linear: f64) -> f64 {
    (encode(linear) * 255.0).round()
}

/// NU-6: pipelines keep light in 8 bits where nothing is brighter than white. By curves that take neighbouring shades nowhere
/// further apart, no shade is off by more than one step, and no step is left out that the light had.
#[test]
fn eight_bits_of_light_are_enough_for_curves_that_only_compress() {
    // With an endless white point the curve is `reinhard`.
    for white_point in [1.0, 1.001, 1.5, 4.0, 20.0, 100.0, f64::INFINITY] {
        let (name, curve) = (format!("white point {white_point}"), |light: f64| modified_reinhard(light, white_point));
        let shown = |step: u32| stored(curve(decode(f64::from(step) / 255.0)));
        for step in 1..=255 {
            let apart = shown(step) - shown(step - 1);
            assert!((0.0..=1.0).contains(&apart), "{name}: steps {} and {step} are {apart} apart", step - 1);
        }
        for part in 0..=100_000 {
            let radiance = f64::from(part) * 1e-5;
            let off = (stored(curve(decode(stored(radiance) / 255.0))) - stored(curve(radiance))).abs();
            assert!(off <= 1.0, "{name}: {radiance} is off by {off} steps");
        }
    }
}

/// NU-6: why pipelines keep 16 bits for the other curves.
#[test]
fn eight_bits_of_light_leave_steps_out_for_curves_that_spread_dark_shades() {
    let grey = |radiance: f64| neutral([radiance; 3])[0];
    let curves: [(&str, &dyn Fn(f64) -> f64); 2] = [("filmic", &filmic), ("neutral", &grey)];
    for (name, curve) in curves {
        let shown = |step: u32| stored(curve(decode(f64::from(step) / 255.0)));
        let most = (1..=255).map(|step| shown(step) - shown(step - 1)).fold(0.0, f64::max);
        assert!(most >= 2.0, "{name}: at most {most} steps apart");
    }
}
