//! Words of the language, and their meaning in a frame.

use crate::testing::pipelines::{INPUTS, right, set};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Blend, Face, Image, ImageIndex, ParamValue, Resource, Work};
use framewright_graph::language::Facts;
use framewright_graph::vulkan::{CompareOp, Filter, Format, Layout};

/// A pipeline that shows one full-screen draw, with more settings, images and passes before it.
fn pipeline(settings: &str, images: &str, passes: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            settings: [{settings}],
            images: [(name: "screen", format: Output, size: Output), {images}],
            passes: [{passes} (name: "show", draw: FullScreen("plain"), color: ["screen"])],
            outputs: ["screen"],
        )"#
    )
}

/// The extent of an image of this size in a frame of 1000 × 30.
fn extent(size: &str) -> [u32; 2] {
    let image =
        format!(r#"(name: "base", format: Depth, size: Fixed(10, 7)), (name: "image", format: Depth, size: {size})"#);
    let frame = right(&pipeline("", &image, ""), &Inputs { output_extent: [1000, 30], ..INPUTS });
    let [width, height, _] = frame.images[2].extent;
    [width, height]
}

#[test]
fn sizes_follow_the_frame_or_an_image_and_are_rounded_down_to_at_least_one() {
    assert_eq!(extent("Output"), [1000, 30]);
    assert_eq!(extent("Scaled(0.5)"), [500, 15]);
    assert_eq!(extent("Scaled(0.25)"), [250, 7]);
    assert_eq!(extent("Scaled(2)"), [2000, 60]);
    assert_eq!(extent("Scaled(0.001)"), [1, 1]);
    assert_eq!(extent("Fixed(640, 480)"), [640, 480]);
    assert_eq!(extent("Like(\"base\")"), [10, 7]);
    assert_eq!(extent("Scaled(0.5, \"base\")"), [5, 3]);
}

#[test]
fn sizes_that_change_are_a_part_of_what_there_is_room_for_and_so_are_those_that_follow_them() {
    let images = r#"(name: "a", format: Depth, size: Dynamic(by: "scale", up_to: 1.5)),
                    (name: "b", format: Depth, size: Like("a")),
                    (name: "c", format: Depth, size: Scaled(0.5, "b")),
                    (name: "d", format: Depth, size: Dynamic(by: 0.5, up_to: 1, of: "c")),
                    (name: "e", format: Depth, size: Dynamic(by: 0.25, up_to: 0.5, of: "fixed")),
                    (name: "f", format: Depth, size: Fixed("width(c)", "height(d)")),
                    (name: "fixed", format: Depth, size: Fixed(100, 9))"#;
    let settings = r#"(name: "scale", value: Number(default: 1.0, min: 0.25, max: 1.5))"#;
    let sizes = |scale: &str| {
        let chosen = set(&[("scale", scale)]);
        let inputs = Inputs { output_extent: [1000, 30], set: &chosen, ..INPUTS };
        let frame = right(&pipeline(settings, images, ""), &inputs);
        let size = |image: &Image| ([image.extent[0], image.extent[1]], image.allocated);
        frame.images[1..7].iter().map(size).collect::<Vec<_>>()
    };
    let allocated = [Some([1500, 45]), Some([1500, 45]), Some([750, 22]), Some([750, 22]), Some([50, 4]), None];
    for (scale, extents) in [
        ("1", [[1000, 30], [1000, 30], [500, 15], [250, 7], [25, 2], [500, 7]]),
        ("1.5", [[1500, 45], [1500, 45], [750, 22], [375, 11], [25, 2], [750, 11]]),
        ("0.29", [[290, 8], [290, 8], [145, 4], [72, 2], [25, 2], [145, 2]]),
        // Two texels are the least where there is room for them.
        ("0.25", [[250, 7], [250, 7], [125, 3], [62, 2], [25, 2], [125, 2]]),
    ] {
        assert_eq!(sizes(scale), extents.into_iter().zip(allocated).collect::<Vec<_>>(), "{scale}");
    }
}

#[test]
fn a_product_that_is_whole_on_paper_stays_whole() {
    // In floating point 0.29 · 100 is 28.999999999999996.
    let image = r#"(name: "image", format: Depth, size: Scaled(0.29))"#;
    let frame = right(&pipeline("", image, ""), &Inputs { output_extent: [100, 100], ..INPUTS });
    assert_eq!(frame.images[1].extent, [29, 29, 1]);
}

#[test]
fn an_image_may_follow_one_that_is_declared_below_it() {
    let images = r#"(name: "a", format: Like("b"), size: Scaled(0.5, "b"), samples: Like("b")),
                    (name: "b", format: Like("c"), size: Scaled(0.5, "c"), samples: Like("c")),
                    (name: "c", format: R8_UNORM, size: Fixed(100, 80), samples: 2)"#;
    let frame = right(&pipeline("", images, ""), &INPUTS);
    let a = &frame.images[1];
    assert_eq!((a.format, a.extent, a.samples), (Format::R8_UNORM, [25, 20, 1], 2));
}

#[test]
fn a_chain_as_long_as_a_file_is_followed() {
    let chain: String = (0..20_000)
        .map(|at| format!("(name: \"i{at}\", format: Like(\"i{0}\"), size: Like(\"i{0}\")),\n", at + 1))
        .collect();
    let images = chain + r#"(name: "i20000", format: R32_UINT, size: Fixed(3, 4))"#;
    let frame = right(&pipeline("", &images, ""), &INPUTS);
    assert_eq!((frame.images[1].format, frame.images[1].extent), (Format::R32_UINT, [3, 4, 1]));
}

#[test]
fn outputs_for_a_screen_have_the_window_s_format_and_are_left_to_be_presented() {
    let image = r#"(name: "image", format: Output, size: Output), (name: "like", format: Like("image"), size: Output),
                   (name: "color", format: Color, size: Output)"#;
    let text = pipeline("", image, "");
    let of = |window| {
        let frame = right(&text, &Inputs { window, ..INPUTS });
        let layouts: Vec<_> = frame.outputs.iter().map(|output| output.after.map(|after| after.layout)).collect();
        (frame.images.iter().map(|image| image.format).collect::<Vec<_>>(), layouts)
    };
    let (formats, layouts) = of(None);
    assert_eq!((&formats[1..], layouts), (&[Format::R8G8B8A8_SRGB; 3][..], vec![None]));
    let window = Format::B8G8R8A8_SRGB;
    let (formats, layouts) = of(Some(window));
    assert_eq!(
        (&formats[1..], layouts),
        (&[window, window, Format::R8G8B8A8_SRGB][..], vec![Some(Layout::PresentSrcKhr)])
    );
}

#[test]
fn formats_are_named_by_purpose_or_by_vulkan() {
    let format = |word: &str| {
        let image = format!(r#"(name: "image", format: {word}, size: Output)"#);
        right(&pipeline("", &image, ""), &INPUTS).images[1].format
    };
    assert_eq!(format("Color(hdr: true)"), Format::R16G16B16A16_SFLOAT);
    assert_eq!(format("Color(hdr: false)"), Format::R8G8B8A8_SRGB);
    assert_eq!(format("Color"), Format::R8G8B8A8_SRGB);
    assert_eq!(format("Color()"), Format::R8G8B8A8_SRGB);
    assert_eq!(format("Depth"), Format::D32_SFLOAT);
    assert_eq!(format("Depth()"), Format::D32_SFLOAT);
    assert_eq!(format("Output"), Format::R8G8B8A8_SRGB);
    for named in Format::ALL {
        assert_eq!(format(named.name()), *named);
    }
}

/// Why a pass under this condition is off, in a scene with nothing but transparent objects; `None` if it runs.
fn off(condition: &str) -> Option<String> {
    let settings = r#"(name: "yes", value: Bool(default: true)), (name: "no", value: Bool(default: false))"#;
    let images = r#"(name: "extra", format: Output, size: Output)"#;
    let pass = format!(r#"(name: "extra", when: "{condition}", draw: FullScreen("plain"), color: ["extra"]),"#);
    let facts = Facts { has_opaque: false, has_alpha_clip: false, ..Facts::UNKNOWN };
    let inputs = Inputs { facts, facts_known: true, ..INPUTS };
    let frame = right(&pipeline(settings, images, &pass), &inputs);
    assert_eq!(frame.passes.len() + frame.switched_off.len(), 2);
    frame.switched_off.first().map(|off| off.because.clone())
}

#[test]
fn conditions_join_settings_and_facts() {
    assert_eq!(off("yes"), None);
    assert_eq!(off("no").as_deref(), Some("no = false"));
    assert_eq!(off("!no"), None);
    assert_eq!(off("!yes").as_deref(), Some("yes = true"));
    assert_eq!(off("!!yes"), None);
    assert_eq!(off("scene.has_transparent"), None);
    assert_eq!(off("scene.has_opaque").as_deref(), Some("scene.has_opaque = false"));
    assert_eq!(off("yes && scene.has_transparent"), None);
    assert_eq!(off("yes && no && scene.has_opaque").as_deref(), Some("no = false"), "the first that doesn't hold");
    assert_eq!(off("no || yes"), None);
    assert_eq!(off("no || scene.has_opaque").as_deref(), Some("no = false, scene.has_opaque = false"));
    // `&&` binds tighter than `||`.
    assert_eq!(off("yes || no && no"), None);
    assert_eq!(off("no && yes || yes"), None);
}

#[test]
fn depth_is_tested_reversed_and_written_unless_said_otherwise() {
    let images = r#"(name: "depth", format: Depth, size: Output),"#;
    let passes = r#"(name: "a", draw: Sky, depth: (image: "depth", clear: 0.0)),
                    (name: "b", draw: Sky, depth: "depth"),
                    (name: "c", draw: Sky, depth: (image: "depth", test: Always, write: false)),"#;
    let frame = right(&pipeline("", images, passes), &INPUTS);
    let depth = |pass: usize| {
        let depth = frame.passes[pass].depth.as_ref().unwrap_or_else(|| panic!("depth of {pass}"));
        (depth.clear, depth.test, depth.write)
    };
    assert_eq!(depth(0), (Some(0.0), CompareOp::GreaterOrEqual, true));
    assert_eq!(depth(1), (None, CompareOp::GreaterOrEqual, true));
    assert_eq!(depth(2), (None, CompareOp::Always, false));
}

#[test]
fn colour_is_replaced_unless_blended() {
    let images = r#"(name: "color", format: Color, size: Output),"#;
    let passes = r#"(name: "a", draw: Sky, color: [(image: "color", clear: (0.1, 0.2, 0.3, 1))]),
                    (name: "b", draw: Sky, color: [(image: "color", blend: Additive)]),
                    (name: "c", draw: Sky, color: ["color"]),"#;
    let frame = right(&pipeline("", images, passes), &INPUTS);
    let blends: Vec<Blend> = frame.passes.iter().map(|pass| pass.color[0].blend).collect();
    assert_eq!(blends, [Blend::Replace, Blend::Additive, Blend::Replace, Blend::Replace]);
    assert_eq!(frame.passes[0].color[0].clear, Some([0.1, 0.2, 0.3, 1.0]));
}

#[test]
fn the_sky_has_a_shader_of_its_own_unless_another_is_named() {
    let images = r#"(name: "color", format: Color, size: Output),"#;
    let passes = r#"(name: "a", draw: Sky, color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
                    (name: "b", draw: Sky, shader: "plain", color: ["color"]),"#;
    let frame = right(&pipeline("", images, passes), &INPUTS);
    let shader = |pass: usize| match &frame.passes[pass].work {
        Work::Draw { shader, .. } => shader.clone(),
        other => panic!("{other:?}"),
    };
    assert_eq!((&*shader(0), &*shader(1)), ("sky", "plain"));
}

#[test]
fn colour_is_filtered_and_depth_and_single_samples_are_not_unless_asked() {
    let images = r#"(name: "color", format: Color(hdr: true), size: Output, samples: 4),
                    (name: "depth", format: Depth, size: Output)"#;
    let passes = r#"
        (name: "a", draw: FullScreen("plain"), color: ["color"]),
        (name: "b", draw: Sky, depth: (image: "depth", clear: 0.0)),
        (name: "c", draw: FullScreen("downsample"), sample: {"source": "color"}, color: ["screen"]),
        (name: "d", draw: FullScreen("downsample"), sample: {"source": "depth"}, color: ["screen"]),
        (name: "e", draw: FullScreen("custom_resolve"), sample: {"source": "color"}, color: ["screen"]),
        (name: "f", draw: FullScreen("custom_resolve"), sample: {"source": Samples("color")}, color: ["screen"]),
        (name: "g", draw: FullScreen("downsample"),
            sample: {"source": (image: Resolved("color"), filter: Nearest)}, color: ["screen"]),"#;
    let frame = right(&pipeline("", images, passes), &INPUTS);
    let sampled = |pass: usize| {
        let sampled = &frame.passes[pass].sampled[0];
        (sampled.sampler.filter, sampled.face)
    };
    assert_eq!(sampled(2), (Filter::Linear, Face::Resolved));
    assert_eq!(sampled(3), (Filter::Nearest, Face::Resolved));
    assert_eq!(sampled(4), (Filter::Nearest, Face::Samples));
    assert_eq!(sampled(5), (Filter::Nearest, Face::Samples));
    assert_eq!(sampled(6), (Filter::Nearest, Face::Resolved));
}

#[test]
fn a_pass_may_sample_what_it_draws_onto() {
    let images = r#"(name: "color", format: Color, size: Output),"#;
    let passes = r#"(name: "a", draw: FullScreen("plain"), color: ["color"]),
                    (name: "b", draw: FullScreen("downsample"), sample: {"source": "color"}, color: ["color"]),"#;
    let frame = right(&pipeline("", images, passes), &INPUTS);
    assert_eq!(frame.passes[1].sampled[0].image, frame.passes[1].color[0].image);
}

#[test]
fn parameters_take_the_type_that_the_shader_declares() {
    let settings =
        r#"(name: "on", value: Bool(default: true)), (name: "steps", value: Integer(default: 3, min: 1, max: 5))"#;
    let images = r#"(name: "color", format: Color, size: Output),"#;
    let passes = r#"(name: "a", draw: FullScreen("scalars"),
                        params: {"a": 1, "b": "on", "c": "steps"}, color: ["color"]),"#;
    let frame = right(&pipeline(settings, images, passes), &INPUTS);
    let expected = [
        ("a".into(), ParamValue::Number(1.0)),
        ("b".into(), ParamValue::Bool(true)),
        ("c".into(), ParamValue::Integer(3)),
    ];
    assert_eq!(frame.passes[0].params, expected);
}

#[test]
fn parameters_are_vectors_and_matrices_with_settings_and_expressions_within() {
    let settings = r#"(name: "on", value: Bool(default: true)), (name: "steps", value: Integer(default: 3, min: 1, max: 5)),
                      (name: "red", value: Number(default: 0.25, min: 0.0, max: 1.0))"#;
    let images = r#"(name: "color", format: Color, size: Output),"#;
    let passes = r#"(name: "a", draw: FullScreen("vectors"), params: {
                        "tint": ("red", 1, "red * 2"), "cell": (-7, "steps"), "flags": (true, "on"),
                        "turn": ((1, 0, 0.5), (0, "red", "steps"))}, color: ["color"]),
                    (name: "b", custom: "program", params: {"any": ((1, 2), (true, "red"))}, side_effect: true),"#;
    let frame = right(&pipeline(settings, images, passes), &INPUTS);
    let numbers = |numbers: &[f64]| ParamValue::list(numbers.iter().map(|number| ParamValue::Number(*number)));
    let turn = ParamValue::list([numbers(&[1.0, 0.0, 0.5]), numbers(&[0.0, 0.25, 3.0])]);
    let expected = [
        ("tint".into(), numbers(&[0.25, 1.0, 0.5])),
        ("cell".into(), ParamValue::list([-7, 3].map(ParamValue::Integer))),
        ("flags".into(), ParamValue::list([true, true].map(ParamValue::Bool))),
        ("turn".into(), turn.clone()),
    ];
    assert_eq!(frame.passes[0].params, expected);
    assert_eq!(turn.to_string(), "((1, 0, 0.5), (0, 0.25, 3))");
    // A program is given what the file says.
    assert_eq!(frame.passes[1].params[0].1.to_string(), "((1, 2), (true, 0.25))");
}

