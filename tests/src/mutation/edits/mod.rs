//! The mistakes that a Plan offers room for.

mod barriers;
mod memory;
mod work;

use super::Kind;
use framewright_graph::plan::Plan;

/// One mistake.
pub(super) struct Edit {
    pub(super) kind: Kind,
    pub(super) change: String,
    pub(super) apply: Box<dyn Fn(&mut Plan)>,
}

impl Edit {
    fn new(kind: Kind, change: String, apply: impl Fn(&mut Plan) + 'static) -> Edit {
        Edit { kind, change, apply: Box::new(apply) }
    }
}

/// All of them.
pub(super) fn all(plan: &Plan) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (number, step) in plan.steps.iter().enumerate() {
        barriers::of_step(plan, number, step, &mut edits);
        work::of_step(plan, number, step, &mut edits);
    }
    memory::allocations(plan, &mut edits);
    edits
}
