//! An independent checker: a Plan goes in, violations come out.
//!
//! It shares no code with the stages that make Plans and believes none of their claims: why a barrier is there, what it
//! waits for, whose memory it hands over. From steps, waits, barriers and placements alone it works out, for each part of
//! each image and for each buffer, whether every access comes after what it conflicts with (`dependencies`), finds its
//! image in the layout that it names (`walk`) and on its own queue (`ownership`), reads what was written (`contents`) and
//! has its memory to itself (`memory`); and whether the Plan is well formed at all (`structure`, `barriers`, `work`,
//! `passes`, `redraws`, `rotation`, `transfers`). The steps are walked at least twice in a row, for what
//! crosses frames, and as often as it takes for everything with history to have been everything (`frames`).
//!
//! The work is linear in steps, barriers and accesses: see `clocks`, `parts` and `program`.

mod barriers;
mod cells;
mod clocks;
mod contents;
mod dependencies;
mod eyes;
mod frames;
mod memory;
mod ownership;
mod parts;
mod passes;
mod program;
mod redraws;
mod rotation;
mod scopes;
mod structure;
mod totals;
mod touches;
mod transfers;
mod violation;
mod walk;
mod work;

pub use violation::{Loss, OwnershipFault, Rule, StepName, Touched, Violation};

use crate::plan::{Plan, Role, StepId, Subresources};
use std::collections::HashSet;
use std::mem::Discriminant;
use std::sync::Arc;

/// Checks a Plan. Nothing found means: every access is synchronised, on a queue that may make it, in the right layout,
/// defined, and in memory of its own, in every frame that follows on frames of the same Plan.
///
/// One cause is reported once: what only follows from a reported mistake, or repeats it in the next frame, is left out.
/// A Plan that is malformed so badly that its steps can't be followed gets only that said.
#[must_use]
pub fn verify(plan: &Plan) -> Vec<Violation> {
    let mut found = Findings { plan, violations: Vec::new(), seen: HashSet::new() };
    if let Err(error) = plan.check_references() {
        found.structure(None, None, error.to_string());
    } else if let Some(frames) = structure::check(plan, &mut found)
        && let Some(program) = work::check(plan, &mut found)
    {
        totals::check(plan, &mut found);
        redraws::check(plan, &mut found);
        rotation::check(plan, &mut found);
        eyes::check(plan, &mut found);
        walk::walk(plan, &program, frames, &mut found);
    }
    found.violations
}

/// What was found so far.
struct Findings<'p> {
    plan: &'p Plan,
    violations: Vec<Violation>,
    seen: HashSet<(Discriminant<Rule>, StepId, u32)>,
}

/// A mistake that concerns an image or a buffer. Those are numbered in one row, buffers after images.
struct Finding {
    rule: Rule,
    step: StepId,
    other: Option<StepName>,
    resource: u32,
    range: Option<Subresources>,
    bytes: Option<[u64; 2]>,
}

impl Findings<'_> {
    /// Adds a mistake, unless the same rule was broken by the same step on the same image or buffer before.
    fn push(&mut self, finding: Finding) {
        let Finding { rule, step, other, resource, range, bytes } = finding;
        if self.seen.insert((std::mem::discriminant(&rule), step, resource)) {
            let step = Some(StepName::new(self.plan, step, 0));
            let resource = Some(name(self.plan, resource).clone());
            self.violations.push(Violation { rule, step, other, resource, range, bytes });
        }
    }

    /// Adds a mistake of form.
    fn structure(&mut self, step: Option<StepId>, resource: Option<u32>, what: impl Into<String>) {
        self.violations.push(Violation {
            rule: Rule::Structure { what: what.into() },
            step: step.map(|step| StepName::new(self.plan, step, 0)),
            other: None,
            resource: resource.map(|resource| name(self.plan, resource).clone()),
            range: None,
            bytes: None,
        });
    }
}

/// The name of an image or buffer.
fn name(plan: &Plan, resource: u32) -> &Arc<str> {
    let resource = resource as usize;
    match plan.images.get(resource) {
        Some(image) => &image.name,
        None => &plan.buffers[resource - plan.images.len()].name,
    }
}

/// Where the memory of an image or buffer comes from.
fn role(plan: &Plan, resource: u32) -> &Role {
    let resource = resource as usize;
    match plan.images.get(resource) {
        Some(image) => &image.role,
        None => &plan.buffers[resource - plan.images.len()].role,
    }
}
