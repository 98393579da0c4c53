//! Depth and stencil: planes that are tested, written and sampled, each for itself.

use crate::frames::{Small, Uses, draw, everywhere, frame, plane, texels, to_words};
use framewright_graph::base::Span;
use framewright_graph::frame::{DepthTarget, Draw, Image, ImageIndex, Lifetime, Pass, StencilState, Work};
use framewright_graph::vulkan::{Aspects, CompareOp, FillValue, Format, StencilOp, Subresources};

const WHOLE: Subresources = Subresources::WHOLE;
const BOTH: Format = Format::D32_SFLOAT_S8_UINT;
const EXTENT: [u32; 2] = [4, 2];

const SHADERS: &[(&str, &str)] = &[
    (
        "full_screen.vert",
        "#version 460
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0); }",
    ),
    (
        "near_left.vert",
        "#version 460
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.75, 1.0); }",
    ),
    ("near_left.frag", "#version 460\nvoid main() { if (gl_FragCoord.x > 2.0) discard; }"),
    (
        "test_and_sample.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D tested;
        layout(location = 0) out uint color;
        void main() { color = uint(texelFetch(tested, ivec2(gl_FragCoord.xy), 0).r * 16.0) + 100; }",
    ),
    (
        "seven.frag",
        "#version 460
        layout(location = 0) out uint color;
        void main() { color = 7; }",
    ),
    (
        "show_both.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D depths;
        layout(set = 0, binding = 1) uniform usampler2D stencils;
        layout(location = 0) out uint color;
        void main() {
            ivec2 at = ivec2(gl_FragCoord.xy);
            color = uint(texelFetch(depths, at, 0).r * 16.0) + 100 * texelFetch(stencils, at, 0).r;
        }",
    ),
];

fn depth(image: ImageIndex, clear: Option<f64>, test: CompareOp, write: bool) -> DepthTarget {
    DepthTarget { image, range: WHOLE, span: Span::NONE, clear, test, write, stencil: None }
}

fn stencil(clear: Option<u8>, test: CompareOp, reference: u8, pass: StencilOp) -> StencilState {
    StencilState { clear, test, reference, pass }
}

/// Draws 0.75 into the left half of the depth plane, which is cleared to 0.25.
fn near_left(target: DepthTarget) -> Pass {
    let work = Work::Draw { draw: Draw::FullScreen, shader: "near_left".into(), discards: true, per_sample: false };
    Pass::new("near_left", work).tests(target)
}

#[test]
fn depth_is_sampled_by_the_pass_that_tests_against_it() {
    for format in [Format::D32_SFLOAT, Format::D16_UNORM, BOTH] {
        let mut small = Small::default();
        let tested = small.image("depth", format, EXTENT);
        let color = small.image("color", Format::R32_UINT, EXTENT);
        small.pass(near_left(depth(tested, Some(0.25), CompareOp::Greater, true)));
        // The triangle at 0.5 is hidden on the left.
        let pass = draw("test_and_sample", Draw::FullScreen).samples("tested", tested, plane(Aspects::DEPTH));
        let read_only = depth(tested, None, CompareOp::Greater, false);
        small.pass(pass.tests(read_only).draws(color, WHOLE, Some([1.0; 4])));
        small.image_output(color);
        everywhere(&small.frame, SHADERS, |executor| {
            frame(executor);
            // 0.25 in 16 bits is a little less than a quarter.
            let right = if format == Format::D16_UNORM { 103..=104 } else { 104..=104 };
            let seen = texels(executor, "color", 0);
            assert_eq!([&seen[..2], &seen[4..6]], [[1; 2]; 2]);
            assert!(seen[2..4].iter().chain(&seen[6..]).all(|texel| right.contains(texel)), "{format}: {seen:?}");
        });
    }
}

#[test]
fn stencil_marks_where_a_later_pass_may_draw() {
    let mut small = Small::default();
    let marked = small.image("marked", BOTH, EXTENT);
    let color = small.image("color", Format::R32_UINT, EXTENT);
    let marks = stencil(Some(2), CompareOp::Always, 9, StencilOp::Replace);
    small.pass(near_left(DepthTarget { stencil: Some(marks), ..depth(marked, Some(0.0), CompareOp::Always, true) }));
    let tests = stencil(None, CompareOp::NotEqual, 9, StencilOp::Keep);
    let tested = DepthTarget { stencil: Some(tests), ..depth(marked, None, CompareOp::Always, false) };
    small.pass(draw("seven", Draw::FullScreen).tests(tested).draws(color, WHOLE, Some([1.0; 4])));
    small.image_output(color);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        assert_eq!(texels(executor, "color", 0), [1, 1, 7, 7, 1, 1, 7, 7]);
    });
}

