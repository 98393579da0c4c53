//! The command line of `framewright compare`.

use super::values::{AnswerFormat, number, png};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use framewright_lab::metric::{Metric, PIXELS_PER_DEGREE, PIXELS_PER_DEGREE_RANGE};
use std::path::PathBuf;

/// `framewright compare`.
#[derive(Debug, Args)]
pub(crate) struct CompareArguments {
    /// Picture that is right: a .png or .exr file.
    #[arg(value_name = "REFERENCE")]
    pub(crate) reference: PathBuf,
    /// Picture that is compared with it, of the same size. If either is an .exr file, HDR-FLIP is measured.
    #[arg(value_name = "PICTURE")]
    pub(crate) picture: PathBuf,
    /// Metric to print; without this all are. Repeatable.
    #[arg(long, value_name = "METRIC", value_parser = metric())]
    pub(crate) metric: Vec<Metric>,
    /// File for a picture of FLIP: black where no difference is seen, bright where much is.
    #[arg(long, value_name = "FILE.png", value_parser = png)]
    pub(crate) heatmap: Option<PathBuf>,
    /// Pixels of the screen for a degree of sight, which FLIP depends on; by default those of a screen of 3,840 pixels and 0.7 m
    /// width, seen from 0.7 m.
    #[arg(long, value_name = "N", default_value_t = PIXELS_PER_DEGREE, hide_default_value = true, value_parser = degree)]
    pub(crate) pixels_per_degree: f64,
    /// Form of the answer.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: AnswerFormat,
    // The last: its heading holds for all that follow.
    #[command(
        flatten,
        next_help_heading = "Limits; beyond one, or with one if a pixel isn't finite, the command ends with 1"
    )]
    pub(crate) limits: ErrorLimits,
}

/// Reads a metric by its name.
fn metric() -> impl TypedValueParser<Value = Metric> {
    let names = Metric::ALL.map(|metric| PossibleValue::new(metric.name()).help(metric.about()));
    let named = |name: String| Metric::ALL.into_iter().find(|metric| metric.name() == name);
    PossibleValuesParser::new(names).try_map(move |name| named(name).ok_or("no metric has that name"))
}

/// Limits of errors.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct ErrorLimits {
    /// Most that FLIP's mean may be: 0 is no visible difference, 1 the largest.
    #[arg(long, value_name = "X", value_parser = number)]
    max_flip: Option<f64>,
    /// Most that the root mean square of the difference in linear light may be.
    #[arg(long, value_name = "X", value_parser = number)]
    max_rmse: Option<f64>,
    /// Most that the largest difference in linear light may be.
    #[arg(long, value_name = "X", value_parser = number)]
    max_error: Option<f64>,
    /// Most that the mean of squared differences beside the square of the reference may be.
    #[arg(long, value_name = "X", value_parser = number)]
    max_relative_mse: Option<f64>,
    /// Least that the peak signal-to-noise ratio may be, in dB.
    #[arg(long, value_name = "X", value_parser = number)]
    min_psnr: Option<f64>,
    /// Least that the structural similarity may be: 1 is no difference.
    #[arg(long, value_name = "X", value_parser = number)]
    min_ssim: Option<f64>,
}

impl ErrorLimits {
    /// The limit of a metric.
    #[must_use]
    pub(crate) fn of(&self, metric: Metric) -> Option<f64> {
        match metric {
            Metric::Flip => self.max_flip,
            Metric::Rmse => self.max_rmse,
            Metric::MaxError => self.max_error,
            Metric::RelativeMse => self.max_relative_mse,
            Metric::Psnr => self.min_psnr,
            Metric::Ssim => self.min_ssim,
        }
    }
}

/// Reads pixels for a degree of sight.
fn degree(text: &str) -> Result<f64, String> {
    let (pixels, range) = (number(text)?, PIXELS_PER_DEGREE_RANGE);
    let problem = || format!("expected {} to {} pixels", range.start(), range.end());
    if range.contains(&pixels) { Ok(pixels) } else { Err(problem()) }
}
