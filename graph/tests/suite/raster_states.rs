//! Raster state (DO-6): what it does to the contents of targets, and what refuses it.

use crate::testing::pipelines::{INPUTS, frame, right, set};
use crate::testing::plans::{on, scopes, shipped};
use framewright_graph::base;
use framewright_graph::expand::Inputs;
use framewright_graph::plan::{Pass, Plan, RenderScope, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{ColorComponents, CullMode, LoadOp, PrimitiveTopology};

/// A pass that follows one that fills `color`.
fn text(second: &str) -> String {
    format!(
        r#"Pipeline(version: 1,
    settings: [(name: "mode", value: OneOf(default: "Front", of: ["Neither", "Front", "Back"])), (name: "green", value: Bool(default: false)),
               (name: "width", value: Number(default: 2.0, min: 0.5, max: 100.0))],
    images: [(name: "color", format: R16G16B16A16_SFLOAT, size: Output), (name: "two", format: R16G16_SFLOAT, size: Output),
             (name: "screen", format: Output, size: Output)],
    passes: [(name: "before", fill: (to: "color", value: 0)), (name: "before_two", fill: (to: "two", value: 0)),
(name: "second", {second}),
             (name: "use", draw: FullScreen("copy"), sample: {{"source": "color"}}, color: ["screen"]),
             (name: "use_two", draw: FullScreen("copy"), sample: {{"source": "two"}}, color: [(image: "screen", blend: Additive)])],
    outputs: ["screen"])"#
    )
}

fn plan_with(second: &str, chosen: &[(&str, &str)]) -> Plan {
    let set = set(chosen);
    let frame = right(&text(second), &Inputs { set: &set, ..INPUTS });
    on(&frame, &shipped("amd-rx-7800-xt")).unwrap_or_else(|errors| panic!("{second}: {errors:?}"))
}

fn plan(second: &str) -> Plan {
    plan_with(second, &[])
}

fn second(plan: &Plan) -> (&RenderScope, &Pass) {
    let all = scopes(plan).into_iter().flat_map(|scope| scope.passes.iter().map(move |pass| (scope, pass)));
    all.into_iter().find(|(_, pass)| &*pass.name == "second").expect("it is drawn")
}

fn runs(plan: &Plan, pass: &str) -> bool {
    !plan.notes.iter().any(|note| *note.subject == *pass && note.text.contains("does not run"))
}