#[test]
fn of_several_choices_for_a_setting_the_last_counts() {
    let settings = r#"(name: "steps", value: Integer(default: 3, min: 1, max: 5))"#;
    let set = set(&[("steps", "1"), ("steps", "5")]);
    let frame = right(&pipeline(settings, "", ""), &Inputs { set: &set, ..INPUTS });
    assert_eq!(frame.settings, [("steps".into(), "5".to_owned())]);
}

#[test]
fn a_dumped_image_leaves_the_frame_once() {
    let images = r#"(name: "color", format: Color, size: Output),"#;
    let passes = r#"(name: "a", draw: FullScreen("plain"), color: ["color"]),"#;
    let dump = ["color", "screen", "color"].map(str::to_owned);
    let frame = right(&pipeline("", images, passes), &Inputs { dump: &dump, ..INPUTS });
    let outputs: Vec<Resource> = frame.outputs.iter().map(|output| output.resource).collect();
    assert_eq!(outputs, [0, 1].map(|index| Resource::Image(ImageIndex(index))));
}

#[test]
fn a_pass_that_only_adds_to_its_target_goes_without_a_trace() {
    let settings = r#"(name: "glow", value: Bool(default: false))"#;
    let passes = r#"(name: "base", draw: FullScreen("plain"), color: ["screen"]),
                    (name: "glow", when: "glow", draw: FullScreen("plain"),
                        color: [(image: "screen", blend: Additive)]),"#;
    let frame = right(&pipeline(settings, "", passes), &INPUTS);
    assert_eq!(frame.passes.len(), 2);
    assert_eq!(frame.switched_off.len(), 1);
}

#[test]
fn extensions_of_ron_that_a_file_turns_on_change_nothing() {
    for extension in ["implicit_some", "unwrap_newtypes", "unwrap_variant_newtypes"] {
        let text = format!("#![enable({extension})]\n{}", crate::testing::pipelines::shipped("forward.ron"));
        assert_eq!(right(&text, &INPUTS).passes.len(), 5, "{extension}");
    }
}

#[test]
fn comments_and_trailing_commas_may_stand_anywhere() {
    let text = r#"/* a */ Pipeline( // b
        version: /* c */ 1 /* d */,
        images: [ /* e */ (name: /* "no" */ "screen" // f
            , format: Color /* g */ (hdr: true /* h */), size: /* i */ Output,),],
        passes: [(name: "show", draw: FullScreen /* j */ (/* k */ "plain",), color: ["screen" /* l */,],),],
        outputs: ["screen",],
    ) // m"#;
    let frame = right(text, &INPUTS);
    assert_eq!(frame.images[0].format, Format::R16G16B16A16_SFLOAT);
    let place = frame.sources.place(frame.images[0].span).map(|place| (place.line, place.column));
    assert_eq!(place, Some((3, 45)));
}
