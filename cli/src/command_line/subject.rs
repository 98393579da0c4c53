//! What a Plan is made for where nothing is drawn, and how it is made.

use super::pipeline::PlanningArguments;
use super::scenes::SceneArguments;
use super::values::{DEFAULT_SIZE, Size};
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;

/// A scene, a size and a device, and how a Plan is made for them.
#[derive(Debug, Clone, Args)]
pub(crate) struct SubjectArguments {
    /// Scene whose facts conditions see; without one they see a scene that holds everything.
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) reading: SceneArguments,
    /// Size of the output in pixels.
    #[arg(long, value_name = "WxH", default_value_t = DEFAULT_SIZE)]
    pub(crate) size: Size,
    /// Device to compile for: the name of a shipped profile, or a profile file.
    #[arg(long, value_name = "NAME|PROFILE.ron")]
    pub(crate) device: Option<OsString>,
    #[command(flatten)]
    pub(crate) planning: PlanningArguments,
}

impl SubjectArguments {
    /// An option of these that is given, if there is one. A Plan leaves nothing to choose.
    #[must_use]
    pub(crate) fn chosen(&self) -> Option<&'static str> {
        match self {
            SubjectArguments { scene: Some(_), .. } => Some("--scene"),
            SubjectArguments { device: Some(_), .. } => Some("--device"),
            SubjectArguments { size, .. } if *size != DEFAULT_SIZE => Some("--size"),
            _ => None,
        }
    }
}
