//! Dependencies that were dropped, and memory that was taken too soon.

use super::right;
use framewright_graph::compile::Options;
use framewright_graph::format::Format::R8G8B8A8_UNORM;
use framewright_graph::frame::{Blend, Frame, ImageIndex};
use framewright_graph::plan::{Hazard, Plan};
use framewright_graph::verify::verify;
use framewright_graph::vocabulary::Subresources;
use framewright_tests::frames::{Added, Builder};
use framewright_tests::happens_before::judge;

/// Makes a pass's only storage image a range of mip levels or layers.
fn part(pass: Added<'_>, range: Subresources) {
    pass.0.storage[0].range = range;
}

fn layers(base_layer: u32, layers: u32) -> Subresources {
    Subresources { base_layer, layers, ..Subresources::WHOLE }
}

/// Two passes write overlapping layers of one image, a third reads them all.
fn overlapping() -> Frame {
    let mut builder = Builder::default();
    let array = builder.image("array", R8G8B8A8_UNORM, 32, 1);
    builder.0.images[0].layers = 3;
    let out = builder.image("out", R8G8B8A8_UNORM, 32, 1);
    part(builder.dispatch("lower").store(array, false), layers(0, 2));
    part(builder.dispatch("upper").store(array, false), layers(1, 2));
    builder.dispatch("read").sample(array).store(out, false);
    builder.outputs(&[out])
}

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
    let mut builder = Builder::default();
    let images: Vec<ImageIndex> = (0..6).map(|at| builder.image(&format!("i{at}"), R8G8B8A8_UNORM, 64, 1)).collect();
    builder.full_screen("p0").color(images[0], Blend::Replace);
    for at in 1..6 {
        builder.full_screen(&format!("p{at}")).sample(images[at - 1]).color(images[at], Blend::Replace);
    }
    let plan = right(&builder.outputs(&[images[5]]), &Options::default());
    assert!(plan.totals.placed_bytes < plan.totals.transient_bytes, "memory is shared:\n{}", plan.tree());
    for less in without_a_barrier(&plan) {
        assert_ne!(judge(&less).harms, [], "{}", less.tree());
        assert_ne!(verify(&less), [], "{}", less.tree());
    }
}
