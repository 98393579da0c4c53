//! Queues and frames: waits and releases removed, weakened or turned to others, states and successors that are wrong.

use super::{Mutant, UNCHANGED, catch_all, mutants, nth};
use crate::testing::hand_written_plans::{self, recount};
use framewright_graph::plan::{Plan, Queue, Role, StepId};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Accesses, Layout, Stages, State, Subresources};

fn without_a_wait(plan: &Plan) -> Vec<Mutant> {
    mutants(plan, |plan, place| {
        let (step, index) = nth(plan, place, |step| &step.waits)?;
        let wait = plan.steps[step].waits.remove(index);
        Some(format!("wait of step {step} for step {} removed", wait.step.0))
    })
}

fn with_a_weaker_wait(plan: &Plan) -> Vec<Mutant> {
    let mut all = mutants(plan, |plan, place| {
        let (step, index) = nth(plan, place, |step| &step.waits)?;
        let none = plan.steps[step].waits[index].stages.is_empty();
        plan.steps[step].waits[index].stages = Stages::empty();
        Some(format!("wait {index} of step {step} without stages{}", if none { UNCHANGED } else { "" }))
    });
    all.extend(mutants(plan, |plan, place| {
        let (step, index) = nth(plan, place, |step| &step.waits)?;
        plan.steps[step].waits[index].frames_ago += 1;
        Some(format!("wait {index} of step {step} for a frame earlier"))
    }));
    all
}

fn without_a_release(plan: &Plan) -> Vec<Mutant> {
    mutants(plan, |plan, place| {
        let (step, index) = nth(plan, place, |step| &step.releases)?;
        let barrier = plan.steps[step].releases.remove(index);
        Some(format!("release of `{}` after step {step} removed", plan.image(barrier.image).name))
    })
}

fn with_an_unequal_release(plan: &Plan) -> Vec<Mutant> {
    mutants(plan, |plan, place| {
        let (step, index) = nth(plan, place / 3, |step| &step.releases)?;
        let barrier = &mut plan.steps[step].releases[index];
        let what = match place % 3 {
            0 => {
                barrier.new_layout = Layout::TransferSrcOptimal;
                "in another layout"
            }
            1 => {
                barrier.ownership = barrier.ownership.map(|[from, _]| [from, Queue::Transfer]);
                "to another queue"
            }
            _ => {
                plan.steps[step].queue = Queue::Transfer;
                "on another queue"
            }
        };
        Some(format!("release {index} after step {step} {what}"))
    })
}

/// A barrier that hands over becomes one that only changes the layout.
fn handed_over_by_halves(plan: &Plan) -> Vec<Mutant> {
    mutants(plan, |plan, place| {
        let (step, index) = nth(plan, place, |step| &step.image_barriers)?;
        let transfer = plan.steps[step].image_barriers[index].ownership.take();
        let same = if transfer.is_none() { UNCHANGED } else { "" };
        Some(format!("barrier {index} before step {step} acquires nothing{same}"))
    })
}

#[test]
fn every_removed_wait_is_caught() {
    catch_all(without_a_wait, &[]);
}

#[test]
fn every_weakened_wait_is_caught() {
    catch_all(with_a_weaker_wait, &[]);
}

#[test]
fn every_removed_release_is_caught() {
    catch_all(without_a_release, &[]);
}

#[test]
fn every_release_that_differs_from_its_other_half_is_caught() {
    catch_all(with_an_unequal_release, &[]);
}

#[test]
fn every_barrier_that_acquires_nothing_is_caught() {
    catch_all(handed_over_by_halves, &[]);
}

fn said(plan: &mut Plan) -> Vec<String> {
    recount(plan);
    verify(plan).iter().map(ToString::to_string).collect()
}

fn plan(name: &str) -> Plan {
    let mut all = hand_written_plans::all().into_iter();
    all.find(|(other, _)| *other == name).unwrap_or_else(|| panic!("no Plan is called {name}")).1
}

fn becomes(plan: &mut Plan, image: usize) -> &mut u32 {
    match &mut plan.images[image].role {
        Role::Persistent { becomes, .. } => becomes,
        other => panic!("image {image} is not persistent: {other:?}"),
    }
}

