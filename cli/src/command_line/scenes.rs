//! Scenes: how they are read, and on which device they are drawn.

use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;

/// How a scene's file is read.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct SceneArguments {
    /// Refuse a scene whose file has a mistake. Without this the part with the mistake is left out, or a number is taken as the nearest that
    /// is right, and a note tells of it.
    #[arg(long)]
    pub(crate) strict: bool,
}

/// A scene that is drawn.
#[derive(Debug, Args)]
pub(crate) struct DrawnScene {
    /// Scene to draw: a .glb or .gltf file, or a scene of our own in RON.
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    pub(crate) reading: SceneArguments,
}

/// The device that draws.
#[derive(Debug, Args)]
pub(crate) struct DrawingDevice {
    /// Device to draw on: its number or name in `framewright devices`, or a part of its name.
    #[arg(long = "device", value_name = "NAME|INDEX")]
    pub(crate) name: Option<OsString>,
}
