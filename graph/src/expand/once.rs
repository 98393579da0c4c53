//! Repeated declarations, and those of a fragment that is used several times, are written once: so each mistake in them is
//! reported once.

use crate::base::{Diagnostic, Span};
use std::collections::HashMap;

/// Mistakes that were reported already, by place and wording, each with the number of the item that it was reported for.
#[derive(Default)]
pub(super) struct Said {
    by: HashMap<(Span, String), u32>,
    next: u32,
}

impl Said {
    /// Removes repeated mistakes of one image, buffer or pass, which stand in `errors` from `start` on: those that another item
    /// of the same declaration has. They have the same place and the same words but for names and numbers.
    pub(super) fn once(&mut self, errors: &mut Vec<Diagnostic>, start: usize) {
        if errors.len() == start {
            return;
        }
        self.next += 1;
        let new: Vec<Diagnostic> = errors.drain(start..).collect();
        errors.extend(new.into_iter().filter(|error| {
            let Some(at) = error.labels.first() else { return true };
            *self.by.entry((at.span, wording(&error.message))).or_insert(self.next) == self.next
        }));
    }

    /// Removes repeated mistakes as [`Said::once`] does, where each mistake belongs to another image, buffer or pass.
    pub(super) fn each_once(&mut self, errors: &mut Vec<Diagnostic>, start: usize) {
        let new: Vec<Diagnostic> = errors.drain(start..).collect();
        for error in new {
            let at = errors.len();
            errors.push(error);
            self.once(errors, at);
        }
    }
}

/// A message without its quotes in backticks, and without digits.
fn wording(message: &str) -> String {
    let outside = message.split('`').step_by(2);
    outside.flat_map(str::chars).filter(|c| !c.is_ascii_digit()).collect()
}
