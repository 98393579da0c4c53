//! Who writes an image first covers it or clears it: the rule by which files are read is the one by which frames are
//! compiled.

use crate::testing::pipelines::{INPUTS, frame};
use crate::testing::plans::{on, shipped};
use framewright_graph::plan::{Plan, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::LoadOp;

/// A full-screen pass that is the first to write colour, depth and stencil, and a pass that shows the colour.
fn first_with(depth: &str) -> String {
    format!(
        r#"Pipeline(version: 1,
            images: [(name: "color", format: Color(hdr: true), size: Output),
                     (name: "depth", format: DepthStencil, size: Output),
                     (name: "screen", format: Output, size: Output)],
            passes: [(name: "first", draw: FullScreen("plain"), color: ["color"], depth: {depth}),
                     (name: "next", draw: Sky, color: ["color"], depth: (image: "depth", write: false, stencil: (test: Equal))),
                     (name: "show", draw: FullScreen("tone_map"), sample: {{"source": "color"}}, params: {{"exposure": 1.0, "white_point": 1.0}}, color: ["screen"])],
            outputs: ["screen"])"#
    )
}

fn plan(depth: &str) -> Result<Plan, String> {
    let frame = frame(&first_with(depth), &INPUTS)?;
    on(&frame, &shipped("amd-rx-7800-xt"))
        .map_err(|errors| errors.iter().map(|error| format!("{}\n", error.message)).collect())
}

#[test]
fn a_full_screen_pass_whose_tests_always_pass_covers_the_depth_and_stencil_that_it_writes_first() {
    let plan = plan(r#"(image: "depth", test: Always, stencil: (pass: Replace))"#).expect("it covers");
    let Work::Render(scope) = &plan.steps[0].work else { panic!("a scope comes first") };
    let planes = [&scope.depth, &scope.stencil].map(|plane| plane.as_ref().map(|attachment| attachment.load));
    assert_eq!(planes, [Some(LoadOp::DontCare); 2]);
    assert_eq!(scope.color[0].load, LoadOp::DontCare);
    assert_eq!(verify(&plan), []);
}

#[test]
fn a_full_screen_pass_that_may_fail_a_test_or_leaves_a_plane_as_it_is_covers_nothing_of_it() {
    for (depth, what) in [
        (r#"(image: "depth", stencil: (pass: Replace))"#, "a depth test"),
        (r#"(image: "depth", test: Always, stencil: (test: Equal, pass: Replace))"#, "a stencil test"),
        (r#"(image: "depth", test: Always, stencil: (pass: IncrementAndClamp))"#, "stencil that is counted up"),
        (r#"(image: "depth", test: Always, write: false, stencil: (pass: Replace))"#, "depth that isn't written"),
    ] {
        let refusal = plan(depth).err().unwrap_or_else(|| panic!("{what} is taken for covering"));
        assert!(refusal.contains("untouched") || refusal.contains("before"), "{what}: {refusal}");
    }
}
