//! Reads: the settings and facts that a lowering asks for.

use super::facts::Fact;
use std::cell::RefCell;

/// A setting or a fact that was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Read {
    /// The setting with this number, in the order of the document.
    Setting(usize),
    /// A fact of the scene.
    Fact(Fact),
}

/// The settings and facts that were asked for, each once, in the order in which they were first asked for.
///
/// The values that were found decide what is asked for next. So two evaluations of a document that find the same values for
/// the same reads, from the first on, read the same and have the same result.
#[derive(Debug, Default)]
pub struct Reads(RefCell<Vec<Read>>);

impl Reads {
    /// Adds a read, unless it is known.
    pub(crate) fn add(&self, read: Read) {
        let mut reads = self.0.borrow_mut();
        if !reads.contains(&read) {
            reads.push(read);
        }
    }

    /// All reads in their order.
    #[must_use]
    pub fn in_order(self) -> Vec<Read> {
        self.0.into_inner()
    }
}
