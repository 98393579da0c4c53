//! What `framewright window` takes.

use super::pipeline::{PipelineArguments, PlanningArguments};
use super::scenes::{DrawingDevice, DrawnScene};
use super::values::{DEFAULT_SIZE, Size};
use clap::Args;
use std::path::PathBuf;

/// `framewright window`.
#[derive(Debug, Args)]
pub(crate) struct WindowArguments {
    #[command(flatten)]
    pub(crate) pipeline: PipelineArguments,
    #[command(flatten)]
    pub(crate) drawn: DrawnScene,
    /// Size of the window in pixels, when it opens.
    #[arg(long, value_name = "WxH", default_value_t = DEFAULT_SIZE)]
    pub(crate) size: Size,
    /// How many frames are shown before the window closes by itself; by default it stays.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) frames: Option<u32>,
    /// Picture of the last frame, to write when the window closes: a .png file.
    #[arg(short, long, value_name = "FILE.png", value_parser = png_file)]
    pub(crate) output: Option<PathBuf>,
    /// Lay the list of settings and times over the picture from the beginning, as the key L does.
    #[arg(long)]
    pub(crate) list: bool,
    /// Run under the validation layer, first making sure that it sees mistakes. Warnings and errors are findings.
    #[arg(long)]
    pub(crate) validate: bool,
    #[command(flatten)]
    pub(crate) planning: PlanningArguments,
    #[command(flatten)]
    pub(crate) device: DrawingDevice,
}

/// The name of a PNG file.
fn png_file(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    match path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
        true => Ok(path),
        false => Err("a window's picture is a .png file".to_owned()),
    }
}
