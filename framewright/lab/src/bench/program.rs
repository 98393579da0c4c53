//! The program that measures, as the bench sees it.

use crate::error::Error;

/// The program that measures. One that implements no method keeps nothing, and doesn't stop.
pub trait Program {
    /// Whether it asks to stop.
    fn stops(&self) -> bool {
        false
    }

    /// Takes a note for people. The same note may come with each choice.
    fn note(&self, _note: &str) {}

    /// The words for an error of a choice, which its row keeps.
    fn words(&self, error: Error) -> String {
        error.to_string()
    }

    /// A file that was kept by a name, by this program or an earlier one; `None`: there is none.
    fn kept(&self, _name: &str) -> Option<Vec<u8>> {
        None
    }

    /// Keeps a file by a name, which may hold a folder: a picture of the results, or a reference.
    ///
    /// # Errors
    /// If it can't: the sweep ends.
    fn keep(&self, _name: &str, _contents: &[u8]) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        Ok(())
    }
}
