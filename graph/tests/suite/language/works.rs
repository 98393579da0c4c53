//! Passes besides those that draw the scene: dispatches, transfers, draws of their own, the program's own; and the parts of
//! images and buffers that they use.

use crate::testing::pipelines::{INPUTS, frame, right, set, wrong};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{
    BufferIndex, BufferRole, Draw, Frame, Groups, ImageIndex, IndirectDraws, ParamValue, Pass, Resource, StencilState,
    Work,
};
use framewright_graph::vulkan::{Aspects, CompareOp, FillValue, Filter, Stages, StencilOp, Subresources};

const SETTINGS: &str = r#"(name: "count", value: Integer(default: 1000, min: 1, max: 60000)),
                          (name: "on", value: Bool(default: true))"#;

const IMAGES: &str = r#"(name: "screen", format: Output, size: Output),
    (name: "hdr", format: Color(hdr: true), size: Fixed(100, 60), mips: 4, layers: 2, lifetime: Persistent),
    (name: "stencil", format: DepthStencil, size: Output, lifetime: Persistent),
    (name: "cube", format: Color(hdr: true), size: Fixed(32, 32), shape: Cube, mips: Full, lifetime: Persistent),
    (name: "fog", format: R16G16B16A16_SFLOAT, size: Fixed(20, 10), shape: D3(9), lifetime: Persistent),
    (name: "past", format: Color(hdr: true), size: Output, lifetime: History(frames: 2)),"#;

const BUFFERS: &str = r#"(name: "particles", bytes: Times(16, "count"), lifetime: History),
    (name: "forces", bytes: 64, lifetime: Persistent), (name: "bins", bytes: 1024, lifetime: Persistent),
    (name: "counts", bytes: 32, lifetime: Persistent), (name: "rows", bytes: PerTexel(4, "screen"), lifetime: Persistent)"#;

/// The frame with these passes before a last one that shows something.
fn with(passes: &str) -> Frame {
    with_inputs(passes, &INPUTS)
}

fn with_inputs(passes: &str, inputs: &Inputs<'_>) -> Frame {
    let text = format!(
        r#"Pipeline(version: 1, settings: [{SETTINGS}], images: [{IMAGES}], buffers: [{BUFFERS}],
            passes: [{passes} (name: "show", draw: FullScreen("plain"), color: ["screen"])], outputs: ["screen"])"#
    );
    frame(&text, inputs).unwrap_or_else(|answer| panic!("{answer}"))
}

