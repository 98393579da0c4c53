//! What `framewright explain` takes.

use super::pipeline::{PipelineArguments, PlanningArguments};
use super::scenes::SceneArguments;
use super::values::{AnswerFormat, DEFAULT_SIZE, Size};
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;

/// `framewright explain`.
#[derive(Debug, Args)]
pub(crate) struct ExplainArguments {
    #[command(flatten)]
    pub(crate) pipeline: PipelineArguments,
    /// The thing to explain: the name of a pass, an image or a buffer, or `step:3`, `resolve:color`, `barrier:color`, `heap:0`,
    /// `queue:compute`.
    #[arg(value_name = "THING")]
    pub(crate) thing: String,
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
    /// Form of the answer.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: AnswerFormat,
}
