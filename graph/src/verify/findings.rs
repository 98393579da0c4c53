//! Violations as they are found, each cause once.

use super::violation::{Rule, StepName, Violation};
use crate::plan::{Plan, Role, StepId};
use crate::vulkan::Subresources;
use std::collections::HashSet;
use std::mem::Discriminant;
use std::sync::Arc;

/// The violations that were found so far.
pub(super) struct Findings<'p> {
    pub(super) plan: &'p Plan,
    pub(super) violations: Vec<Violation>,
    pub(super) seen: HashSet<(Discriminant<Rule>, StepId, u32)>,
}

/// A mistake that concerns an image or a buffer. Those are numbered in one row, buffers after images.
pub(super) struct Finding {
    pub(super) rule: Rule,
    pub(super) step: StepId,
    pub(super) other: Option<StepName>,
    pub(super) resource: u32,
    pub(super) range: Option<Subresources>,
    pub(super) bytes: Option<[u64; 2]>,
}

impl<'p> Findings<'p> {
    pub(super) fn new(plan: &'p Plan) -> Findings<'p> {
        Findings { plan, violations: Vec::new(), seen: HashSet::new() }
    }

    /// Adds a mistake, unless the same rule was broken by the same step on the same image or buffer before.
    #[cold]
    pub(super) fn push(&mut self, finding: Finding) {
        let Finding { rule, step, other, resource, range, bytes } = finding;
        if self.seen.insert((std::mem::discriminant(&rule), step, resource)) {
            let step = Some(StepName::new(self.plan, step, 0));
            let resource = Some(name(self.plan, resource).clone());
            self.violations.push(Violation { rule, step, other, resource, range, bytes });
        }
    }

    /// Adds a mistake of form.
    #[cold]
    pub(super) fn structure(&mut self, step: Option<StepId>, resource: Option<u32>, what: impl Into<String>) {
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
pub(super) fn name(plan: &Plan, resource: u32) -> &Arc<str> {
    let resource = resource as usize;
    match plan.images.get(resource) {
        Some(image) => &image.name,
        None => &plan.buffers[resource - plan.images.len()].name,
    }
}

/// Where the memory of an image or buffer comes from.
pub(super) fn role(plan: &Plan, resource: u32) -> &Role {
    let resource = resource as usize;
    match plan.images.get(resource) {
        Some(image) => &image.role,
        None => &plan.buffers[resource - plan.images.len()].role,
    }
}
