//! The outline of a Plan that is too large to be looked at step by step.

use framewright_graph::plan::{About, Outline, Plan};

/// At most this many lines of one kind are left.
const MOST: usize = 200;

/// The outline with the steps that move most, and of each list the first lines.
pub(super) fn shortened(plan: &Plan, outline: Outline) -> Outline {
    let mut costs: Vec<(u64, usize)> =
        plan.steps.iter().enumerate().map(|(at, step)| (plan.moved_by(step).sum(), at)).collect();
    costs.sort_unstable_by(|one, other| other.cmp(one));
    costs.truncate(MOST);
    let kept: std::collections::BTreeSet<usize> = costs.into_iter().map(|(_, at)| at).collect();
    let is_left = |line: &Outline| match &line.about {
        Some(About::Step(step)) => kept.contains(&(step.0 as usize)),
        _ => true,
    };
    let parts = outline.parts.into_iter().filter(is_left).map(|mut line| {
        line.parts.truncate(MOST);
        line
    });
    Outline { parts: parts.collect(), ..outline }
}
