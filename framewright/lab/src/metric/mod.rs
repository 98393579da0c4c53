//! The error of a picture beside a reference, in more than one sense.
//!
//! [`Errors::between`] takes two pictures of linear light and gives every metric of [`Metric`]. Pixels that aren't finite in
//! either are counted, and are no part of any figure.

mod flicker;
mod flip;
mod heat_map;
mod plane;
mod ssim;

use crate::picture::Light;
pub use flicker::{Changes, Flicker};
pub use flip::{Exposures, PIXELS_PER_DEGREE, PIXELS_PER_DEGREE_RANGE};
use framewright_passes::srgb;
pub use heat_map::heat_map;
use plane::Plane;
use serde::{Deserialize, Serialize};

/// Added to the square of the reference, so that dark pixels don't decide the relative error.
const RELATIVE_FLOOR: f64 = 0.01;

/// A sense in which a picture can be wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Metric {
    /// FLIP's mean.
    Flip,
    /// The root of the mean square of the difference in linear light.
    Rmse,
    /// The largest difference in linear light.
    MaxError,
    /// The mean of squared differences, each beside the square of the reference.
    RelativeMse,
    /// The peak signal-to-noise ratio in linear light, in dB.
    Psnr,
    /// The structural similarity of what a display shows.
    Ssim,
}

/// FLIP over a picture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlipErrors {
    /// Those of HDR-FLIP; `None` for pictures of light from 0 to 1, which a display shows as they are.
    pub exposures: Option<Exposures>,
    /// Pixels for a degree of sight, of [`PIXELS_PER_DEGREE_RANGE`].
    pub pixels_per_degree: f64,
    /// The mean over all pixels, from 0 to 1.
    pub mean: f64,
    /// At most this at 95 of 100 pixels.
    pub percentile_95: f64,
    /// At the worst pixel.
    pub worst: f64,
}

/// The errors of a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Errors {
    /// FLIP.
    pub flip: FlipErrors,
    /// The root of the mean square of the difference in linear light, over red, green and blue.
    pub rmse: f64,
    /// The largest difference in linear light.
    pub max_error: f64,
    /// The mean of squared differences over `reference² + 0.01`.
    pub relative_mse: f64,
    /// `20 log10(peak / rmse)` in dB; `None` if there is no difference. The peak is 1, or the largest light of a reference that is
    /// brighter.
    pub psnr: Option<f64>,
    /// Structural similarity of values from 0 to 1 in the curve of sRGB: 1 if there is no difference.
    pub ssim: f64,
    /// Pixels that aren't finite: in the reference, in the other picture.
    pub non_finite: [usize; 2],
    /// Whether no pixel is finite in both pictures: then no figure means anything.
    #[serde(skip)]
    pub of_nothing: bool,
    #[serde(skip)]
    flip_map: Plane,
}

impl Metric {
    /// All, in the order in which they are shown.
    pub const ALL: [Metric; 6] =
        [Metric::Flip, Metric::Rmse, Metric::MaxError, Metric::RelativeMse, Metric::Psnr, Metric::Ssim];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Metric::Flip => "flip",
            Metric::Rmse => "rmse",
            Metric::MaxError => "max-error",
            Metric::RelativeMse => "relative-mse",
            Metric::Psnr => "psnr",
            Metric::Ssim => "ssim",
        }
    }

    /// The figure that it is, in words.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            Metric::Flip => "FLIP's mean",
            Metric::Rmse => "The root of the mean square of the difference in linear light",
            Metric::MaxError => "The largest difference in linear light",
            Metric::RelativeMse => "The mean of squared differences, each beside the square of the reference",
            Metric::Psnr => "The peak signal-to-noise ratio in linear light, in dB",
            Metric::Ssim => "The structural similarity of what a display shows",
        }
    }

    /// Whether larger figures are better.
    #[must_use]
    pub fn is_likeness(self) -> bool {
        matches!(self, Metric::Psnr | Metric::Ssim)
    }
}

