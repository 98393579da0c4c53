//! The uses of a step.

use crate::compile::model::{Adapted, Use};
use crate::compile::scope::Step;

/// Every use of a step, those of the resolves folded into its scope too.
pub(super) fn uses_of<'a>(adapted: &'a Adapted, step: &'a Step) -> impl Iterator<Item = &'a Use> + 'a {
    let resolve_targets = if let Step::Scope(scope) = step { Some(scope.folded_resolves()) } else { None };
    let ops = step.ops().iter().copied().chain(resolve_targets.into_iter().flatten());
    ops.flat_map(|op| adapted.uses(op))
}
