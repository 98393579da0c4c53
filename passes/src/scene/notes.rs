//! Notes about content that isn't drawn.

use super::limits;

/// Sentences without final stop; the first few, then a count.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    said: Vec<String>,
    unsaid: usize,
}

impl Notes {
    /// Adds a sentence, once.
    pub(crate) fn add(&mut self, note: String) {
        if self.said.contains(&note) {
        } else if self.said.len() < limits::NOTES {
            self.said.push(note);
        } else {
            self.unsaid += 1;
        }
    }

    pub(crate) fn finish(mut self) -> Vec<String> {
        if self.unsaid > 0 {
            self.said.push(format!("and {} more like these", self.unsaid));
        }
        self.said
    }
}
