//! The checker catches every single thing that can be taken from a Plan in which nothing is superfluous.
//!
//! Caught means: some violation names both steps, the image and the part of it, or the buffer and its bytes. Totals are
//! made right again after each change, so that they can't give it away.

mod barriers;
mod memory;
mod queues;

use crate::testing::hand_written_plans::{self, names_all, recount};
pub(crate) use barriers::without_a_barrier;
use framewright_graph::plan::{Plan, Step};
use framewright_graph::verify::verify;

/// A changed Plan, and what was changed.
pub(crate) struct Mutant {
    pub(crate) change: String,
    pub(crate) plan: Plan,
}

/// Marks a place where there was nothing to change.
const UNCHANGED: &str = " (unchanged)";

/// Applies `change` at every place that it finds; it is given the number of the place and returns what it did.
fn mutants(plan: &Plan, change: impl Fn(&mut Plan, usize) -> Option<String>) -> Vec<Mutant> {
    let at = |place| {
        let mut plan = plan.clone();
        let change = change(&mut plan, place)?;
        recount(&mut plan);
        Some(Mutant { change, plan })
    };
    (0..).map_while(at).collect()
}

/// The barrier with this number, counted over all steps: step, index in it.
fn nth<T>(plan: &Plan, place: usize, of: impl Fn(&Step) -> &Vec<T>) -> Option<(usize, usize)> {
    let steps = plan.steps.iter().enumerate();
    steps.flat_map(|(step, described)| (0..of(described).len()).map(move |index| (step, index))).nth(place)
}

/// Checks all mutants of all Plans; those named in `harmless` must be accepted, all others caught.
fn catch_all(of: fn(&Plan) -> Vec<Mutant>, harmless: &[(&str, &str)]) {
    let (mut caught, mut missed, mut accepted) = (0, Vec::new(), Vec::new());
    for (name, plan) in hand_written_plans::all() {
        for Mutant { change, plan } in of(&plan).into_iter().filter(|mutant| !mutant.change.ends_with(UNCHANGED)) {
            let violations = verify(&plan);
            let change = format!("{name}: {change}");
            match violations.iter().find(|violation| names_all(violation)) {
                Some(violation) => {
                    caught += 1;
                    println!("caught  {change}\n        {violation}");
                    assert!(harmless.iter().all(|(listed, _)| *listed != change), "listed as harmless: {change}");
                }
                None if harmless.iter().any(|(listed, _)| *listed == change) => accepted.push(change),
                None => {
                    println!("missed  {change}");
                    violations.iter().for_each(|violation| println!("        {violation}"));
                    missed.push(change);
                }
            }
        }
    }
    println!("caught {caught}, missed {}, harmless {}", missed.len(), accepted.len());
    assert!(caught > 0, "nothing was changed");
    assert!(missed.is_empty(), "missed:\n{}", missed.join("\n"));
    assert_eq!(accepted.len(), harmless.len(), "harmless changes that no Plan offers");
}
