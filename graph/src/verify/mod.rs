//! An independent checker: a Plan goes in, violations come out.
//!
//! It shares no code with the stages that make Plans and believes none of their claims: why a barrier is there, what it
//! waits for, whose memory it hands over. From steps, barriers and placements alone it works out, for each part of each
//! image, whether every access comes after what it conflicts with (`dependencies`), finds its image in the layout that it
//! names (`walk`), reads what was written (`contents`) and has its memory to itself (`memory`); and whether the Plan
//! is well formed at all (`structure`, `work`). The steps are walked twice in a row, for what crosses frames.
//!
//! The work is linear in steps, barriers and accesses: see `clocks` and `cells`.

mod cells;
mod clocks;
mod contents;
mod dependencies;
mod memory;
mod scopes;
mod structure;
mod survey;
mod touches;
mod violation;
mod walk;
mod work;

pub use violation::{Loss, Rule, StepName, Touched, Violation};

use crate::plan::{ImageId, Plan, StepId, Subresources};
use std::collections::HashSet;
use std::mem::Discriminant;

/// Checks a Plan. Nothing found means: every access is synchronised, in the right layout, defined, and in memory of its
/// own, in every frame that follows on a frame of the same Plan.
///
/// One cause is reported once: what only follows from a reported mistake, or repeats it in the next frame, is left out.
/// A Plan that is malformed so badly that its steps can't be followed gets only that said.
#[must_use]
pub fn verify(plan: &Plan) -> Vec<Violation> {
    let mut found = Findings { plan, violations: Vec::new(), seen: HashSet::new() };
    if let Err(error) = plan.check_references() {
        found.structure(None, None, error.to_string());
        return found.violations;
    }
    if structure::check(plan, &mut found) {
        work::check(plan, &mut found);
        let survey = survey::survey(plan, &mut found);
        walk::twice(plan, &survey, &mut found);
    }
    found.violations
}

/// What was found so far.
struct Findings<'p> {
    plan: &'p Plan,
    violations: Vec<Violation>,
    seen: HashSet<(Discriminant<Rule>, StepId, ImageId)>,
}

/// A mistake that concerns an image.
struct Finding {
    rule: Rule,
    step: StepId,
    other: Option<StepName>,
    image: ImageId,
    range: Option<Subresources>,
    bytes: Option<[u64; 2]>,
}

impl Findings<'_> {
    /// Adds a mistake, unless the same rule was broken by the same step on the same image before.
    fn push(&mut self, finding: Finding) {
        let Finding { rule, step, other, image, range, bytes } = finding;
        if self.seen.insert((std::mem::discriminant(&rule), step, image)) {
            let step = Some(StepName::new(self.plan, step, false));
            let image = Some(self.plan.image(image).name.clone());
            self.violations.push(Violation { rule, step, other, image, range, bytes });
        }
    }

    /// Adds a mistake of form.
    fn structure(&mut self, step: Option<StepId>, image: Option<ImageId>, what: impl Into<String>) {
        self.violations.push(Violation {
            rule: Rule::Structure { what: what.into() },
            step: step.map(|step| StepName::new(self.plan, step, false)),
            other: None,
            image: image.map(|image| self.plan.image(image).name.clone()),
            range: None,
            bytes: None,
        });
    }
}