#[test]
fn what_becomes_something_wrong_is_caught() {
    let changes: [(u32, &str); 4] = [
        (2, "`trail (2 frames ago)`: is what two others become in the next frame"),
        (0, "`trail`: is what two others become in the next frame"),
        (3, "`screen`: is what something persistent becomes in the next frame, and not persistent itself"),
        (99, "images[0] `trail` names images[99], but there are only 4"),
    ];
    for (wrong, expected) in changes {
        let mut plan = plan("history");
        *becomes(&mut plan, 0) = wrong;
        let said = said(&mut plan);
        assert!(said.iter().any(|violation| violation.contains(expected)), "{expected}: {said:#?}");
    }
    // A permutation, but the other way round: each is left in another state than its successor is found in.
    let mut backwards = plan("history");
    for (image, next) in [(0, 2), (2, 1), (1, 0)] {
        *becomes(&mut backwards, image) = next;
    }
    let said = said(&mut backwards);
    assert!(said.iter().any(|violation| violation.contains("is left in another state than")), "{said:#?}");
}

#[test]
fn what_becomes_something_of_another_kind_is_caught() {
    let mut plan = plan("history");
    plan.images[1].extent = [32, 32, 1];
    let said = said(&mut plan);
    assert_eq!(said.len(), 2, "{said:#?}");
    assert!(said[0].contains("`trail`: becomes something of another kind in the next frame"), "{said:#?}");
}

/// Only after as many frames as history is deep does the oldest image come round.
#[test]
fn a_state_that_is_wrong_only_frames_later_is_caught() {
    let mut plan = plan("history");
    // Without this barrier the read of the oldest contents doesn't find them visible, two frames after they were written.
    plan.steps[0].image_barriers.remove(1);
    let said = said(&mut plan);
    assert!(said[0].contains("the layout change by step 1 `tonemap` of the frame before"), "{said:#?}");
}

#[test]
fn a_state_that_is_promised_and_not_kept_is_caught() {
    let mut plan = plan("history");
    if let Role::External { after, .. } = &mut plan.images[3].role {
        after.stages = Stages::FRAGMENT_SHADER;
        after.accesses = Accesses::SHADER_SAMPLED_READ;
    }
    let said = said(&mut plan);
    let expected = "step 2 export: `screen` (COLOR, mip 0, layer 0): what relies on the state after the frame";
    assert!(said[0].starts_with(expected), "{said:#?}");
}

/// An image that is presented waits for the frame by a semaphore: no barrier need lead on to it.
#[test]
fn a_state_without_stages_follows_everything() {
    let mut plan = plan("history");
    let (none, nothing) = (Stages::empty(), Accesses::empty());
    if let Role::External { after, .. } = &mut plan.images[3].role {
        *after = State { stages: none, accesses: nothing, layout: Layout::PresentSrcKhr };
    }
    let export = &mut plan.steps[2].image_barriers[0];
    (export.dst_stages, export.dst_accesses, export.new_layout) = (none, nothing, Layout::PresentSrcKhr);
    assert_eq!(said(&mut plan), [""; 0]);
}

#[test]
fn waits_that_lead_nowhere_are_said() {
    let mut plan = plan("two queues");
    plan.steps[2].waits[0].step = StepId(3);
    plan.steps[3].waits[0].step = StepId(1);
    let said = said(&mut plan);
    assert!(said.iter().any(|it| it.ends_with("waits for step 3, which is not submitted before it")), "{said:#?}");
    assert!(said.iter().any(|it| it.ends_with("waits for step 1 on its own queue")), "{said:#?}");
}

#[test]
fn an_exclusive_buffer_on_two_queues_is_caught() {
    let mut plan = plan("two queues");
    plan.buffers[1].sharing = framewright_graph::vulkan::Sharing::Exclusive;
    let said = said(&mut plan);
    let expected = "step 2 `blur`: `lights` (bytes 0–512): used on COMPUTE, but it belongs to GRAPHICS since step 1 \
                    `scene` and isn't handed over";
    assert_eq!(said[0], expected);
    assert!(said[1..].iter().all(|violation| violation.contains("`lights`")), "{said:#?}");
}

#[test]
fn halves_of_a_transfer_with_other_ranges_are_caught() {
    let mut plan = plan("two queues");
    plan.images[0].mips = 2;
    for step in &mut plan.steps {
        for barrier in step.image_barriers.iter_mut().filter(|barrier| barrier.image.0 == 0) {
            barrier.range = Subresources { mips: 2, ..barrier.range };
        }
    }
    let said = said(&mut plan);
    assert!(said[0].contains("with another range, other layouts or queues than step 1 `scene`"), "{said:#?}");
}
