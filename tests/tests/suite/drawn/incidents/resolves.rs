//! Resolves that were lost, doubled, wrong, or dearer than they need be.

use super::{attachments, bound, resolves, right, scopes};
use framewright_graph::compile::Options;
use framewright_graph::frame::{ImageIndex, Resource};
use framewright_graph::vulkan::{Aspects, ResolveMode, StoreOp};
use framewright_tests::incidents::{depth_sampled, forward, prepass, scaled, two_versions, weighted};

/// The pass that carried the resolve was skipped, and the screen was black.
#[test]
fn godot_81910_the_resolve_stays_when_nothing_transparent_is_drawn() {
    for transparent in [true, false] {
        let plan = right(&forward(transparent), &Options::default());
        assert_eq!(resolves(&plan).len(), 1, "{}", plan.tree());
        assert_eq!(bound(&plan, "show", "source0").samples, 1);
    }
}

/// Depth of field silently did nothing: multisampled depth was never resolved.
#[test]
fn godot_80626_multisampled_depth_that_is_sampled_once_is_drawn_again_for_it() {
    let plan = right(&depth_sampled(None), &Options::default());
    assert_eq!(bound(&plan, "blur", "source0").samples, 1, "{}", plan.tree());
    assert!(scopes(&plan).flat_map(|scope| &scope.passes).any(|pass| pass.redraws.is_some()), "{}", plan.tree());
}

/// A resolve in an empty render pass faulted a driver; combinations of sample counts and scales broke the picture.
#[test]
fn godot_121453_and_121595_no_scope_is_empty_whatever_samples_and_scales_meet() {
    for samples in [1, 2, 4, 8] {
        for (drawn, shown) in [(16, 64), (64, 64), (128, 64), (1, 1)] {
            let plan = right(&scaled(samples, drawn, shown), &Options::default());
            assert!(scopes(&plan).all(|scope| !scope.passes.is_empty()), "{}", plan.tree());
            assert_eq!(resolves(&plan).len(), usize::from(samples > 1), "{}", plan.tree());
        }
    }
}

/// Samples went through main memory to be resolved; an explicit resolve that could be avoided cost 1.1 ms.
#[test]
fn o3de_4832_and_unity_1494_samples_that_are_only_resolved_never_leave_their_scope() {
    let plan = right(&forward(true), &Options::default());
    assert_eq!((plan.totals.resolves, plan.totals.folded_resolves), (1, 1), "{}", plan.tree());
    for attachment in attachments(&plan).filter(|attachment| plan.image(attachment.image).samples > 1) {
        assert_eq!(attachment.store, StoreOp::DontCare, "{}", plan.tree());
    }
}

/// Depth was averaged. Where it leaves the frame it has one value a texel, its first sample's (IQ-10).
#[test]
fn filament_7448_depth_is_never_averaged() {
    let mut frame = forward(true);
    frame.outputs.push(Resource::Image(ImageIndex(1)).into());
    let plan = right(&frame, &Options::default());
    let of_depth = attachments(&plan).filter(|attachment| !attachment.range.aspects.contains(Aspects::COLOR));
    let modes: Vec<_> = of_depth.filter_map(|attachment| Some(attachment.resolve.as_ref()?.mode)).collect();
    assert_eq!(modes, [ResolveMode::SampleZero], "{}", plan.tree());
}

/// A wish: a resolve of one's own, weighted by brightness. A pass that reads single samples is one, and no other is made.
#[test]
fn filament_4702_a_pass_that_reads_samples_is_a_resolve_of_its_own() {
    let plan = right(&weighted(), &Options::default());
    assert_eq!(resolves(&plan), [], "{}", plan.tree());
    assert_eq!(bound(&plan, "weighted", "source0").samples, 4);
}

/// Multisampled normals and other targets beside the colour weren't resolved.
#[test]
fn bevy_22831_every_target_of_a_pass_is_resolved_integers_by_their_first_sample() {
    let plan = right(&prepass(), &Options::default());
    let modes: Vec<_> = attachments(&plan).filter_map(|attachment| Some(attachment.resolve.as_ref()?.mode)).collect();
    assert_eq!(modes, [ResolveMode::Average, ResolveMode::Average, ResolveMode::SampleZero], "{}", plan.tree());
}

/// The multisampled image was bound where the resolved one was meant.
#[test]
fn unity_2278_who_wants_one_value_a_texel_is_bound_to_a_single_sampled_image() {
    let plan = right(&two_versions(), &Options::default());
    assert_eq!(resolves(&plan).len(), 2, "each of two versions is resolved:\n{}", plan.tree());
    for (pass, name) in [("early", "source0"), ("late", "source0"), ("late", "source1")] {
        assert_eq!(bound(&plan, pass, name).samples, 1, "{pass} {name}");
    }
}
