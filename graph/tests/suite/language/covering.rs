//! Who writes an image first covers it or clears it: the rule by which files are read is the one by which frames are
//! compiled.

use crate::testing::pipelines::{INPUTS, frame};
use crate::testing::plans::{on, shipped};
use framewright_graph::plan::{Plan, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Layout, LoadOp};

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
    let planes = [scope.depth(), scope.stencil()].map(|plane| plane.map(|attachment| attachment.load));
    assert_eq!(planes, [Some(LoadOp::DontCare); 2]);
    assert_eq!(scope.attachments[0].load, LoadOp::DontCare);
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

/// A pass that follows one that fills `color`, and that pass's name where it still runs.
fn after_a_fill(second: &str) -> Plan {
    let text = format!(
        r#"Pipeline(version: 1,
            images: [(name: "color", format: R16G16B16A16_SFLOAT, size: Output), (name: "screen", format: Output, size: Output)],
            buffers: [(name: "counts", bytes: 32)],
            passes: [(name: "before", fill: (to: "color", value: 0)), (name: "zeros", fill: (to: "counts", value: 0)),
                     (name: "second", {second}),
                     (name: "use", dispatch: "histogram", groups: Texels("color"), sample: {{"source": "color"}},
                         storage: {{"bins": "counts"}}, side_effect: true),
                     (name: "show", draw: FullScreen("plain"), color: ["screen"])],
            outputs: ["screen"])"#
    );
    let frame = frame(&text, &INPUTS).unwrap_or_else(|answer| panic!("{answer}"));
    let plan = on(&frame, &shipped("amd-rx-7800-xt")).expect("a Plan");
    assert_eq!(verify(&plan), [], "{second}");
    plan
}

fn runs(plan: &Plan, pass: &str) -> bool {
    !plan.notes.iter().any(|note| *note.subject == *pass && note.text.contains("does not run"))
}

#[test]
fn a_full_screen_draw_covers_unless_its_shader_may_leave_texels_or_the_file_promises_more() {
    for (shader, covers, why) in [
        ("plain", true, ""),
        ("holes", false, "shader `holes` discards fragments"),
        ("masks", false, "shader `masks` writes `gl_SampleMask` (masks.frag:4)"),
        ("part", false, "its vertex stage part.vert is its own and may fill less than the screen"),
        // It writes an undefined value there, which keeping can't mend.
        ("forgets", true, ""),
    ] {
        let draw = format!(r#"draw: FullScreen("{shader}"), color: ["color"]"#);
        for (promise, covers) in [("", covers), (", covers: false", covers), (", covers: true", true)] {
            let plan = after_a_fill(&format!("{draw}{promise}"));
            assert_eq!(runs(&plan, "before"), !covers, "{shader}{promise}");
            let scopes = plan.steps.iter().filter_map(|step| match &step.work {
                Work::Render(scope) if &*scope.passes[0].name == "second" => Some(scope),
                _ => None,
            });
            let scopes: Vec<_> = scopes.collect();
            let [scope] = &scopes[..] else { panic!("{}", plan.tree()) };
            let attachment = &scope.attachments[0];
            assert_eq!(attachment.load, if covers { LoadOp::DontCare } else { LoadOp::Load }, "{shader}{promise}");
            assert_eq!(scope.passes[0].is_taken_to_cover(scope), covers, "{shader}{promise}");
            if !covers {
                let expected = format!(
                    "`second` may leave texels as they were: {why}; `covers: true` promises that it sets them all; "
                );
                let because = attachment.because.to_string();
                assert!(because.starts_with(&expected), "{because}");
            }
        }
    }
}

/// A plane is loaded because of the shader only where the draw would replace it otherwise.
#[test]
fn a_plane_that_a_draw_would_set_but_for_its_shader_says_so() {
    let stencil_of = |depth: &str| {
        let text = format!(
            r#"Pipeline(version: 1,
                images: [(name: "both", format: DepthStencil, size: Output), (name: "screen", format: Output, size: Output)],
                passes: [(name: "before", fill: (to: "both", value: (0.0, 0))),
                         (name: "holes", draw: FullScreen("holes"), color: [(image: "screen", clear: (0.0, 0.0, 0.0, 0.0))],
                             depth: (image: "both", test: Always, {depth})),
                         (name: "sky", draw: Sky, color: ["screen"], depth: (image: "both", write: false, stencil: (test: Equal)))],
                outputs: ["screen"])"#
        );
        let frame = frame(&text, &INPUTS).unwrap_or_else(|answer| panic!("{answer}"));
        let plan = on(&frame, &shipped("amd-rx-7800-xt")).expect("a Plan");
        let mut scopes = plan.steps.iter().filter_map(|step| step.work.scope());
        let stencil = scopes.find_map(|scope| scope.stencil()).expect("it is attached");
        assert_eq!(stencil.load, LoadOp::Load, "{}", plan.tree());
        stencil.because.to_string()
    };
    let told = "`holes` may leave texels as they were: shader `holes` discards fragments";
    let because = stencil_of("write: false, stencil: (pass: Replace)");
    assert!(because.starts_with(told), "{because}");
    let because = stencil_of("stencil: (pass: IncrementAndClamp)");
    assert!(!because.contains("may leave"), "{because}");
}

