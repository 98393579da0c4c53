//! The names that a program asks a recorder for, and that its pass doesn't name.

use super::custom_image::has_name;
use framewright_graph::plan::{Pass, Plan};
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

    /// Those that are an image or a buffer of the Plan and that the pass doesn't name, each once. What it names as a buffer may be asked
    /// for as an image, to find out which it is.
    pub(super) fn of(&self, plan: &Plan, pass: &Pass) -> Vec<String> {
        let asked = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_known = |name: &&String| {
            plan.images.iter().any(|image| *image.name == ***name) || plan.buffers.iter().any(|it| *it.name == ***name)
        };
        let mut unnamed: Vec<String> = Vec::new();
        for name in asked.iter().filter(is_known).filter(|name| !has_name(plan, pass, name)) {
            if !unnamed.contains(name) {
                unnamed.push(name.clone());
            }
        }
        unnamed
    }
}
