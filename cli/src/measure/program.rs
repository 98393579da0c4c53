//! The command, as the bench sees it: it keeps files in the folder of the results, and Ctrl-C stops it.

use crate::error::Error;
use crate::files::{inputs, outputs};
use crate::system::{interrupt, text};
use framewright_graph::base::ReadFiles;
use framewright_lab::Error as LabError;
use framewright_lab::bench::Program;
use std::path::Path;

/// The folder of a sweep's results.
pub(super) struct Folder<'a> {
    pub(super) path: &'a Path,
    /// The files that the command has read: none of them is written.
    pub(super) read: &'a ReadFiles,
}

impl Program for Folder<'_> {
    fn stops(&self) -> bool {
        interrupt::asked()
    }

    fn note(&self, note: &str) {
        text::note_once(note);
    }

    fn words(&self, error: LabError) -> String {
        Error::from(error).to_string()
    }

    fn kept(&self, name: &str) -> Option<Vec<u8>> {
        // It isn't recorded as read: one that is damaged is written again.
        inputs::measured_picture(&self.path.join(name), &ReadFiles::default()).ok()
    }

    fn keep(&self, name: &str, contents: &[u8]) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        Ok(outputs::write(&[(&self.path.join(name), contents)], self.read)?)
    }
}
