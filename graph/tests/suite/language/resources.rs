//! Fields of images and buffers beyond formats and sizes: mip levels, layers, shapes, bytes, lifetimes, states.

use crate::testing::pipelines::{INPUTS, right, set};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Buffer, Image, Lifetime, Resource};
use framewright_graph::vulkan::{Accesses, FillValue, Format, Layout, Shape, Stages, State};

/// A pipeline that shows one full-screen draw, with more images and buffers beside it.
fn pipeline(settings: &str, images: &str, buffers: &str, outputs: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            settings: [{settings}],
            images: [(name: "screen", format: Output, size: Output), {images}],
            buffers: [{buffers}],
            passes: [(name: "show", draw: FullScreen("plain"), color: ["screen"])],
            outputs: ["screen", {outputs}],
        )"#
    )
}

/// The image that is declared so, beside one of 64 × 48 with four mip levels and two layers.
fn image(fields: &str) -> Image {
    let images = format!(
        r#"(name: "base", format: R8_UNORM, size: Fixed(64, 48), mips: 4, layers: 2), (name: "image", {fields})"#
    );
    let settings = r#"(name: "few", value: Integer(default: 3, min: 1, max: 5))"#;
    right(&pipeline(settings, &images, "", ""), &INPUTS).images[2].clone()
}