#[test]
fn both_planes_are_sampled_at_once() {
    let mut small = Small::default();
    let both = small.image("both", BOTH, EXTENT);
    let color = small.image("color", Format::R32_UINT, EXTENT);
    let marks = stencil(Some(3), CompareOp::Always, 0, StencilOp::IncrementAndClamp);
    small.pass(near_left(DepthTarget { stencil: Some(marks), ..depth(both, Some(0.25), CompareOp::Greater, true) }));
    let pass = draw("show_both", Draw::FullScreen).samples("depths", both, plane(Aspects::DEPTH));
    small.pass(pass.samples("stencils", both, plane(Aspects::STENCIL)).draws(color, WHOLE, None));
    small.image_output(color);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        assert_eq!(texels(executor, "color", 0), [412, 412, 304, 304, 412, 412, 304, 304]);
    });
}

#[test]
fn one_plane_is_sampled_while_the_other_is_written() {
    let mut small = Small::default();
    let both = small.image("both", BOTH, EXTENT);
    let [first, second] = ["first", "second"].map(|name| small.image(name, Format::R32_UINT, EXTENT));
    let marks = stencil(Some(3), CompareOp::Always, 0, StencilOp::Keep);
    small.pass(near_left(DepthTarget { stencil: Some(marks), ..depth(both, Some(0.25), CompareOp::Greater, true) }));
    let counts = stencil(None, CompareOp::Always, 0, StencilOp::IncrementAndClamp);
    let counted = DepthTarget { stencil: Some(counts), ..depth(both, None, CompareOp::Greater, false) };
    let pass = draw("test_and_sample", Draw::FullScreen).samples("tested", both, plane(Aspects::DEPTH));
    small.pass(pass.tests(counted).draws(first, WHOLE, Some([1.0; 4])));
    let pass = draw("show_both", Draw::FullScreen).samples("depths", both, plane(Aspects::DEPTH));
    small.pass(pass.samples("stencils", both, plane(Aspects::STENCIL)).draws(second, WHOLE, None));
    small.image_output(first);
    small.image_output(second);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        assert_eq!(texels(executor, "first", 0), [1, 1, 104, 104, 1, 1, 104, 104]);
        assert_eq!(texels(executor, "second", 0), [312, 312, 404, 404, 312, 312, 404, 404]);
    });
}

#[test]
fn planes_that_persist_are_found_as_the_frame_before_left_them() {
    let mut small = Small::default();
    let lifetime = Lifetime::Persistent { initial: FillValue::Depth(0.25, 3) };
    let [width, height] = EXTENT;
    let both = small.image_like(Image { lifetime, ..Image::new("both", BOTH, width, height) });
    let color = small.image("color", Format::R32_UINT, EXTENT);
    let pass = draw("show_both", Draw::FullScreen).samples("depths", both, plane(Aspects::DEPTH));
    small.pass(pass.samples("stencils", both, plane(Aspects::STENCIL)).draws(color, WHOLE, None));
    let counts = stencil(None, CompareOp::Always, 0, StencilOp::IncrementAndClamp);
    small.pass(near_left(DepthTarget { stencil: Some(counts), ..depth(both, None, CompareOp::Always, true) }));
    small.image_output(color);
    everywhere(&small.frame, SHADERS, |executor| {
        for left in [304, 412, 512] {
            frame(executor);
            assert_eq!(texels(executor, "color", 0), [left, left, 304, 304].repeat(2));
        }
        let depths = executor.read_image("both", Aspects::DEPTH, 0).expect("depth").bytes;
        assert_eq!(to_words(&depths)[1..3], [0.75_f32.to_bits(), 0.25_f32.to_bits()]);
        assert_eq!(executor.read_image("both", Aspects::STENCIL, 0).expect("stencil").bytes[1..3], [6, 3]);
    });
}

#[test]
fn planes_are_written_by_the_host_for_the_next_frame() {
    let mut small = Small::default();
    let lifetime = Lifetime::Persistent { initial: FillValue::Depth(0.0, 0) };
    let [width, height] = EXTENT;
    let both = small.image_like(Image { lifetime, ..Image::new("both", BOTH, width, height) });
    let color = small.image("color", Format::R32_UINT, EXTENT);
    let pass = draw("show_both", Draw::FullScreen).samples("depths", both, plane(Aspects::DEPTH));
    small.pass(pass.samples("stencils", both, plane(Aspects::STENCIL)).draws(color, WHOLE, None));
    small.image_output(color);
    everywhere(&small.frame, SHADERS, |executor| {
        let depths: Vec<u8> = (0..8_u8).flat_map(|at| (f32::from(at) / 16.0).to_ne_bytes()).collect();
        executor.write_image("both", Aspects::DEPTH, 0, &depths).expect("depth");
        executor.write_image("both", Aspects::STENCIL, 0, &[9; 8]).expect("stencil");
        frame(executor);
        assert_eq!(texels(executor, "color", 0), (900..908).collect::<Vec<_>>());
    });
}