#[test]
fn any_draw_into_one_layer_covers_that_is_promised_to_but_blending_reads_all_the_same() {
    let covers = |fields: &str| {
        let plan = after_a_fill(&format!(r#"draw: Objects(Opaque), shader: "lit", covers: true, {fields}"#));
        let covers = !runs(&plan, "before");
        let mut scopes = plan.steps.iter().filter_map(|step| step.work.scope());
        let drawn = scopes.find(|scope| &*scope.passes[0].name == "second").expect("it draws");
        assert_eq!(drawn.passes[0].is_taken_to_cover(drawn), covers, "{fields}");
        covers
    };
    assert!(covers(r#"color: ["color"]"#));
    assert!(!covers(r#"color: [(image: "color", blend: Alpha)]"#));
    let depth = plan(r#"(image: "depth"), covers: true"#);
    assert!(depth.is_err_and(|refusal| refusal.contains("first to draw")), "a test reads depth, whatever is promised");
}

#[test]
fn a_first_writer_that_may_leave_texels_is_refused_with_the_line_and_the_promise() {
    let first = |shader: &str, covers: &str| {
        let text = format!(
            r#"Pipeline(version: 1, images: [(name: "screen", format: Output, size: Output)],
                passes: [(name: "first", draw: FullScreen("{shader}"), color: ["screen"]{covers})], outputs: ["screen"])"#
        );
        frame(&text, &INPUTS)
    };
    let refusal = first("masks", "").expect_err("it may leave texels");
    assert!(refusal.contains("untouched: shader `masks` writes `gl_SampleMask` (masks.frag:4)"), "{refusal}");
    assert!(refusal.contains("or say `covers: true` of the pass"), "{refusal}");
    assert!(first("masks", ", covers: true").is_ok());
    assert!(first("part", "").is_err() && first("part", ", covers: true").is_ok());
}

#[test]
fn an_output_that_some_path_leaves_is_refused_or_told_of_where_that_is_not_sure() {
    let drawn = |shader: &str| {
        let text = format!(
            r#"Pipeline(version: 1, images: [(name: "screen", format: Output, size: Output)],
                passes: [(name: "drawn", draw: FullScreen("{shader}"), color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))])],
                outputs: ["screen"])"#
        );
        frame(&text, &INPUTS)
    };
    let refusal = drawn("never_sets").expect_err("it never sets its output");
    assert!(
        refusal.contains("shader `never_sets` never sets `color_0` (unset.frag:3): its value would be undefined"),
        "{refusal}"
    );
    let told = drawn("forgets").expect("it may be right").remarks;
    let [remark] = &told[..] else { panic!("{told:?}") };
    assert!(remark.text.contains("doesn't set `color_0` on every path (unset.frag:3)"), "{remark:?}");
}

#[test]
fn stores_keep_what_was_there_unless_the_file_promises_that_all_is_written() {
    let image = r#"dispatch: "halve", groups: Texels("color"), sample: {"source": "color"}, storage: {"target": "#;
    let buffer = r#"dispatch: "count_up", groups: Count(1), storage: {"counts": "#;
    for (fields, whole, before) in [
        (image, r#"(image: "color", access: Write)"#, "before"),
        (buffer, r#"(buffer: "counts", access: Write)"#, "zeros"),
    ] {
        let named = if before == "before" { "\"color\"" } else { "\"counts\"" };
        let kept = after_a_fill(&format!("{fields}{named}}}"));
        assert!(runs(&kept, before), "{}", kept.tree());
        // The table knows only of one where it is declared.
        let declared = if before == "zeros" { " (count_up.comp:3)" } else { "" };
        let words = format!(
            ": its shader doesn't read it{declared}, which doesn't say that it writes all of it; `access: Write` promises"
        );
        let said = kept.notes.iter().any(|note| &*note.subject == "second" && note.text.contains(&words));
        assert!(said, "{}", kept.tree());
        if before == "zeros" {
            let promised = after_a_fill(&format!("{fields}{whole}}}"));
            assert!(!runs(&promised, before), "{}", promised.tree());
            assert!(!promised.notes.iter().any(|note| note.text.contains("promises")), "{}", promised.tree());
        }
    }
}

#[test]
fn the_first_store_of_a_frame_needs_nothing_and_keeps_what_earlier_frames_left() {
    let painted = |lifetime: &str| {
        let text = format!(
            r#"Pipeline(version: 1,
                images: [(name: "color", format: R16G16B16A16_SFLOAT, size: Output),
                         (name: "map", format: R16G16B16A16_SFLOAT, size: Output{lifetime}),
                         (name: "screen", format: Output, size: Output)],
                passes: [(name: "before", fill: (to: "color", value: 0)),
                         (name: "paint", dispatch: "halve", groups: Texels("map"), sample: {{"source": "color"}}, storage: {{"target": "map"}}),
                         (name: "show", draw: FullScreen("downsample"), sample: {{"source": "map"}}, color: ["screen"])],
                outputs: ["screen"])"#
        );
        let frame = frame(&text, &INPUTS).unwrap_or_else(|answer| panic!("{answer}"));
        let plan = on(&frame, &shipped("amd-rx-7800-xt")).expect("a Plan");
        assert_eq!(verify(&plan), [], "{lifetime}");
        let map = plan.images.iter().find(|image| &*image.name == "map").expect("the map").id;
        let barriers = plan.steps.iter().flat_map(|step| &step.image_barriers);
        barriers.filter(|barrier| barrier.image == map).any(|barrier| barrier.old_layout == Layout::Undefined)
    };
    assert!(painted(""), "nothing was there");
    assert!(!painted(", lifetime: Persistent"), "a barrier from UNDEFINED loses what earlier frames painted");
}
