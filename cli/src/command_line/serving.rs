//! What `framewright serve` takes.

use super::pipeline::{PipelineArguments, PlanningArguments};
use super::scenes::SceneArguments;
use super::values::{DEFAULT_SIZE, Size};
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;

/// `framewright serve`.
#[derive(Debug, Args)]
pub(crate) struct ServeArguments {
    #[command(flatten)]
    pub(crate) pipeline: PipelineArguments,
    /// Scene to draw: a .glb or .gltf file, or a scene of our own in RON.
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    pub(crate) reading: SceneArguments,
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
    /// Device to draw on: its number or name in `framewright devices`, or a part of its name.
    #[arg(long, value_name = "NAME|INDEX")]
    pub(crate) device: Option<OsString>,
}
