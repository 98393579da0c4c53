//! The shipped pipelines under their settings and over scenes.

use crate::testing::pipelines::{INPUTS, frame, set, shipped};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Face, Frame, Image, ParamValue, Work};
use framewright_graph::language::Facts;
use framewright_graph::vulkan::Format;

fn names(frame: &Frame) -> Vec<&str> {
    frame.passes.iter().map(|pass| &*pass.name).collect()
}

fn image<'f>(frame: &'f Frame, name: &str) -> &'f Image {
    frame.images.iter().find(|image| &*image.name == name).unwrap_or_else(|| panic!("no image {name}"))
}

fn forward(values: &[(&str, &str)], facts: Facts) -> Frame {
    let inputs = Inputs { set: &set(values), facts, facts_known: true, ..INPUTS };
    frame(&shipped("forward.ron"), &inputs).unwrap_or_else(|text| panic!("{text}"))
}

#[test]
fn forward_runs_every_pass_by_default() {
    let frame = forward(&[], Facts::UNKNOWN);
    assert_eq!(names(&frame), ["opaque", "masked", "sky", "transparent", "tone_map"]);
    assert!(frame.switched_off.is_empty());
    let shown: Vec<(&str, &str)> = frame.settings.iter().map(|(name, value)| (&**name, &**value)).collect();
    assert_eq!(shown, [("msaa", "4"), ("hdr", "true"), ("tone_mapping", "true"), ("white_point", "100")]);
}

#[test]
fn msaa_decides_the_samples_of_color_and_depth_but_not_of_the_screen() {
    for (value, samples) in [("1", 1), ("8", 8)] {
        let frame = forward(&[("msaa", value)], Facts::UNKNOWN);
        assert_eq!(image(&frame, "color").samples, samples);
        assert_eq!(image(&frame, "depth").samples, samples);
        assert_eq!(image(&frame, "screen").samples, 1);
    }
}

#[test]
fn hdr_decides_the_format_of_color() {
    assert_eq!(image(&forward(&[], Facts::UNKNOWN), "color").format, Format::R16G16B16A16_SFLOAT);
    assert_eq!(image(&forward(&[("hdr", "false")], Facts::UNKNOWN), "color").format, Format::R8G8B8A8_SRGB);
}

#[test]
fn without_tone_mapping_color_is_forwarded_to_the_screen() {
    let frame = forward(&[("tone_mapping", "false")], Facts::UNKNOWN);
    assert_eq!(names(&frame), ["opaque", "masked", "sky", "transparent", "tone_map"]);
    let Work::Forward { from, to, because } = &frame.passes[4].work else { panic!("{:?}", frame.passes[4]) };
    let name = |index: &framewright_graph::frame::ImageIndex| &*frame.images[index.0 as usize].name;
    assert_eq!((name(from), name(to), &**because), ("color", "screen", "tone_mapping = false"));
    assert_eq!(frame.switched_off.len(), 1);
    assert_eq!(&*frame.switched_off[0].name, "tone_map");
    assert_eq!(frame.switched_off[0].because, "tone_mapping = false");
}

#[test]
fn what_the_scene_does_not_hold_is_not_drawn_and_leaves_no_trace_among_passes() {
    let facts = Facts { has_alpha_clip: false, has_cross_fade: false, has_transparent: false, ..Facts::UNKNOWN };
    let frame = forward(&[], facts);
    assert_eq!(names(&frame), ["opaque", "sky", "tone_map"]);
    let off: Vec<(&str, &str)> = frame.switched_off.iter().map(|off| (&*off.name, &*off.because)).collect();
    let masked = "scene.has_alpha_clip = false, scene.has_cross_fade = false";
    assert_eq!(off, [("masked", masked), ("transparent", "scene.has_transparent = false")]);
    let line = shipped("forward.ron").lines().position(|line| line.contains("name: \"masked\"")).map(|line| line + 1);
    let place = frame.sources.place(frame.switched_off[0].span);
    assert_eq!(place.map(|place| place.line as usize), line, "where the condition stands");
}

#[test]
fn facts_of_no_scene_count_as_true() {
    let facts = Facts {
        has_opaque: false,
        has_alpha_clip: false,
        has_cross_fade: false,
        has_transparent: false,
        ..Facts::UNKNOWN
    };
    let inputs = Inputs { facts, facts_known: false, ..INPUTS };
    let frame = frame(&shipped("forward.ron"), &inputs).unwrap_or_else(|text| panic!("{text}"));
    assert!(frame.switched_off.is_empty());
}

#[test]
fn tone_mapping_samples_one_value_a_texel_and_takes_its_parameter_from_the_setting() {
    let frame = forward(&[("white_point", "4")], Facts::UNKNOWN);
    let pass = &frame.passes[4];
    assert_eq!(
        pass.params,
        [("exposure".into(), ParamValue::Number(1.0)), ("white_point".into(), ParamValue::Number(4.0))]
    );
    assert_eq!(&*pass.sampled[0].binding, "source");
    assert_eq!(pass.sampled[0].face, Face::Resolved);
}

#[test]
fn only_masked_objects_discard_fragments() {
    let discarding = |pass: &&framewright_graph::frame::Pass| matches!(pass.work, Work::Draw { discards: true, .. });
    let frame = forward(&[], Facts::UNKNOWN);
    let names: Vec<&str> = frame.passes.iter().filter(discarding).map(|pass| &*pass.name).collect();
    assert_eq!(names, ["masked"]);
}

#[test]
fn soft_focus_blurs_at_a_quarter_of_the_size() {
    let inputs = Inputs { output_extent: [641, 363], ..INPUTS };
    let frame = frame(&shipped("soft_focus.ron"), &inputs).unwrap_or_else(|text| panic!("{text}"));
    let extent = |name| image(&frame, name).extent;
    assert_eq!(extent("color"), [641, 363, 1]);
    assert_eq!(extent("half"), [320, 181, 1]);
    assert_eq!(extent("quarter"), [160, 90, 1]);
    assert_eq!(extent("blurred_across"), [160, 90, 1]);
    assert_eq!(extent("blurred"), [160, 90, 1]);
    assert_eq!(extent("glowing"), [641, 363, 1]);
    for name in ["half", "quarter", "blurred_across", "blurred", "glowing"] {
        assert_eq!(image(&frame, name).format, Format::R16G16B16A16_SFLOAT, "{name}");
        assert_eq!(image(&frame, name).samples, 1, "{name}");
    }
}
