//! Writes that are sure to set all of an image, and writes that aren't.

use crate::testing::hand_written_plans::build::*;
use crate::testing::hand_written_plans::recount;
use framewright_graph::frame::{Blend, Draw, DrawList};
use framewright_graph::plan::{DepthState, Hazard, Plan, Work};
use framewright_graph::verify::{Rule, Violation, verify};
use framewright_graph::vulkan::{Accesses, CompareOp, Format, Layout, LoadOp, StoreOp, Usage};

const TESTED: State = (
    TESTS,
    Accesses::DEPTH_STENCIL_ATTACHMENT_READ.union(Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE),
    Layout::DepthStencilAttachmentOptimal,
);

/// `paint` draws like this into `color`, loaded `DONT_CARE`; `tonemap` samples it.
fn painted(what: Draw, blend: Blend, depth: Option<DepthState>) -> Plan {
    let usage = Usage::COLOR_ATTACHMENT | Usage::SAMPLED;
    let color = transient(0, "color", Format::R16G16B16A16_SFLOAT, 1, usage, [0, 32768], [0, 1]);
    let usage = Usage::DEPTH_STENCIL_ATTACHMENT;
    let depth_image = transient(1, "depth", Format::D32_SFLOAT, 1, usage, [32768, 8192], [0, 0]);
    let screen = output(2, "screen", Format::R8G8B8A8_SRGB, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);
    let read = if blend == Blend::Replace { Accesses::empty() } else { Accesses::COLOR_ATTACHMENT_READ };
    let drawn = (COLOR.0, COLOR.1 | read, COLOR.2);
    let mut accesses = vec![access(&color, drawn)];
    let mut barriers = vec![barrier(&color, (SAMPLED.0, Accesses::empty()), UNDEFINED, drawn, Hazard::FirstUse, None)];
    let depth_attachment = depth.map(|_| {
        accesses.push(access(&depth_image, TESTED));
        let source = (TESTED.0, Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE);
        barriers.push(barrier(&depth_image, source, UNDEFINED, TESTED, Hazard::FirstUse, None));
        attachment(&depth_image, TESTED.2, LoadOp::Clear, StoreOp::DontCare, "it is cleared")
    });
    let attached = attachment(&color, COLOR.2, LoadOp::DontCare, StoreOp::Store, "it is said to be covered");
    let paint = draw("paint", 10, what, &[blend], depth, accesses);
    let mut steps = vec![step(barriers, scope(1, vec![attached], depth_attachment, vec![paint]))];
    steps.extend(tone_map(&color, (COLOR.0, COLOR.1, COLOR.2), &screen, 1));
    plan(vec![color, depth_image, screen], 65536, steps)
}

/// The Plan with a shader that discards fragments.
fn discarding(mut plan: Plan) -> Plan {
    if let Work::Render(scope) = &mut plan.steps[0].work {
        scope.passes[0].discards = true;
    }
    plan
}

/// The Plan with two layers of `color`.
fn with_two_layers(mut plan: Plan) -> Plan {
    plan.images[0].layers = 2;
    for step in &mut plan.steps {
        let of_color = step.image_barriers.iter_mut().filter(|barrier| barrier.image.0 == 0);
        of_color.for_each(|barrier| barrier.range.layers = 2);
        let Work::Render(scope) = &mut step.work else { continue };
        let attached = scope.attachments.iter_mut().filter(|attachment| attachment.image.0 == 0);
        for attachment in attached {
            (attachment.range.layers, scope.layers) = (2, 2);
        }
        let accesses = scope.passes.iter_mut().flat_map(|pass| &mut pass.accesses);
        accesses.filter(|access| access.image.0 == 0).for_each(|access| access.range.layers = 2);
    }
    recount(&mut plan);
    plan
}

const ANY: DepthState = DepthState { test: CompareOp::Always, write: true };
const NEARER: DepthState = DepthState { test: CompareOp::GreaterOrEqual, write: true };

#[test]
fn a_full_screen_draw_that_replaces_without_a_test_sets_all() {
    for depth in [None, Some(ANY)] {
        assert_eq!(verify(&painted(Draw::FullScreen, Blend::Replace, depth)), [], "{depth:?}");
    }
}

#[test]
fn what_was_undefined_stays_so_under_a_draw_that_is_not_sure_to_cover() {
    let objects = Draw::Objects(DrawList::Opaque);
    let plans = [
        painted(objects, Blend::Replace, None),
        painted(Draw::Sky, Blend::Replace, None),
        painted(Draw::Custom, Blend::Replace, None),
        painted(Draw::FullScreen, Blend::Replace, Some(NEARER)),
        discarding(painted(Draw::FullScreen, Blend::Replace, None)),
        with_two_layers(painted(Draw::FullScreen, Blend::Replace, None)),
    ];
    for plan in plans {
        let said = verify(&plan);
        let [Violation { rule: Rule::Uninitialised { in_part: true }, range: Some(_), .. }] = &said[..] else {
            panic!("{said:?}\n{}", plan.tree())
        };
        let layers = if plan.images[0].layers == 2 { "layers 0–1" } else { "layer 0" };
        let expected = format!(
            "step 1 `tonemap`: `color` (COLOR, mip 0, {layers}): read, but step 0 `paint` may leave some of it unwritten"
        );
        assert_eq!(said[0].to_string(), expected);
    }
}

#[test]
fn blending_reads_what_stands_there() {
    let said = verify(&painted(Draw::FullScreen, Blend::Additive, None));
    let [violation @ Violation { rule: Rule::Uninitialised { in_part: false }, .. }] = &said[..] else {
        panic!("{said:?}")
    };
    let expected = "step 0 `paint`: `color` (COLOR, mip 0, layer 0): read, but nothing in the frame has written it";
    assert_eq!(violation.to_string(), expected);
}
