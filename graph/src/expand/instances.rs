//! Fragments that were put in, in mistakes.

use crate::base::{Diagnostic, Label};
use crate::language::Pipeline;

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
