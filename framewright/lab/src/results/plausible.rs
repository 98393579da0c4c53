//! Figures that a measurement can have. Others come of a damaged file.

use super::{Cost, FLICKER_FRAMES, FRAMES, Outcome, Results, Row, RowFigures, Spread, Subject};
use crate::metric::{Errors, Flicker, PIXELS_PER_DEGREE_RANGE};
use crate::picture::FileFormat;
use crate::sweep::size_name;
use std::path::{Component, Path};

/// Largest width or height of a frame, in pixels.
const LARGEST_SIDE: u32 = 16384;

/// Rounding may put a mean above the largest value by so much.
const ROUNDING: f64 = 1.0 + 1e-9;

/// No two floating-point numbers are so far apart.
const MOST_DECIBELS: f64 = 2000.0;

/// The first thing in results that no measurement gives, in words.
pub(super) fn problem(results: &Results) -> Option<String> {
    let Subject { frames, flicker_frames, .. } = results.subject;
    if !FRAMES.contains(&frames) {
        return Some(format!("`frames` can't be {frames}"));
    }
    if let Some(frames) = flicker_frames.filter(|frames| !FLICKER_FRAMES.contains(frames)) {
        return Some(format!("`flicker_frames` can't be {frames}"));
    }
    results.rows.iter().enumerate().find_map(|(at, row)| {
        let problem = of_row(row)?;
        Some(format!("row {} ({}): {problem}", at + 1, row.name()))
    })
}

fn of_row(row: &Row) -> Option<String> {
    if !row.size.iter().all(|side| (1..=LARGEST_SIDE).contains(side)) {
        return Some(format!("the size {} is none", size_name(row.size)));
    }
    let Outcome::Measured(measured) = &row.outcome else { return None };
    let unknown = row.choice.keys().find(|name| !name.starts_with('@') && !row.settings.contains_key(*name));
    if let Some(name) = unknown {
        return Some(format!("`choice` names `{name}`, which `settings` doesn't"));
    }
    of_cost(&measured.cost).or_else(|| of_passes(measured)).or_else(|| of_pictures(measured)).or_else(|| {
        let named = [("errors", &measured.errors), ("reference_errors", &measured.reference_errors)];
        let wrong = named.into_iter().find_map(|(name, errors)| of_errors(name, errors.as_ref()?, row.size));
        wrong.or_else(|| of_flicker(measured.flicker.as_ref()?, row.size))
    })
}

fn of_flicker(flicker: &Flicker, size: [u32; 2]) -> Option<String> {
    let Flicker { frames, mean, percentile_95, worst, non_finite, .. } = flicker;
    let within = |value: f64, most: f64| value >= 0.0 && value <= most * ROUNDING;
    // The error of a value from 0 to 1 changes by 2 at most.
    let figures = [("worst", worst, 2.0), ("mean", mean, *worst), ("percentile_95", percentile_95, *worst)];
    let wrong = figures.into_iter().find(|(_, value, most)| !within(**value, *most));
    if let Some((figure, value, _)) = wrong {
        return Some(format!("`flicker.{figure}` can't be {value}"));
    }
    if !FLICKER_FRAMES.contains(frames) {
        return Some(format!("`flicker.frames` can't be {frames}"));
    }
    let pixels = pixels(size);
    (*non_finite > pixels).then(|| format!("`flicker.non_finite` can't be {non_finite} of {pixels} pixels"))
}

/// Pictures of both eyes stand side by side.
fn pixels(size: [u32; 2]) -> usize {
    size.iter().fold(2, |pixels: usize, side| pixels.saturating_mul(*side as usize))
}

fn of_cost(cost: &Cost) -> Option<String> {
    let spreads = [
        ("gpu_milliseconds", cost.gpu_milliseconds),
        ("gpu_ratio", cost.gpu_ratio),
        ("recording_milliseconds", Some(cost.recording_milliseconds)),
    ];
    spreads.into_iter().find_map(|(name, spread)| of_spread(name, spread?))
}

fn of_passes(measured: &RowFigures) -> Option<String> {
    measured.passes.iter().find_map(|pass| of_spread(&format!("pass `{}`", pass.name), pass.gpu_milliseconds?))
}

fn of_spread(name: &str, Spread { median, low, high }: Spread) -> Option<String> {
    let is_possible = low >= 0.0 && low <= median && median <= high && high.is_finite();
    (!is_possible).then(|| format!("`{name}` can't have the median {median} between {low} and {high}"))
}

fn of_errors(name: &str, errors: &Errors, size: [u32; 2]) -> Option<String> {
    let flip = errors.flip;
    let within = |value: f64, least: f64, most: f64| value.is_finite() && value >= least && value <= most * ROUNDING;
    let exposures = flip
        .exposures
        .is_none_or(|exposures| exposures.first.is_finite() && exposures.last.is_finite() && exposures.count > 0);
    let pixels = pixels(size);
    let figures = [
        ("flip.worst", flip.worst, within(flip.worst, 0.0, 1.0)),
        ("flip.mean", flip.mean, within(flip.mean, 0.0, flip.worst)),
        ("flip.percentile_95", flip.percentile_95, within(flip.percentile_95, 0.0, flip.worst)),
        ("flip.pixels_per_degree", flip.pixels_per_degree, PIXELS_PER_DEGREE_RANGE.contains(&flip.pixels_per_degree)),
        ("max_error", errors.max_error, within(errors.max_error, 0.0, f64::MAX)),
        ("rmse", errors.rmse, within(errors.rmse, 0.0, errors.max_error)),
        ("relative_mse", errors.relative_mse, within(errors.relative_mse, 0.0, f64::MAX)),
        (
            "psnr",
            errors.psnr.unwrap_or(0.0),
            errors.psnr.is_none_or(|psnr| within(psnr, -MOST_DECIBELS, MOST_DECIBELS)),
        ),
        ("ssim", errors.ssim, within(errors.ssim, -ROUNDING, 1.0)),
    ];
    let wrong = figures.into_iter().find(|(_, _, is_possible)| !is_possible);
    if let Some((figure, value, _)) = wrong {
        return Some(format!("`{name}.{figure}` can't be {value}"));
    }
    if !exposures {
        return Some(format!("`{name}.flip.exposures` are none"));
    }
    let most = errors.non_finite.into_iter().max().filter(|count| *count > pixels);
    most.map(|count| format!("`{name}.non_finite` can't be {count} of {pixels} pixels"))
}

fn of_pictures(measured: &RowFigures) -> Option<String> {
    let wrong = measured.pictures().find(|(_, path)| !is_within(path))?;
    Some(format!("`{}` is `{}`: pictures are .png or .exr files within the folder", wrong.0, wrong.1))
}

/// Whether a path names a picture that lies in the folder of the results, or below it.
fn is_within(path: &str) -> bool {
    let normal = |part| matches!(part, Component::Normal(_));
    let path_within = Path::new(path);
    !path.contains(['\\', ':', '\0']) && path_within.components().all(normal) && FileFormat::of(path_within).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_lie_within_the_folder() {
        for within in ["a.png", "pictures/a.png", "a..b/c.exr", "a/./b.png"] {
            assert!(is_within(within), "{within}");
        }
        for outside in ["", "/a.png", "../a.png", "a/../../b.png", "a/..", "C:/a.png", "..\\a.png", "a.txt", "a\0.png"]
        {
            assert!(!is_within(outside), "{outside}");
        }
    }
}