impl Errors {
    /// The errors of a picture beside a reference. `pixels_per_degree` is what FLIP takes for the number of pixels in a degree of sight,
    /// of [`PIXELS_PER_DEGREE_RANGE`]. `None`: it isn't, the pictures have different sizes or no pixels, or one has more or fewer texels
    /// than its size says.
    #[must_use]
    pub fn between(reference: &Light, test: &Light, pixels_per_degree: f64) -> Option<Errors> {
        let extent = reference.extent;
        let texels = extent[0].checked_mul(extent[1])?;
        let fits = |picture: &Light| picture.extent == extent && picture.texels.len() == texels;
        let in_range = PIXELS_PER_DEGREE_RANGE.contains(&pixels_per_degree);
        if texels == 0 || !in_range || !fits(reference) || !fits(test) {
            return None;
        }
        let finite: Vec<[bool; 2]> = reference
            .texels
            .iter()
            .zip(&test.texels)
            .map(|texels| [is_finite(texels.0), is_finite(texels.1)])
            .collect();
        let counts = |at: usize| finite.iter().map(|finite| finite[at]).collect::<Vec<bool>>();
        let both: Vec<bool> = finite.iter().map(|[a, b]| *a && *b).collect();
        // Where either isn't finite both are black: neither filter sees a difference there.
        let light = |picture: &Light| -> Vec<[f64; 3]> {
            let texels = picture.texels.iter().zip(&both);
            texels.map(|(texel, finite)| if *finite { texel.map(f64::from) } else { [0.0; 3] }).collect()
        };
        let (a, b) = (light(reference), light(test));
        let all_shown = |texels: &[[f64; 3]]| -> Vec<[f64; 3]> { texels.iter().copied().map(shown).collect() };
        let (shown_a, shown_b) = (all_shown(&a), all_shown(&b));
        let is_light = reference.is_light || test.is_light;
        let (flip_map, exposures) = match is_light {
            true => {
                let finite: Vec<_> = a.iter().zip(&both).filter(|(_, finite)| **finite).map(|(it, _)| *it).collect();
                let exposures = Exposures::of(&finite);
                (flip::of_light(&a, &b, extent, pixels_per_degree, exposures), Some(exposures))
            }
            false => (flip::of_display(&a, &b, extent, pixels_per_degree), None),
        };
        let similarity = ssim::map(&shown_a, &shown_b, extent);
        let inside = |at: &usize| both[*at] && ssim::is_inside(extent, *at);
        let ssim = mean((0..both.len()).filter(inside).map(|at| similarity.values[at]), 1.0);
        let pooled =
            PooledFigures::of(flip_map.values.iter().zip(&both).filter(|(_, finite)| **finite).map(|(flip, _)| *flip));
        let differences = |a: &[[f64; 3]], b: &[[f64; 3]]| -> Vec<f64> {
            let pixels = a.iter().zip(b).zip(&both).filter(|(_, finite)| **finite);
            pixels.flat_map(|((a, b), _)| [0, 1, 2].map(|at| b[at] - a[at])).collect()
        };
        let light = differences(&a, &b);
        let references = a.iter().zip(&both).filter(|(_, finite)| **finite).flat_map(|(texel, _)| *texel);
        let relative = light
            .iter()
            .zip(references.clone())
            .map(|(difference, reference)| difference * difference / (reference * reference + RELATIVE_FLOOR));
        let rmse = mean(light.iter().map(|it| it * it), 0.0).sqrt();
        let peak = references.clone().fold(1.0, f64::max);
        Some(Errors {
            flip: FlipErrors {
                exposures,
                pixels_per_degree,
                mean: pooled.mean,
                percentile_95: pooled.percentile_95,
                worst: pooled.worst,
            },
            rmse,
            max_error: light.iter().fold(0.0, |most, it| it.abs().max(most)),
            relative_mse: mean(relative, 0.0),
            psnr: (rmse > 0.0).then(|| 20.0 * (peak / rmse).log10()),
            ssim,
            non_finite: [0, 1].map(|at| counts(at).iter().filter(|finite| !**finite).count()),
            of_nothing: !both.contains(&true),
            flip_map,
        })
    }

    /// A metric's figure. Pictures without a difference have an infinite signal-to-noise ratio.
    #[must_use]
    pub fn of(&self, metric: Metric) -> f64 {
        match metric {
            Metric::Flip => self.flip.mean,
            Metric::Rmse => self.rmse,
            Metric::MaxError => self.max_error,
            Metric::RelativeMse => self.relative_mse,
            Metric::Psnr => self.psnr.unwrap_or(f64::INFINITY),
            Metric::Ssim => self.ssim,
        }
    }

    /// FLIP of each pixel, in rows from the top.
    #[must_use]
    pub fn flip_map(&self) -> &[f64] {
        &self.flip_map.values
    }
}

/// Light as a display shows it: values from 0 to 1 in the curve of sRGB.
fn shown(light: [f64; 3]) -> [f64; 3] {
    light.map(|light| srgb::encode(light.clamp(0.0, 1.0)))
}

fn is_finite(texel: &[f32; 3]) -> bool {
    texel.iter().all(|light| light.is_finite())
}

/// The mean, or `none` of no values.
fn mean(values: impl Iterator<Item = f64>, none: f64) -> f64 {
    let (sum, count) = values.fold((0.0, 0_u32), |(sum, count), value| (sum + value, count + 1));
    if count == 0 { none } else { sum / f64::from(count) }
}

/// Figures of a value at each pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PooledFigures {
    mean: f64,
    /// The least value that at least 95 of 100 pixels don't exceed.
    percentile_95: f64,
    worst: f64,
}

impl PooledFigures {
    /// Those of some pixels; all 0 of none.
    fn of(values: impl Iterator<Item = f64>) -> PooledFigures {
        let mut sorted: Vec<f64> = values.collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let rank = (sorted.len() * 95).div_ceil(100).saturating_sub(1);
        PooledFigures {
            mean: mean(sorted.iter().copied(), 0.0),
            percentile_95: sorted.get(rank).copied().unwrap_or(0.0),
            worst: sorted.last().copied().unwrap_or(0.0),
        }
    }
}
