//! Repeated declarations, and those of a fragment that is used several times, are written once: so each mistake in them is
//! reported once.

use crate::base::{Diagnostic, Span};
use std::collections::HashMap;
use std::panic::Location;

/// Mistakes that were reported already, by place and check, each with the number of the item that it was reported for.
#[derive(Default)]
pub(super) struct Reported {
    by: HashMap<(Span, Option<&'static Location<'static>>), u32>,
    next: u32,
}

impl Reported {
    /// Removes repeated mistakes of one image, buffer or pass, which stand in `errors` from `start` on: those that another item
    /// of the same declaration has. The same check found them at the same place.
    pub(super) fn once(&mut self, errors: &mut Vec<Diagnostic>, start: usize) {
        if errors.len() == start {
            return;
        }
        self.next += 1;
        let new: Vec<Diagnostic> = errors.drain(start..).collect();
        errors.extend(new.into_iter().filter(|error| {
            let Some(at) = error.labels.first() else { return true };
            *self.by.entry((at.span, error.check)).or_insert(self.next) == self.next
        }));
    }

    /// Removes repeated mistakes as [`Reported::once`] does, where no image, buffer or pass has more than one of them.
    pub(super) fn each_once(&mut self, errors: &mut Vec<Diagnostic>, start: usize) {
        let new: Vec<Diagnostic> = errors.drain(start..).collect();
        for error in new {
            let at = errors.len();
            errors.push(error);
            self.once(errors, at);
        }
    }
}
