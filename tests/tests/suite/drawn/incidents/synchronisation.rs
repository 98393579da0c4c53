//! Dependencies that were dropped, and memory that was taken too soon.

use super::right;
use framewright_graph::compile::Options;
use framewright_graph::plan::{Hazard, Image, Plan, Role};
use framewright_graph::verify::verify;
use framewright_tests::happens_before::judge;
use framewright_tests::incidents::{history, memory_shared, overlapping};

/// Every Plan that lacks one of the barriers.
fn without_a_barrier(plan: &Plan) -> Vec<Plan> {
    let mut all = Vec::new();
    for step in 0..plan.steps.len() {
        for barrier in 0..plan.steps[step].image_barriers.len() {
            let mut less = plan.clone();
            less.steps[step].image_barriers.remove(barrier);
            all.push(less);
        }
    }
    all
}

/// A write was forgotten where draw lists overlap in part; two writes in a row raced.
#[test]
fn godot_99073_and_114092_writes_that_overlap_in_part_follow_each_other() {
    let plan = right(&overlapping(), &Options { alias: false, ..Options::default() });
    let again = |hazard: Hazard| {
        plan.steps.iter().flat_map(|step| &step.image_barriers).any(|barrier| barrier.hazard == hazard)
    };
    assert!(again(Hazard::WriteAfterWrite) && again(Hazard::ReadAfterWrite), "{}", plan.tree());
    for less in without_a_barrier(&plan) {
        assert_ne!(judge(&less).harms, [], "{}", less.tree());
        assert_ne!(verify(&less), [], "{}", less.tree());
    }
}

/// A transient image was discarded before the barrier that hands its memory over.
#[test]
fn o3de_20073_memory_is_handed_over_before_it_is_taken() {
    let plan = right(&memory_shared(), &Options::default());
    assert!(plan.totals.placed_bytes < plan.totals.transient_bytes, "memory is shared:\n{}", plan.tree());
    for less in without_a_barrier(&plan) {
        assert_ne!(judge(&less).harms, [], "{}", less.tree());
        assert_ne!(verify(&less), [], "{}", less.tree());
    }
}

/// History of the frame before was overwritten, since a key by which images were used again left a field out.
#[test]
fn unity_2141_history_is_nobody_elses_memory_and_stays_as_long_as_it_is_said_to() {
    for frames in 1..=4 {
        let plan = right(&history(frames), &Options::default());
        let kept: Vec<&Image> = plan.images.iter().filter(|image| image.name.starts_with("trail")).collect();
        assert_eq!(kept.len(), frames as usize + 1, "{}", plan.tree());
        assert!(kept.iter().all(|image| matches!(image.role, Role::Persistent { .. })), "{}", plan.tree());
        // One frame less, and the oldest contents are overwritten while they are still needed.
        let mut stomped = plan.clone();
        let roles = stomped.images.iter_mut().filter(|image| image.name.starts_with("trail"));
        for (image, becomes) in roles.zip(kept.iter().map(|image| image.id.0)) {
            if let Role::Persistent { becomes: next, .. } = &mut image.role {
                *next = becomes;
            }
        }
        assert_ne!(judge(&stomped).outcome, judge(&plan).outcome, "{}", plan.tree());
    }
}
