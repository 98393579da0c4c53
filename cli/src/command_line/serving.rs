//! What `framewright serve` takes.

use super::pipeline::{PipelineArguments, PlanningArguments};
use super::scenes::{DrawingDevice, DrawnScene};
use super::values::{DEFAULT_SIZE, Size};
use clap::Args;

/// `framewright serve`.
#[derive(Debug, Args)]
pub(crate) struct ServeArguments {
    #[command(flatten)]
    pub(crate) pipeline: PipelineArguments,
    #[command(flatten)]
    pub(crate) drawn: DrawnScene,
    /// Port of this machine's loopback address, 127.0.0.1; 0 takes any that is free.
    #[arg(long, value_name = "P", default_value_t = 7117)]
    pub(crate) port: u16,
    /// Size of the output in pixels.
    #[arg(long, value_name = "WxH", default_value_t = DEFAULT_SIZE)]
    pub(crate) size: Size,
    /// How many frames are drawn after each change; the pictures are those of the last.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) frames: u32,
    /// Draw every image after every pass that wrote it too, after each change.
    #[arg(long)]
    pub(crate) capture: bool,
    #[command(flatten)]
    pub(crate) planning: PlanningArguments,
    #[command(flatten)]
    pub(crate) device: DrawingDevice,
}
