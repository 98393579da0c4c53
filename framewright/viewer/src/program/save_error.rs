//! Why a frame couldn't be saved.

use framewright_graph::base::escape;
use std::io;
use std::path::PathBuf;

/// Why a frame couldn't be saved as a page.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The device didn't give what it left.
    #[error(transparent)]
    Frame(#[from] framewright::Error),
    /// Nothing was drawn.
    #[error("there is no frame yet")]
    NoFrame,
    /// The file can't be written.
    #[error("`{}` can't be written: {source}", escape(&path.to_string_lossy()))]
    Write {
        /// The file; of a lost device the folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
}