#[test]
fn what_a_draw_leaves_of_its_target_is_kept_and_loaded() {
    let target = |more: &str| format!(r#"draw: FullScreen("plain"), color: [(image: "color"{more})]"#);
    let raster = |more: &str| format!(r#"draw: FullScreen("plain"), color: ["color"], raster: ({more})"#);
    let points = r#"draw: Vertices(3), shader: "points", color: ["color"], raster: (topology: PointList)"#;
    for (pass, covers) in [
        (target(""), true),
        (target(", write_mask: (true, true, true, true)"), true),
        (target(", write_mask: (true, true, true, false)"), false),
        (target(", write_mask: (false, true, true, true)"), false),
        (target(r#", write_mask: (true, "green", true, true)"#), false),
        (target(", write_mask: (false, false, false, false)"), false),
        (target(", blend: (src_color: One, dst_color: Zero)"), false),
        (target(", blend: (src_color: Zero, dst_color: One, color_op: Max)"), false),
        (target(", write_mask: (true, true, true, false)") + ", covers: true", false),
        (raster("cull_mode: Neither"), true),
        (raster("cull_mode: Front"), false),
        (raster("cull_mode: Back"), false),
        (raster("cull_mode: FrontAndBack"), false),
        (raster(r#"cull_mode: "mode""#), false),
        (raster("cull_mode: Front") + ", covers: true", true),
        (raster("front_face: Clockwise"), true),
        (raster("depth_clamp: true, depth_bias: (constant: 1.0), line_width: 2.0"), true),
        (points.to_owned(), false),
        (points.to_owned() + ", covers: true", true),
        // Lines and points have no faces.
        (points.replace("PointList", "PointList, cull_mode: FrontAndBack") + ", covers: true", true),
    ] {
        let plan = plan(&pass);
        let (scope, drawn) = second(&plan);
        let load = scope.color()[0].load;
        assert_eq!(load, if covers { LoadOp::DontCare } else { LoadOp::Load }, "{pass}\n{}", plan.tree());
        assert_eq!(runs(&plan, "before"), !covers, "{pass}");
        assert_eq!(drawn.is_taken_to_cover(scope), covers, "{pass}");
    }
}

#[test]
fn settings_choose_states() {
    let pass = r#"draw: Vertices(3), shader: "plain", color: [(image: "color", write_mask: (true, "green", false, "!green"))],
        raster: (cull_mode: "mode", line_width: "width", topology: LineStrip)"#;
    let plan = plan_with(pass, &[("mode", "Back"), ("green", "true"), ("width", "3.5")]);
    let (_, drawn) = second(&plan);
    assert_eq!(drawn.raster.cull_mode, Some(CullMode::Back));
    assert_eq!(drawn.write_masks, [ColorComponents::R | ColorComponents::G]);
    assert!((f32::from(drawn.raster.line_width) - 3.5).abs() < f32::EPSILON);
}

/// A format of two channels has no third to leave out.
#[test]
fn channels_that_a_format_does_not_have_say_nothing() {
    let plan = plan(r#"draw: FullScreen("plain"), color: [(image: "two", write_mask: (true, true, false, false))]"#);
    let (scope, drawn) = second(&plan);
    assert_eq!((scope.color()[0].load, drawn.write_masks.len()), (LoadOp::DontCare, 0));
}

#[test]
fn states_stand_in_the_plan_where_they_say_something_and_nowhere_else() {
    let plain = plan(r#"draw: FullScreen("plain"), color: ["color"], raster: (cull_mode: Neither, line_width: 1.0)"#);
    let json = plain.to_json().expect("it is written");
    assert!(!json.contains("write_masks") && json.matches("raster").count() == 1, "{json}");
    let all = plan(
        r#"draw: Vertices(3), shader: "second",
        color: [(image: "color", blend: (src_color: One, dst_color: Src1Alpha, alpha_op: Max), write_mask: (true, false, true, false))],
        raster: (cull_mode: Back, front_face: Clockwise, topology: TriangleStrip, depth_clamp: true, line_width: 2.5,
            depth_bias: (constant: -1.0, slope: 2.0, clamp: 0.5), blend_constants: (0.25, 0.5, 0.75, 1.0))"#,
    );
    let json = all.to_json().expect("it is written");
    assert_eq!(Plan::from_json(&json).expect("it is read"), all);
    // Long lines are broken.
    let tree = all.tree().replace(['│', '\n'], " ").split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "blends color 0 by ONE × new ADD SRC1_ALPHA × old, alpha by ONE × new MAX SRC1_ALPHA × old",
        "writes R | B of color 0",
        "cull mode BACK, front face CLOCKWISE, topology TRIANGLE_STRIP, depth bias -1 + 2 × slope up to 0.5, depth clamp, \
         line width 2.5, blend constants (0.25, 0.5, 0.75, 1)",
    ] {
        assert!(tree.contains(words), "{words}\n{}", all.tree());
    }
}

#[test]
fn a_device_without_a_feature_refuses_the_state_that_needs_it_and_no_other() {
    let vertices =
        |raster: &str| format!(r#"draw: Vertices(3), shader: "points", color: ["color"], raster: ({raster})"#);
    let cases = [
        ("depthBiasClamp", vertices("depth_bias: (constant: 1.0, clamp: 0.5)")),
        ("depthClamp", vertices("depth_clamp: true")),
        ("wideLines", vertices("line_width: 2.0")),
        ("largePoints", vertices("topology: PointList")),
        (
            "dualSrcBlend",
            r#"draw: FullScreen("second"), color: [(image: "color", blend: (src_color: Src1Color, dst_color: One))]"#
                .to_owned(),
        ),
    ];
    for (feature, pass) in &cases {
        let frame = right(&text(pass), &INPUTS);
        for missing in cases.iter().map(|(missing, _)| missing) {
            let mut device = shipped("amd-rx-7800-xt");
            device.features.as_mut().expect("they are known").retain(|it| it != missing);
            let answer = on(&frame, &device).map_err(|errors| base::render(&frame.sources, &errors));
            if feature != missing {
                assert!(answer.is_ok(), "{feature} without {missing}: {answer:?}");
                continue;
            }
            let answer = answer.expect_err("it is refused");
            let place = match *feature {
                "dualSrcBlend" => place(pass, "\"color\", blend"),
                _ => place(pass, &pass[pass.find("raster: (").expect("it has one") + 8..]),
            };
            assert!(answer.contains(feature) && answer.contains("AMD Radeon RX 7800 XT"), "{answer}");
            assert!(answer.contains(&place) && answer.contains("E1113"), "{place}\n{answer}");
        }
    }
    let wide = right(&text(&vertices("line_width: \"width\"")), &INPUTS);
    let mut device = shipped("amd-rx-7800-xt");
    device.limits.as_mut().expect("they are known").line_width = 1;
    let answer = base::render(&wide.sources, &on(&wide, &device).expect_err("it is too wide"));
    assert!(answer.contains("the line width is 2, and 1 is allowed (lineWidthRange[1])"), "{answer}");
}

#[test]
fn states_that_do_not_go_with_a_pass_are_refused_where_they_stand() {
    let two = r#"color: [(image: "color", blend: (src_color: Src1Color, dst_color: One)), "two"]"#;
    let full = |more: &str| format!(r#"draw: FullScreen("plain"), color: ["color"], {more}"#);
    let vertices = r#"draw: Vertices(3), shader: "plain", color: ["color"], raster: (topology: PointList)"#.to_owned();
    let own = |more: &str| format!(r#"draw: Vertices(3), shader: "points", color: ["color"], raster: ({more})"#);
    let second =
        r#"draw: FullScreen("plain"), color: [(image: "color", blend: (src_color: Src1Color, dst_color: One))]"#
            .to_owned();
    // Each with the words that stand where it is told.
    for (pass, message, at) in [
        (full("raster: (topology: LineList)"), "has the topology LINE_LIST, and draws triangles", "(topology"),
        (vertices, "doesn't say how large they are", "(topology"),
        (
            own("topology: LineStrip, primitive_restart: true"),
            "begins strips anew by an index, and has no",
            "(topology",
        ),
        (own("primitive_restart: true"), "begins strips anew, and draws TRIANGLE_LIST", "(primitive"),
        (full("covers: true, raster: (cull_mode: FrontAndBack)"), "leaves out all faces", "(cull_mode"),
        (second, "shader `plain` has none", "(src_color"),
        (format!(r#"draw: FullScreen("second"), {two}"#), "into 2 colour targets", "(src_color"),
        (full("raster: (line_width: 0.5)"), "0.5 is no line width", "0.5"),
        (full("raster: (depth_bias: (slope: 1e39))"), "is no depth bias", "1e39"),
        (full("raster: (cull_mode: Side)"), "`Side` is not a cull mode", "Side"),
        (full(r#"raster: (cull_mode: "'Side'")"#), "`Side` is not a cull mode", "\"'Side"),
        (full("raster: (blend_constants: (1.0, 1.0))"), "a colour", "(1.0"),
        (
            r#"fill: (to: "color", value: 0), raster: (cull_mode: Back)"#.to_owned(),
            "means nothing beside `fill`",
            "(cull_mode",
        ),
    ] {
        let answer = frame(&text(&pass), &INPUTS).expect_err(&pass);
        assert!(answer.contains(message), "{pass}\n{answer}");
        let place = place(&pass, at);
        assert!(answer.contains(&place), "{place}: {pass}\n{answer}");
    }
}

/// Where words stand in the file of a pass.
fn place(pass: &str, words: &str) -> String {
    let text = text(pass);
    let (line, found) = text.lines().enumerate().find(|(_, line)| line.contains("\"second\",")).expect("its line");
    format!("test.ron:{}:{}", line + 1, found.find(words).unwrap_or_else(|| panic!("{words}: {found}")) + 1)
}

/// The checker, which knows nothing of the compiler's reasons, finds a target that isn't loaded and should be.
#[test]
fn the_checker_finds_contents_that_are_lost() {
    let wrong = |pass: &str, change: fn(&mut RenderScope)| {
        let mut plan = plan(pass);
        for step in &mut plan.steps {
            if let Work::Render(scope) = &mut step.work
                && scope.passes.iter().any(|pass| &*pass.name == "second")
            {
                change(scope);
            }
        }
        !verify(&plan).is_empty()
    };
    let whole = r#"draw: FullScreen("plain"), color: ["color"]"#;
    assert!(!wrong(whole, |_| {}));
    // The compiler takes these for whole draws and loads nothing.
    assert!(wrong(whole, |scope| scope.passes[0].write_masks = vec![ColorComponents::R]));
    assert!(wrong(whole, |scope| scope.passes[0].raster.cull_mode = Some(CullMode::Back)));
    assert!(!wrong(whole, |scope| scope.passes[0].raster.cull_mode = Some(CullMode::None)));
    assert!(wrong(whole, |scope| scope.passes[0].write_masks = vec![ColorComponents::RGBA; 2]));
    assert!(wrong(whole, |scope| scope.passes[0].raster.primitive_restart = true));
    assert!(wrong(whole, |scope| scope.passes[0].raster.topology = PrimitiveTopology::TriangleStrip));
    assert!(wrong(&format!("{whole}, covers: true"), |scope| {
        scope.passes[0].raster.cull_mode = Some(CullMode::FrontAndBack);
    }));
    assert!(!wrong(&format!("{whole}, covers: true"), |scope| scope.passes[0].raster.cull_mode = Some(CullMode::Back)));
}
