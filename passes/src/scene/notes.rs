//! Notes about content that isn't drawn.

use super::limits;

/// Sentences without final stop; the first few, then a count.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    shown: Vec<String>,
    omitted: usize,
}

impl Notes {
    /// Adds a sentence, once.
    pub(crate) fn add(&mut self, note: String) {
        if self.shown.contains(&note) {
        } else if self.shown.len() < limits::NOTES {
            self.shown.push(note);
        } else {
            self.omitted += 1;
        }
    }

    pub(crate) fn finish(mut self) -> Vec<String> {
        if self.omitted > 0 {
            self.shown.push(format!("and {} more like these", self.omitted));
        }
        self.shown
    }
}
