//! Notes about what of a file isn't drawn, and about mistakes in it that were passed over.

use crate::scene::limits;

/// Sentences without final stop.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    notes: Sentences,
    mistakes: Sentences,
}

/// The first few, then a count.
#[derive(Debug, Default)]
struct Sentences {
    shown: Vec<String>,
    omitted: usize,
}

impl Notes {
    /// Adds a sentence about what is right and isn't drawn, once.
    pub(crate) fn add(&mut self, note: String) {
        self.notes.add(note);
    }

    /// Adds a sentence about a mistake, and about what was left out or changed because of it, once.
    pub(crate) fn mistake(&mut self, mistake: String) {
        self.mistakes.add(mistake);
    }

    /// The notes and the mistakes.
    pub(crate) fn finish(self) -> (Vec<String>, Vec<String>) {
        (self.notes.finish(), self.mistakes.finish())
    }
}

impl Sentences {
    fn add(&mut self, sentence: String) {
        if self.shown.contains(&sentence) {
        } else if self.shown.len() < limits::NOTES {
            self.shown.push(sentence);
        } else {
            self.omitted += 1;
        }
    }

    fn finish(mut self) -> Vec<String> {
        if self.omitted > 0 {
            self.shown.push(format!("and {} more like these", self.omitted));
        }
        self.shown
    }
}
