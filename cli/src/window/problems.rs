//! What keeps the newest files and choices from being shown: it can be mended, and the last good frame stays.

use crate::error::Error;
use crate::system::text;

/// What is wrong, as the terminal shows it.
#[derive(Default)]
pub(super) struct Problems {
    /// What keeps the files from being shown as they are, until they are read again.
    mistake: Option<String>,
    /// What keeps the newest choices from being shown, until others are made.
    refused: Option<String>,
}

impl Problems {
    /// Keeps a mistake in files, and says it once.
    ///
    /// # Errors
    /// Those that no change to a file mends.
    pub(super) fn mistake(&mut self, result: Result<(), Error>) -> Result<(), Error> {
        keep(result, &mut self.mistake)
    }

    /// Keeps why a choice is refused, and says it once.
    ///
    /// # Errors
    /// Those that no other choice mends.
    pub(super) fn refuse(&mut self, result: Result<(), Error>) -> Result<(), Error> {
        keep(result, &mut self.refused)
    }

    /// The files are right as they are now.
    pub(super) fn mended(&mut self) {
        self.mistake = None;
    }

    /// There are other choices now.
    pub(super) fn choices_changed(&mut self) {
        self.refused = None;
    }

    /// What is wrong, the files before the choices.
    pub(super) fn first(&self) -> Option<&str> {
        self.mistake.as_deref().or(self.refused.as_deref())
    }
}

/// Keeps an error that a change to a file or another choice can mend, and says it, unless it was said last.
fn keep(result: Result<(), Error>, kept: &mut Option<String>) -> Result<(), Error> {
    match result {
        Err(error) if error.can_be_mended_in_files() => {
            let shown = error.shown();
            if kept.as_ref() != Some(&shown) {
                text::say(&shown);
                *kept = Some(shown);
            }
            Ok(())
        }
        other => other,
    }
}
