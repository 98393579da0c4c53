//! The uses of a step.

use crate::compile::model::{AdaptedFrame, PhysicalIndex, Use};
use crate::compile::scope::Step;
use crate::vulkan::Layout;

/// Every use of a step, those of the resolves folded into its scope too.
pub(super) fn uses_of<'a>(adapted: &'a AdaptedFrame, step: &'a Step) -> impl Iterator<Item = &'a Use> + 'a {
    let resolve_targets = if let Step::Scope(scope) = step { Some(scope.folded_resolves()) } else { None };
    let ops = step.ops().iter().copied().chain(resolve_targets.into_iter().flatten());
    ops.flat_map(|op| adapted.uses(op))
}

/// Every image and buffer that a step uses, whether it writes it, and in which layout.
pub(super) fn uses<'a>(
    adapted: &'a AdaptedFrame,
    step: &'a Step,
) -> impl Iterator<Item = (PhysicalIndex, bool, Layout)> + 'a {
    uses_of(adapted, step).map(|used| (used.resource, used.writes, used.layout))
}
