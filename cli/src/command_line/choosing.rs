//! The command line of `framewright choose`.

use super::comparing::ErrorLimits;
use super::values::{AnswerFormat, number, positive};
use clap::{ArgGroup, Args};
use std::path::PathBuf;

/// `framewright choose`.
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("limit").required(true).multiple(true).args([
    "max_ms", "max_ratio", "max_mib", "max_moved_mib", "max_flicker",
    "max_flip", "max_rmse", "max_error", "max_relative_mse", "min_psnr", "min_ssim",
])))]
pub(crate) struct ChooseArguments {
    /// Folders of results, as `merge` joins them.
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Most milliseconds that a frame may take on the device: the median of its times. With this or another limit of cost the
    /// settings of least error are chosen, without one the fastest.
    #[arg(long, value_name = "X", value_parser = positive, help_heading = HEADING)]
    pub(crate) max_ms: Option<f64>,
    /// Longest time of a frame on the device, relative to the baseline's.
    #[arg(long, value_name = "X", value_parser = positive, help_heading = HEADING)]
    pub(crate) max_ratio: Option<f64>,
    /// Most MiB of transient memory.
    #[arg(long, value_name = "X", value_parser = positive, help_heading = HEADING)]
    pub(crate) max_mib: Option<f64>,
    /// Most MiB that loads, stores, resolves and copies move in a frame.
    #[arg(long, value_name = "X", value_parser = positive, help_heading = HEADING)]
    pub(crate) max_moved_mib: Option<f64>,
    /// Most that the mean of flicker may be: 0 is none. `measure --flicker N` measures it.
    #[arg(long, value_name = "X", value_parser = number, help_heading = HEADING)]
    pub(crate) max_flicker: Option<f64>,
    /// Settings file to write.
    #[arg(short, long, value_name = "SETTINGS.ron")]
    pub(crate) output: Option<PathBuf>,
    /// Form of the answer.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: AnswerFormat,
    // The last: its heading holds for all that follow.
    #[command(flatten, next_help_heading = HEADING)]
    pub(crate) errors: ErrorLimits,
}

const HEADING: &str = "Limits, of which at least one is stated";
