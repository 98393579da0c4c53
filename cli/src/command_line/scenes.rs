//! How scenes are read.

use clap::Args;

/// How a scene's file is read.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct SceneArguments {
    /// Refuse a scene whose file has a mistake. Without this the part with the mistake is left out, or a number is taken as the nearest that
    /// is right, and a note tells of it.
    #[arg(long)]
    pub(crate) strict: bool,
}
