//! An independent checker: a Plan goes in, violations come out.
//!
//! It shares no code with the stages that make Plans and believes none of their claims: why a barrier is there, what it
//! waits for, whose memory it hands over. From steps, waits, barriers and placements alone it works out, for each part of
//! each image and for each buffer, whether every access comes after what it conflicts with (`dependencies`), finds its
//! image in the layout that it names (`walk`) and on its own queue (`ownership`, and `outside_owners` of what others have between frames), reads what was written (`contents`) and
//! has its memory to itself (`memory`); and whether the Plan is well formed at all (`structure`, `barriers`, `work`,
//! `passes`, `redraws`, `rotation`, `transfers`). The steps are walked at least twice in a row, for what
//! crosses frames, and as often as it takes for everything with history to have been everything (`frames`). Where steps don't run in
//! each frame, they are walked again without these (`left_out`).
//!
//! The work is linear in steps, barriers and accesses: see `clocks`, `parts` and `program`.
//! Most Plans are right, so what reports is marked `cold`, which saves 5 % of the instructions, and what is large or rare is kept
//! apart by `inline(never)`, which saves 6 to 9 %.

mod accesses;
mod barriers;
mod boundaries;
mod clocks;
mod contents;
mod declared_uses;
mod dependencies;
mod eyes;
mod findings;
mod frames;
mod layers_of_eyes;
mod layouts;
mod left_out;
mod lookup;
mod memory;
mod names;
mod outside_owners;
mod owners;
mod ownership;
mod part_in_use;
mod parts;
mod passes;
mod program;
mod redraws;
mod rotation;
mod scopes;
mod structure;
mod subresources;
mod totals;
mod transfers;
mod violation;
mod walk;
mod work;

pub use violation::{Accessed, Loss, OwnershipFault, Rule, StepName, Violation};

use crate::plan::Plan;
use findings::Findings;

/// Checks a Plan. Nothing found means: every access is synchronised, on a queue that may make it, in the right layout,
/// defined, and in memory of its own, in every frame that follows on frames of the same Plan.
///
/// One cause is reported once: what only follows from a reported mistake, or repeats it in the next frame, is left out.
/// A Plan that is malformed so badly that its steps can't be followed gets only that said.
#[must_use]
pub fn verify(plan: &Plan) -> Vec<Violation> {
    let mut found = Findings::new(plan);
    if let Err(error) = plan.check_references() {
        found.structure(None, None, error.to_string());
    } else if let Some(frames) = structure::check(plan, &mut found)
        && let Some(program) = work::check(plan, &mut found)
    {
        redraws::check(plan, &mut found);
        rotation::check(plan, &mut found);
        eyes::check(plan, &mut found);
        outside_owners::check(plan, &mut found);
        walk::walk(plan, &program, frames, &mut found);
        // Last: any other mistake makes totals wrong too.
        totals::check(plan, &mut found);
    }
    found.violations
}
