//! What `framewright attach` takes.

use clap::Args;
use std::path::PathBuf;

/// `framewright attach`.
#[derive(Debug, Args)]
pub(crate) struct AttachArguments {
    /// Address of the page as the program prints it, or where a tunnel to it begins: `http://127.0.0.1:7117/SECRET/`, or `HOST:PORT`.
    #[arg(value_name = "ADDRESS")]
    pub(crate) address: String,
    /// The secret part of the address, where ADDRESS lacks it.
    #[arg(long, value_name = "SECRET")]
    pub(crate) token: Option<String>,
    /// Open no browser.
    #[arg(long)]
    pub(crate) no_open: bool,
    /// File for the frame that the program draws, as a page that opens from disk. No browser is opened then.
    #[arg(long, value_name = "FILE.html")]
    pub(crate) save: Option<PathBuf>,
    /// Leave the texts of the pipeline's files out of that page.
    #[arg(long, requires = "save")]
    pub(crate) no_sources: bool,
    /// Print the answer as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}
