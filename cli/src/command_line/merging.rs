//! The command line of `framewright merge`.

use clap::Args;
use std::path::PathBuf;

/// `framewright merge`.
#[derive(Debug, Args)]
pub(crate) struct MergeArguments {
    /// Folders of results of one pipeline on one device.
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Folder to write, which is made if there is none.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}