/// The buffer that is declared so, beside one of 256 bytes.
fn buffer(fields: &str) -> Buffer {
    let buffers = format!(r#"(name: "base", bytes: 256), (name: "buffer", {fields})"#);
    let images = r#"(name: "deep", format: R8_UNORM, size: Fixed(3, 3), layers: 5)"#;
    let settings = r#"(name: "few", value: Integer(default: 8, min: 4, max: 400))"#;
    right(&pipeline(settings, images, &buffers, ""), &INPUTS).buffers[1].clone()
}

#[test]
fn mip_levels_are_counted_full_or_those_of_another_image() {
    let mips = |mips: &str| image(&format!("format: R8_UNORM, size: Fixed(64, 48), mips: {mips}")).mips;
    assert_eq!(image("format: R8_UNORM, size: Fixed(64, 48)").mips, 1);
    assert_eq!(mips("2"), 2);
    assert_eq!(mips("\"few\""), 3);
    assert_eq!(mips("Full"), 7);
    assert_eq!(mips("Like(\"base\")"), 4);
    assert_eq!(image("format: R8_UNORM, size: Fixed(1, 1), mips: Full").mips, 1);
    assert_eq!(image("format: R8_UNORM, size: Fixed(2, 3), shape: D3(17), mips: Full").mips, 5);
}

#[test]
fn a_cube_has_six_layers_unless_it_says_more_and_a_deep_image_is_as_deep_as_it_says() {
    let cube = image("format: R8_UNORM, size: Fixed(16, 16), shape: Cube");
    assert_eq!((cube.shape, cube.layers, cube.extent), (Shape::Cube, 6, [16, 16, 1]));
    assert_eq!(image("format: R8_UNORM, size: Fixed(16, 16), shape: Cube, layers: 12").layers, 12);
    let deep = image("format: R8_UNORM, size: Fixed(16, 8), shape: D3(\"few\")");
    assert_eq!((deep.shape, deep.layers, deep.extent), (Shape::D3, 1, [16, 8, 3]));
    let flat = image("format: R8_UNORM, size: Fixed(16, 8), shape: D2, layers: Like(\"base\")");
    assert_eq!((flat.shape, flat.layers), (Shape::D2, 2));
}

#[test]
fn depth_may_have_a_stencil() {
    assert_eq!(image("format: DepthStencil, size: Output").format, Format::D32_SFLOAT_S8_UINT);
}

#[test]
fn buffers_are_sized_by_numbers_settings_images_and_other_buffers() {
    assert_eq!(buffer("bytes: 4096").bytes, 4096);
    assert_eq!(buffer("bytes: \"few\"").bytes, 8);
    assert_eq!(buffer("bytes: Times(12, \"few\")").bytes, 96);
    assert_eq!(buffer("bytes: Like(\"base\")").bytes, 256);
    // 3 × 3 texels, 5 layers, a byte each: rounded up to whole words.
    assert_eq!(buffer("bytes: PerTexel(1, \"deep\")").bytes, 48);
}

#[test]
fn a_buffer_may_follow_one_that_is_declared_below_it() {
    let chain: String = (0..1000).map(|at| format!("(name: \"b{at}\", bytes: Like(\"b{}\")),\n", at + 1)).collect();
    let buffers = chain + r#"(name: "b1000", bytes: 12)"#;
    let frame = right(&pipeline("", "", &buffers, ""), &INPUTS);
    assert!(frame.buffers.iter().all(|buffer| buffer.bytes == 12));
}

/// A pipeline that also fills images and buffers and reads their history, each as many frames back as `reads` says.
fn reading(images: &str, buffers: &str, reads: &[(&str, &str, u32)]) -> String {
    let passes: String = reads
        .iter()
        .map(|(kind, name, ago)| {
            format!(
                r#"(name: "fill_{name}", fill: (to: "{name}", value: 0)),
                (name: "read_{name}", custom: "look", reads: [({kind}: "{name}", previous: {ago})], side_effect: true),"#
            )
        })
        .collect();
    pipeline("", images, buffers, "").replacen("passes: [", &format!("passes: [{passes}"), 1)
}

#[test]
fn what_lives_on_begins_with_zero_or_with_what_the_file_says() {
    let of =
        |format: &str, lifetime: &str| image(&format!("format: {format}, size: Output, lifetime: {lifetime}")).lifetime;
    let persistent = |initial| Lifetime::Persistent { initial };
    assert_eq!(image("format: Color, size: Output").lifetime, Lifetime::Transient);
    assert_eq!(of("Color", "Transient"), Lifetime::Transient);
    assert_eq!(of("Color", "Persistent"), persistent(FillValue::Color([0.0; 4])));
    assert_eq!(of("Color", "Persistent(initial: (0, 0.5, 1, 1))"), persistent(FillValue::Color([0.0, 0.5, 1.0, 1.0])));
    assert_eq!(of("Color", "Persistent(initial: 1)"), persistent(FillValue::Color([1.0; 4])));
    assert_eq!(of("R32_UINT", "Persistent(initial: 0xffff_ffff)"), persistent(FillValue::Bits([u32::MAX; 4])));
    assert_eq!(of("Depth", "Persistent(initial: 1.0)"), persistent(FillValue::Depth(1.0, 0)));
    assert_eq!(of("DepthStencil", "Persistent(initial: (0.5, 7))"), persistent(FillValue::Depth(0.5, 7)));
    let history = |frames, initial| Lifetime::History { frames, initial };
    let read = |format: &str, lifetime: &str, ago| {
        let images = format!(r#"(name: "past", format: {format}, size: Output, lifetime: {lifetime})"#);
        right(&reading(&images, "", &[("image", "past", ago)]), &INPUTS).images[1].lifetime.clone()
    };
    assert_eq!(read("Color", "History", 1), history(1, FillValue::Color([0.0; 4])));
    assert_eq!(read("Depth", "History(frames: 3)", 3), history(3, FillValue::Depth(0.0, 0)));
    assert_eq!(
        buffer("bytes: 8, lifetime: Persistent(initial: 7)").lifetime,
        persistent(FillValue::Bits([7, 0, 0, 0]))
    );
}

#[test]
fn a_lifetime_may_be_that_of_another() {
    let images = r#"(name: "a", format: Depth, size: Output, lifetime: Like("b")),
                    (name: "b", format: Color, size: Output, lifetime: Like("c"))"#;
    let buffers = r#"(name: "c", bytes: 4, lifetime: History(frames: 2))"#;
    let frame = right(&reading(images, buffers, &[("image", "a", 2), ("image", "b", 2)]), &INPUTS);
    let history = |initial| Lifetime::History { frames: 2, initial };
    // The kind of zero follows from the image that is filled.
    assert_eq!(frame.images[1].lifetime, history(FillValue::Depth(0.0, 0)));
    assert_eq!(frame.images[2].lifetime, history(FillValue::Color([0.0; 4])));
}

#[test]
fn states_are_named_by_purpose_or_in_the_words_of_vulkan() {
    let imported = |format: &str, states: &str| match image(&format!(
        "format: {format}, size: Output, lifetime: Imported({states})"
    ))
    .lifetime
    {
        Lifetime::Imported { before, after, .. } => (before, after),
        other => panic!("{other:?}"),
    };
    let shaders = Stages::VERTEX_SHADER | Stages::FRAGMENT_SHADER | Stages::COMPUTE_SHADER;
    let undefined = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::Undefined };
    assert_eq!(imported("Color", "before: Undefined"), (undefined, None));
    let present = State { layout: Layout::PresentSrcKhr, ..undefined };
    assert_eq!(imported("Output", "before: Undefined, after: Present"), (undefined, Some(present)));
    let sampled = |layout| State { stages: shaders, accesses: Accesses::SHADER_SAMPLED_READ, layout };
    assert_eq!(imported("Color", "before: Sampled").0, sampled(Layout::ShaderReadOnlyOptimal));
    assert_eq!(imported("Depth", "before: Sampled").0, sampled(Layout::DepthStencilReadOnlyOptimal));
    let named = "before: (stages: [COPY, BLIT], accesses: [TRANSFER_WRITE], layout: TRANSFER_DST_OPTIMAL)";
    let expected = State {
        stages: Stages::COPY | Stages::BLIT,
        accesses: Accesses::TRANSFER_WRITE,
        layout: Layout::TransferDstOptimal,
    };
    assert_eq!(imported("Color", named).0, expected);
}

#[test]
fn the_host_has_written_before_a_frame_and_reads_after_it() {
    let lifetime = buffer("bytes: 8, lifetime: Imported(before: Host, after: Host)").lifetime;
    let Lifetime::Imported { before, after: Some(after), .. } = lifetime else { panic!("{lifetime:?}") };
    assert_eq!((before.stages, before.accesses), (Stages::HOST, Accesses::HOST_WRITE));
    assert_eq!((after.stages, after.accesses), (Stages::HOST, Accesses::HOST_READ));
    assert_eq!(after.layout, Layout::Undefined);
}

#[test]
fn outputs_are_images_and_buffers_and_may_ask_for_a_state() {
    let images = r#"(name: "kept", format: Color, size: Output, lifetime: Persistent)"#;
    let buffers = r#"(name: "sums", bytes: 8, lifetime: Persistent)"#;
    let outputs = r#"(image: "kept", after: Sampled), (buffer: "sums", after: Host)"#;
    let frame = right(&pipeline("", images, buffers, outputs), &INPUTS);
    let [screen, kept, sums] = &frame.outputs[..] else { panic!("{:?}", frame.outputs) };
    assert_eq!(screen.after, None);
    assert!(matches!(kept.resource, Resource::Image(_)));
    assert_eq!(kept.after.map(|after| after.layout), Some(Layout::ShaderReadOnlyOptimal));
    assert!(matches!(sums.resource, Resource::Buffer(_)));
    assert_eq!(sums.after.map(|after| after.accesses), Some(Accesses::HOST_READ));
}

#[test]
fn settings_size_buffers_from_run_to_run() {
    let settings = r#"(name: "count", value: Integer(default: 8, min: 1, max: 1000000))"#;
    let text = pipeline(settings, "", r#"(name: "all", bytes: Times(16, "count"))"#, "");
    let set = set(&[("count", "1000000")]);
    assert_eq!(right(&text, &Inputs { set: &set, ..INPUTS }).buffers[0].bytes, 16_000_000);
}

#[test]
fn the_largest_images_and_buffers_are_described_without_overflow() {
    let fields = "format: R32G32B32A32_SFLOAT, size: Fixed(16384, 16384), samples: 16, layers: 2048";
    let image = image(fields);
    assert_eq!((image.extent, image.samples, image.layers), ([16384, 16384, 1], 16, 2048));
    assert_eq!(buffer("bytes: 1099511627776").bytes, 1 << 40);
}