/// The one pass before the last.
fn pass(fields: &str) -> Pass {
    with(&format!(r#"(name: "pass", {fields}),"#)).passes.swap_remove(0)
}

const PAST: ImageIndex = ImageIndex(5);
const PARTICLES: BufferIndex = BufferIndex(0);

#[test]
fn a_dispatch_is_given_what_its_shader_declares() {
    let pass = pass(
        r#"dispatch: "simulate", groups: Invocations("count"),
           storage: {"particles": (buffer: "particles", access: Write), "before": (buffer: "particles", previous: 1)},
           uniform: {"forces": "forces"}, params: {"seconds": 0.5}"#,
    );
    assert_eq!(pass.work, Work::Dispatch { shader: "simulate".into(), groups: Groups::Invocations([1000, 1, 1]) });
    let used: Vec<_> = pass.buffers.iter().map(|used| (used.binding.as_deref(), used.role, used.frames_ago)).collect();
    let expected = [
        (Some("particles"), BufferRole::Storage { read: false, write: true }, 0),
        (Some("before"), BufferRole::Storage { read: true, write: false }, 1),
        (Some("forces"), BufferRole::Uniform, 0),
    ];
    assert_eq!(used, expected);
    assert!(pass.buffers.iter().all(|used| used.stages == Stages::COMPUTE_SHADER));
    assert_eq!(pass.params, [("seconds".into(), ParamValue::Number(0.5))]);
}

#[test]
fn groups_are_counted_or_follow_from_settings_images_and_buffers() {
    let groups = |groups: &str| match pass(&format!(
        r#"dispatch: "count_up", groups: {groups}, storage: {{"counts": "counts"}}"#
    ))
    .work
    {
        Work::Dispatch { groups, .. } => groups,
        other => panic!("{other:?}"),
    };
    assert_eq!(groups("Count(7)"), Groups::Count([7, 1, 1]));
    assert_eq!(groups("Count(7, 8)"), Groups::Count([7, 8, 1]));
    assert_eq!(groups("Count(7, \"count\", 9)"), Groups::Count([7, 1000, 9]));
    assert_eq!(groups("Invocations(640, 360, 2)"), Groups::Invocations([640, 360, 2]));
    assert_eq!(groups("Texels(\"screen\")"), Groups::Invocations([640, 360, 1]));
    assert_eq!(groups("Texels(\"hdr\")"), Groups::Invocations([100, 60, 2]));
    assert_eq!(groups("Texels(image: \"hdr\", mip: 2, layer: 0)"), Groups::Invocations([25, 15, 1]));
    assert_eq!(groups("Texels((image: \"hdr\", mip: 3))"), Groups::Invocations([12, 7, 2]));
    assert_eq!(groups("Texels(\"fog\")"), Groups::Invocations([20, 10, 9]));
    assert_eq!(groups("Texels(image: \"fog\", mip: 0)"), Groups::Invocations([20, 10, 9]));
    assert_eq!(groups("Indirect(\"counts\")"), Groups::Indirect { offset: 0 });
    assert_eq!(groups("Indirect(\"counts\", 20)"), Groups::Indirect { offset: 20 });
}

#[test]
fn an_indirect_dispatch_and_draw_read_their_counts() {
    let dispatch = pass(r#"dispatch: "count_up", groups: Indirect("bins"), storage: {"counts": "counts"}"#);
    assert_eq!(dispatch.buffers[1].role, BufferRole::Indirect);
    assert_eq!(dispatch.buffers[1].binding, None);
    let draw = pass(
        r#"draw: Indirect("counts"), shader: "particles", vertex: "bins", index: "forces",
           color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))]"#,
    );
    let roles: Vec<BufferRole> = draw.buffers.iter().map(|used| used.role).collect();
    assert_eq!(roles, [BufferRole::Vertex, BufferRole::Index, BufferRole::Indirect]);
    assert!(matches!(draw.work, Work::Draw { draw: Draw::Indirect, .. }));
}

