//! Mistakes of what stands in the file once and in the frame several times: repeated declarations and fragments.

use crate::base::{Diagnostic, Label, Span};
use crate::language::Pipeline;
use std::collections::HashMap;
use std::panic::Location;

/// Mistakes that were reported already, by place and check, each with the number of the item that it was reported for.
#[derive(Default)]
pub(super) struct ReportedMistakes {
    by: HashMap<(Span, Option<&'static Location<'static>>), u32>,
    next: u32,
}

impl ReportedMistakes {
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

    /// Removes repeated mistakes as [`ReportedMistakes::once`] does, where no image, buffer or pass has more than one of them.
    pub(super) fn each_once(&mut self, errors: &mut Vec<Diagnostic>, start: usize) {
        let new: Vec<Diagnostic> = errors.drain(start..).collect();
        for error in new {
            let at = errors.len();
            errors.push(error);
            self.once(errors, at);
        }
    }
}

/// Says of mistakes in a fragment where it was used.
pub(super) fn used_here(pipeline: &Pipeline, instance: Option<u32>, errors: &mut [Diagnostic]) {
    let mut next = instance;
    while let Some(instance) = next.and_then(|at| pipeline.instances.get(at as usize)) {
        for error in errors.iter_mut() {
            error.labels.push(Label::of_use(instance.span, &instance.name));
        }
        next = instance.within;
    }
}
