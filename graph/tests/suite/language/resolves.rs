//! How several samples become one value: what the file says comes to the frame (IQ-10, IQ-12, IQ-14).

use crate::testing::pipelines::{INPUTS, right, set};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Face, Frame, Resolve, ResolveWay};
use framewright_graph::vulkan::ResolveMode;

/// Objects drawn with a shader into depth of 4 samples, of which a pass samples one value.
fn pipeline(policy: &str, own: &str, shader: &str, source: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            {policy}
            settings: [
                (name: "quality", value: OneOf(default: "Fastest", of: ["Fastest", "Exact"])),
                (name: "close", value: Bool(default: true)),
            ],
            images: [
                (name: "screen", format: Output, size: Output),
                (name: "depth", format: Depth, size: Output, samples: 4{own}),
                (name: "color", format: Color, size: Output, samples: 4),
            ],
            passes: [
                (name: "draw", draw: Objects(Opaque), shader: "{shader}",
                    color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "depth", clear: 0.0)),
                (name: "show", draw: FullScreen("downsample"), sample: {{"source": {source}}}, color: ["screen"]),
            ],
            outputs: ["screen"],
        )"#
    )
}

fn frame(policy: &str, own: &str, chosen: &[(&str, &str)]) -> Frame {
    let set = set(chosen);
    right(&pipeline(policy, own, "lit", "(image: \"depth\", filter: Nearest)"), &Inputs { set: &set, ..INPUTS })
}

/// The way of the depth, and who says so.
fn said(frame: &Frame) -> Option<(ResolveWay, &str)> {
    frame.images[1].resolve.as_ref().map(|Resolve { way, because }| (*way, &**because))
}

#[test]
fn an_images_own_word_wins_over_the_policy_which_is_for_depth_alone() {
    let zero = ResolveWay::By(ResolveMode::SampleZero);
    assert_eq!(said(&frame("", "", &[])), None);
    assert_eq!(said(&frame("depth: Exact,", "", &[])), None);
    let fastest = frame("depth: Fastest,", "", &[]);
    assert_eq!(said(&fastest), Some((zero, "`depth: Fastest`")));
    assert_eq!(fastest.images[2].resolve, None, "colour is averaged");
    let least = frame("depth: Fastest,", ", resolve: Min", &[]);
    assert_eq!(said(&least), Some((ResolveWay::By(ResolveMode::Min), "`resolve: Min`")));
    assert_eq!(
        said(&frame("depth: Fastest,", ", resolve: DepthOnly", &[])),
        Some((ResolveWay::DepthOnly, "`resolve: DepthOnly`"))
    );
}

#[test]
fn a_setting_or_an_expression_chooses() {
    let by_setting = |chosen: &[(&str, &str)]| frame("depth: \"quality\",", "", chosen);
    let zero = ResolveWay::By(ResolveMode::SampleZero);
    assert_eq!(said(&by_setting(&[])), Some((zero, "`depth: Fastest` (quality = 'Fastest')")));
    assert_eq!(said(&by_setting(&[("quality", "Exact")])), None);
    let by_expression = |chosen: &[(&str, &str)]| frame("", ", resolve: \"if(close, 'Max', 'Min')\"", chosen);
    let (near, far) = (by_expression(&[]), by_expression(&[("close", "false")]));
    assert_eq!(said(&near), Some((ResolveWay::By(ResolveMode::Max), "`resolve: Max` (close = true)")));
    assert_eq!(said(&far).map(|said| said.0), Some(ResolveWay::By(ResolveMode::Min)));
}

#[test]
fn faces_of_depth_come_to_what_is_read_of_each_texel() {
    let face = |source: &str| right(&pipeline("", "", "lit", source), &INPUTS).passes[1].sampled[0].face;
    assert_eq!(face("\"depth\""), Face::Resolved);
    assert_eq!(face("Resolved(\"depth\")"), Face::Resolved);
    assert_eq!(face("DepthOnly(\"depth\")"), Face::DepthOnly);
}

#[test]
fn a_shader_that_cannot_draw_depth_alone_is_known_where_that_is_asked_of_it() {
    let why = |shader: &str, given: &str| {
        let text =
            pipeline("", "", shader, "\"depth\"").replace("(name: \"draw\",", &format!("(name: \"draw\", {given}"));
        let buffers = "buffers: [(name: \"marks\", bytes: 64, lifetime: Persistent)],\n            images: [";
        let frame = right(&text.replace("images: [", buffers), &INPUTS);
        frame.passes[0].no_depth_only.as_deref().map(str::to_owned)
    };
    assert_eq!(why("lit_masked", ""), None);
    let still_reads = "has the shader `marked`, and with the macro `DEPTH_ONLY` it still uses `marks`, which may have \
                       changed since";
    assert_eq!(why("marked", "storage: {\"marks\": \"marks\"},").as_deref(), Some(still_reads));
    let would_lack = "has the shader `moved`, and with the macro `DEPTH_ONLY` its vertex shader would lack `marks`";
    assert_eq!(why("moved", "storage: {\"marks\": \"marks\"},").as_deref(), Some(would_lack));
    let keeps_all = "has the shader `forgetful`, and with the macro `DEPTH_ONLY` it discards no fragments any more";
    assert_eq!(why("forgetful", "").as_deref(), Some(keeps_all));
    let unmasked = "has the shader `unmasked`, and with the macro `DEPTH_ONLY` it writes no `gl_SampleMask` any more";
    assert_eq!(why("unmasked", "").as_deref(), Some(unmasked));
    let by_alpha =
        "has the shader `lit`, and with the macro `DEPTH_ONLY` it leaves out no samples, which its alpha does";
    assert_eq!(why("lit", "alpha_to_coverage: true,").as_deref(), Some(by_alpha));
    assert_eq!(why("lit_masked", "alpha_to_coverage: true,"), None);
}

/// Of each format the ways in which it can be resolved (IQ-10, IQ-20).
#[test]
fn a_way_that_a_format_does_not_have_is_refused_with_those_that_it_has() {
    let ways = ["DepthOnly", "SampleZero", "Min", "Max", "Average", "Weighted"];
    for (format, possible) in [("Depth", &ways[..5]), ("Color(hdr: true)", &ways[4..]), ("R32_UINT", &ways[1..2])] {
        for way in ways {
            let text = format!(
                r#"Pipeline(version: 1,
                    images: [
                        (name: "many", format: {format}, size: Output, samples: 4, resolve: {way}),
                        (name: "screen", format: Output, size: Output),
                    ],
                    passes: [
                        (name: "draw", draw: FullScreen("plain"), color: ["screen"]),
                    ],
                    outputs: ["screen"])"#
            );
            match crate::testing::pipelines::frame(&text, &INPUTS) {
                Ok(frame) => {
                    assert!(possible.contains(&way), "{format} resolved by {way}");
                    assert!(frame.images[0].resolve.is_some());
                }
                Err(answer) => {
                    let told = answer.contains("`many` can't be resolved so: it is");
                    assert!(told && !possible.contains(&way), "{format} resolved by {way}: {answer}");
                }
            }
        }
    }
}
