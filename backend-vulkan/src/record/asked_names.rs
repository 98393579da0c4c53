//! The names that a program asks a recorder for, and that its pass doesn't name.

use framewright_graph::plan::Plan;
use std::sync::{Mutex, PoisonError};

/// Names that were asked for in vain.
#[derive(Default)]
pub(super) struct AskedNames(Mutex<Vec<String>>);

impl AskedNames {
    /// What was found for a name. If nothing was, the name is kept.
    pub(super) fn note<T>(&self, name: &str, found: Option<T>) -> Option<T> {
        if found.is_none() {
            self.0.lock().unwrap_or_else(PoisonError::into_inner).push(name.to_owned());
        }
        found
    }

    /// Those that are an image or a buffer of the Plan.
    pub(super) fn of(&self, plan: &Plan) -> Vec<String> {
        let asked = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_known = |name: &&String| {
            plan.images.iter().any(|image| *image.name == ***name) || plan.buffers.iter().any(|it| *it.name == ***name)
        };
        asked.iter().filter(is_known).cloned().collect()
    }
}