#[test]
fn do_11_several_indirect_draws_say_how_many_they_are_and_where_they_stand() {
    let draws = |draw: &str, index: &str| {
        pass(&format!(
            r#"draw: {draw}, shader: "particles", vertex: "bins", {index}
               color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))]"#
        ))
    };
    let buffers = |pass: &Pass| pass.buffers.iter().map(|used| (used.role, used.buffer)).collect::<Vec<_>>();
    let (bins, counts) = (BufferIndex(2), BufferIndex(3));
    let all = draws(r#"Indirect(commands: "bins", draws: "floor(count / 20)")"#, "");
    let expected = IndirectDraws { draws: 50, ..IndirectDraws::ONE };
    assert!(all.work.draws(|draw| draw == Draw::Indirects(expected)), "{:?}", all.work);
    assert_eq!(buffers(&all), [(BufferRole::Vertex, bins), (BufferRole::Indirect, bins)]);
    let counted = draws(
        r#"Indirect(commands: "bins", draws: 30, offset: 64, stride: 32, count: "counts", count_offset: 28)"#,
        r#"index: "bins","#,
    );
    let expected = IndirectDraws { draws: 30, offset: 64, stride: Some(32), count: Some(28) };
    assert!(counted.work.draws(|draw| draw == Draw::Indirects(expected)), "{:?}", counted.work);
    let roles = [BufferRole::Vertex, BufferRole::Index, BufferRole::Indirect].map(|role| (role, bins));
    assert_eq!(buffers(&counted), [&roles[..], &[(BufferRole::Count, counts)]].concat());
    let one = draws(r#"Indirect(commands: "counts", draws: 1, count: "counts", offset: 4)"#, "");
    let expected = IndirectDraws { draws: 1, offset: 4, stride: None, count: Some(0) };
    assert!(one.work.draws(|draw| draw == Draw::Indirects(expected)), "{:?}", one.work);
}

#[test]
fn do_11_indirect_draws_beyond_their_buffers_are_refused_at_their_place() {
    let refused = |draw: &str, index: &str| {
        let text = format!(
            r#"Pipeline(version: 1, settings: [{SETTINGS}], images: [{IMAGES}], buffers: [{BUFFERS}],
passes: [(name: "draw", draw: {draw}, shader: "particles", vertex: "bins", {index} color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))])],
outputs: ["screen"])"#
        );
        let answer = frame(&text, &INPUTS).err().unwrap_or_default();
        assert!(answer.contains(":10:"), "its line is missing: {answer}");
        answer
    };
    for (draw, index, said) in [
        (r#"Indirect(commands: "bins", draws: 65)"#, "", "the counts of 65 draws (VkDrawIndirectCommand)"),
        (
            r#"Indirect(commands: "bins", draws: 52)"#,
            r#"index: "bins","#,
            "the counts of 52 draws (VkDrawIndexedIndirectCommand)",
        ),
        (r#"Indirect(commands: "bins", draws: 2, offset: 1000)"#, "", "1032"),
        (r#"Indirect(commands: "bins", draws: 2, offset: 6)"#, "", "not at 6"),
        (r#"Indirect(commands: "bins", draws: 2, stride: 16)"#, r#"index: "bins","#, "at least 20, and not 16"),
        (
            r#"Indirect(commands: "bins", draws: 2, count: "counts", count_offset: 32)"#,
            "",
            "the number of draws at byte 32",
        ),
        (
            r#"Indirect(commands: "bins", draws: 2, count_offset: 4)"#,
            "",
            "`count_offset` means nothing without `count`",
        ),
        (r#"Indirect(commands: "bins", draws: 0)"#, "", "number of draws"),
        (r#"Indirect(commands: "bins")"#, "", "draws"),
    ] {
        let answer = refused(draw, index);
        assert!(answer.contains(said), "{draw}: {answer}");
    }
}

#[test]
fn vertices_are_counted_by_numbers_and_settings() {
    let draw = |draw: &str| {
        let fields = format!(
            r#"draw: {draw}, shader: "pulled", storage: {{"particles": (buffer: "particles", previous: 1)}},
               color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))]"#
        );
        let write = r#"(name: "write", fill: (to: "particles", value: 0)),"#;
        match with(&format!(r#"{write} (name: "pass", {fields}),"#)).passes.swap_remove(1).work {
            Work::Draw { draw, .. } => draw,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(draw("Vertices(3)"), Draw::Vertices { count: 3, instances: 1 });
    assert_eq!(draw("Vertices(6, \"count\")"), Draw::Vertices { count: 6, instances: 1000 });
}

#[test]
fn storage_is_accessed_as_the_shader_declares_it_unless_the_file_says_so() {
    let bins = |access: &str| {
        let fields = format!(
            r#"dispatch: "histogram", groups: Texels("screen"), sample: {{"source": (image: "past", previous: 1)}},
               storage: {{"bins": {access}}}"#
        );
        let past = r#"(name: "past", fill: (to: "past", value: 0)),"#;
        with(&format!(r#"{past} (name: "pass", {fields}),"#)).passes.swap_remove(1).buffers[0].role
    };
    // Atomics read and write.
    assert_eq!(bins("\"bins\""), BufferRole::Storage { read: true, write: true });
    assert_eq!(bins("(buffer: \"bins\", access: Write)"), BufferRole::Storage { read: false, write: true });
    let write_only = |access: &str| {
        let fields = format!(r#"dispatch: "count_up", groups: Count(1), storage: {{"counts": {access}}}"#);
        pass(&fields).buffers[0].role
    };
    // That a shader doesn't read says nothing of how much it writes: what earlier frames left is kept.
    assert_eq!(write_only("\"counts\""), BufferRole::Storage { read: true, write: true });
    assert_eq!(write_only("(buffer: \"counts\", access: Write)"), BufferRole::Storage { read: false, write: true });
    // A shader that writes here and there keeps the rest.
    assert_eq!(write_only("(buffer: \"counts\", access: ReadWrite)"), BufferRole::Storage { read: true, write: true });
}

#[test]
fn a_storage_image_is_one_mip_level() {
    let pass = pass(
        r#"dispatch: "halve", groups: Texels(image: "hdr", mip: 1, layer: 1),
           sample: {"source": (image: "hdr", mip: 0, layer: 1)},
           storage: {"target": (image: "hdr", mip: 1, layer: 1)}"#,
    );
    let level = |base_mip| Subresources { aspects: Aspects::empty(), base_mip, mips: 1, base_layer: 1, layers: 1 };
    assert_eq!(pass.sampled[0].range, level(0));
    assert_eq!(pass.storage[0].range, level(1));
    // It persists, so what isn't written is kept.
    assert_eq!((pass.storage[0].read, pass.storage[0].write), (true, true));
}

#[test]
fn parts_are_single_or_several_mip_levels_and_layers_and_planes() {
    let part = |part: &str| pass(&format!(r#"custom: "look", reads: [{part}], side_effect: true"#)).transfers[0].range;
    let range = |base_mip, mips, base_layer, layers| Subresources {
        aspects: Aspects::empty(),
        base_mip,
        mips,
        base_layer,
        layers,
    };
    let rest = Subresources::REMAINING;
    assert_eq!(part("\"hdr\""), Subresources::WHOLE);
    assert_eq!(part("(image: \"hdr\")"), Subresources::WHOLE);
    assert_eq!(part("(image: \"hdr\", mip: 3)"), range(3, 1, 0, rest));
    assert_eq!(part("(image: \"hdr\", mips: 2)"), range(0, 2, 0, rest));
    assert_eq!(part("(image: \"hdr\", mip: 1, mips: 2, layer: 1)"), range(1, 2, 1, 1));
    assert_eq!(part("(image: \"hdr\", mip: 1, mips: Rest, layers: Rest)"), range(1, 3, 0, 2));
    assert_eq!(part("(image: \"stencil\", plane: Stencil)").aspects, Aspects::STENCIL);
}

#[test]
fn copies_blits_and_fills_read_before_they_write() {
    let copy = pass(r#"copy: (from: (image: "cube", mip: 0, layer: 2), to: (image: "cube", mip: 0, layer: 5))"#);
    assert_eq!(copy.work, Work::Copy);
    let sides: Vec<_> = copy.transfers.iter().map(|side| (side.write, side.range.base_layer)).collect();
    assert_eq!(sides, [(false, 2), (true, 5)]);
    let blit = pass(r#"blit: (from: (image: "hdr", mip: 0), to: (image: "hdr", mip: 1))"#);
    assert_eq!(blit.work, Work::Blit { filter: Filter::Linear });
    let fill = pass(r#"fill: (to: "counts", value: 9)"#);
    assert_eq!(fill.work, Work::Fill { value: FillValue::Bits([9, 0, 0, 0]) });
    assert_eq!(fill.transfers[0].resource, Resource::Buffer(BufferIndex(3)));
    let fill = pass(r#"fill: (to: (image: "hdr", mip: 2), value: (1, 2, 3, 4))"#);
    assert_eq!(fill.work, Work::Fill { value: FillValue::Color([1.0, 2.0, 3.0, 4.0]) });
}

#[test]
fn signed_integers_are_filled_with_negative_numbers_and_no_others_are() {
    let filled = |format: &str, value: &str| {
        format!(
            r#"Pipeline(
                version: 1,
                images: [(name: "a", format: {format}, size: Output)],
                passes: [(name: "fill", fill: (to: "a", value: {value}))],
                outputs: ["a"],
            )"#
        )
    };
    let value = |format, value| right(&filled(format, value), &INPUTS).passes[0].work.clone();
    let bits = |numbers: [i32; 4]| Work::Fill { value: FillValue::Bits(numbers.map(i32::cast_unsigned)) };
    assert_eq!(value("R8G8_SINT", "(-128, 127, 0, 0)"), bits([-128, 127, 0, 0]));
    assert_eq!(value("R32_SINT", "-2147483648"), bits([i32::MIN; 4]));
    assert_eq!(value("R16_UINT", "65535"), bits([65535; 4]));
    for (format, number, said) in [
        ("R8_SINT", "-129", "whole numbers from -128 to 127 are allowed"),
        ("R16G16_SINT", "32768", "whole numbers from -32768 to 32767 are allowed"),
        ("R32G32_UINT", "-1", "whole numbers from 0 to 4294967295 are allowed"),
    ] {
        let told = wrong(&filled(format, number), &INPUTS);
        assert!(told.contains(said), "{told}");
    }
}

#[test]
fn an_image_is_read_back_in_rows_without_gaps() {
    let frame = with(
        r#"(name: "draw", draw: FullScreen("plain"), color: ["screen"]),
           (name: "read", copy: (from: "screen", to: "rows")),"#,
    );
    assert_eq!(frame.buffers[4].bytes, 640 * 360 * 4);
    assert_eq!(frame.passes[1].transfers.len(), 2);
}

#[test]
fn what_the_program_records_is_a_draw_if_it_has_targets() {
    let outside = pass(r#"custom: "upload", writes: ["counts"], params: {"a": 1, "b": "on"}"#);
    assert_eq!(outside.work, Work::Custom { callback: "upload".into() });
    assert_eq!(outside.params, [("a".into(), ParamValue::Integer(1)), ("b".into(), ParamValue::Bool(true))]);
    let inside = pass(
        r#"custom: "debug_lines", sample: {"atlas": (image: "hdr", layer: 0)},
           color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))]"#,
    );
    let Work::Draw { draw: Draw::Custom, shader, .. } = &inside.work else { panic!("{:?}", inside.work) };
    assert_eq!(&**shader, "debug_lines");
    assert_eq!(inside.sampled[0].stages, Stages::VERTEX_SHADER | Stages::FRAGMENT_SHADER);
}

#[test]
fn earlier_frames_are_read_beside_this_one() {
    let frame = with(
        r#"(name: "past", draw: FullScreen("downsample"), sample: {"source": (image: "past", previous: 2)},
                color: ["past"]),"#,
    );
    let pass = &frame.passes[0];
    assert_eq!((pass.sampled[0].image, pass.sampled[0].frames_ago), (PAST, 2));
    assert_eq!(pass.color[0].image, PAST);
}

#[test]
fn a_persistent_image_is_read_before_it_is_written() {
    let pass = pass(r#"draw: FullScreen("plain"), color: [(image: "hdr", mip: 0, layer: 0, blend: Additive)]"#);
    assert_eq!(pass.color[0].range.base_mip, 0);
}

#[test]
fn shapes_are_sampled_as_the_shader_declares_them() {
    let sampled = |shader: &str, part: &str| {
        let fields = format!(r#"draw: FullScreen("{shader}"), sample: {{"source": {part}}}, color: ["screen"]"#);
        pass(&fields).sampled[0].range
    };
    assert_eq!(sampled("around", "\"cube\""), Subresources::WHOLE);
    assert_eq!(sampled("layered", "\"cube\""), Subresources::WHOLE);
    assert_eq!(sampled("deep", "\"fog\""), Subresources::WHOLE);
    assert_eq!(sampled("layered", "\"hdr\""), Subresources::WHOLE);
    // A face of a cube is an image of its own.
    assert_eq!(sampled("downsample", "(image: \"cube\", layer: 3)").base_layer, 3);
}

#[test]
fn of_depth_and_stencil_a_shader_takes_the_plane_whose_type_it_declares() {
    let plane = |shader: &str| {
        let fields = format!(r#"draw: FullScreen("{shader}"), sample: {{"source": "stencil"}}, color: ["screen"]"#);
        pass(&fields).sampled[0].range.aspects
    };
    assert_eq!(plane("downsample"), Aspects::DEPTH);
    assert_eq!(plane("count"), Aspects::STENCIL);
}

#[test]
fn the_file_says_that_a_shader_reads_its_own_texel() {
    let own = |shader: &str, more: &str| {
        let frame = with(&format!(
            r#"(name: "first", draw: FullScreen("plain"), color: ["past"]),
               (name: "second", draw: FullScreen("{shader}"), sample: {{"source": (image: "past"{more})}},
                    color: ["screen"]),"#
        ));
        frame.passes[1].sampled[0].own_pixel
    };
    assert!(own("downsample", ", own_pixel: true"));
    assert!(!own("downsample", ""));
}

#[test]
fn stencil_is_tested_and_set() {
    let fields = |stencil: &str| format!(r#"draw: Sky, depth: (image: "stencil", stencil: {stencil})"#);
    let stencil = |words: &str| pass(&fields(words)).depth.and_then(|depth| depth.stencil);
    let plain = StencilState { clear: None, test: CompareOp::Always, reference: 0, pass: StencilOp::Keep };
    assert_eq!(stencil("()"), Some(plain));
    assert_eq!(
        stencil("(clear: 0, test: NotEqual, reference: 255, pass: IncrementAndClamp)"),
        Some(StencilState {
            clear: Some(0),
            test: CompareOp::NotEqual,
            reference: 255,
            pass: StencilOp::IncrementAndClamp
        })
    );
}

#[test]
fn conditions_switch_passes_of_every_kind() {
    let passes = r#"(name: "a", when: "on", dispatch: "count_up", groups: Count(1), storage: {"counts": "counts"}),
        (name: "b", when: "on", fill: (to: "bins", value: 0)),
        (name: "c", when: "on", blit: (from: (image: "cube", mip: 0), to: (image: "cube", mip: 1))),
        (name: "d", when: "on", custom: "ping", side_effect: true),"#;
    assert_eq!(with(passes).passes.len(), 5);
    let set = set(&[("on", "false")]);
    let frame = with_inputs(passes, &Inputs { set: &set, ..INPUTS });
    assert_eq!((frame.passes.len(), frame.switched_off.len()), (1, 4));
}

#[test]
fn a_dispatch_that_is_off_forwards_an_image_to_the_one_it_stores() {
    let passes = r#"(name: "draw", draw: FullScreen("plain"), color: ["past"]),
        (name: "store", when: "on", dispatch: "paint", groups: Texels("past"),
            storage: {"target": (image: "stored", access: Write)}, otherwise: Forward(from: "past", to: "stored")),"#;
    let text = format!(
        r#"Pipeline(version: 1, settings: [{SETTINGS}],
            images: [{IMAGES} (name: "stored", format: Like("past"), size: Like("past"))], buffers: [{BUFFERS}],
            passes: [{passes}
                (name: "show", draw: FullScreen("downsample"), sample: {{"source": "stored"}}, color: ["screen"])],
            outputs: ["screen"])"#
    );
    let set = set(&[("on", "false")]);
    let frame = frame(&text, &Inputs { set: &set, ..INPUTS }).unwrap_or_else(|answer| panic!("{answer}"));
    assert!(matches!(frame.passes[1].work, Work::Forward { from: PAST, .. }));
}

#[test]
fn a_side_effect_is_kept_in_mind() {
    assert!(pass(r#"custom: "ping", side_effect: true"#).side_effect);
    assert!(!pass(r#"fill: (to: "particles", value: 0)"#).side_effect);
    assert_eq!(pass(r#"fill: (to: "particles", value: 0)"#).transfers[0].resource, Resource::Buffer(PARTICLES));
}
