//! Compute passes: how many workgroups there are, and what shaders read and write without attachments.

use crate::frames::{Small, Uses, dispatch, draw, everywhere, frame, texels, transfer, words};
use framewright_graph::frame::{BufferRole, Draw, Groups, Pass, Resource, Work};
use framewright_graph::vulkan::{FillValue, Format, Subresources};

const WHOLE: Subresources = Subresources::WHOLE;
const ONE: Groups = Groups::Count([1, 1, 1]);

const SHADERS: &[(&str, &str)] = &[
    (
        "number.comp",
        "#version 460
        layout(local_size_x = 4) in;
        layout(set = 0, binding = 0) buffer Words { uint word[]; } words;
        void main() { words.word[gl_GlobalInvocationID.x] = gl_WorkGroupID.x * 10 + gl_LocalInvocationID.x; }",
    ),
    (
        "count.comp",
        "#version 460
        layout(local_size_x = 4, local_size_y = 2) in;
        layout(set = 0, binding = 0) buffer Words { uint groups; uint most[2]; uint invocations; } words;
        void main() {
            if (gl_LocalInvocationIndex == 0) atomicAdd(words.groups, 1);
            atomicMax(words.most[0], gl_WorkGroupID.x);
            atomicMax(words.most[1], gl_WorkGroupID.y);
            atomicAdd(words.invocations, 1);
        }",
    ),
    (
        "decide.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) writeonly buffer Counts { uint count[]; } counts;
        void main() {
            for (int i = 0; i < 8; ++i) counts.count[i] = 99;
            counts.count[2] = 2;
            counts.count[3] = 3;
            counts.count[4] = 1;
        }",
    ),
    (
        "place.comp",
        "#version 460
        layout(local_size_x = 4, local_size_y = 4) in;
        layout(set = 0, binding = 0, r32ui) uniform writeonly uimage2D target;
        void main() {
            ivec2 at = ivec2(gl_GlobalInvocationID.xy);
            imageStore(target, at, uvec4(at.x + 10 * at.y));
        }",
    ),
    (
        "double.comp",
        "#version 460
        layout(local_size_x = 4, local_size_y = 4) in;
        layout(set = 0, binding = 0, r32ui) uniform readonly uimage2D source;
        layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D target;
        void main() {
            ivec2 at = ivec2(gl_GlobalInvocationID.xy);
            imageStore(target, at, 2 * imageLoad(source, at));
        }",
    ),
    (
        "increase.comp",
        "#version 460
        layout(local_size_x = 4, local_size_y = 4) in;
        layout(set = 0, binding = 0, r32ui) uniform uimage2D target;
        void main() {
            ivec2 at = ivec2(gl_GlobalInvocationID.xy);
            imageStore(target, at, imageLoad(target, at) + 1);
        }",
    ),
    (
        "tally.comp",
        "#version 460
        layout(local_size_x = 64) in;
        layout(set = 0, binding = 0, r32ui) uniform uimage2D target;
        void main() { imageAtomicAdd(target, ivec2(gl_LocalInvocationID.x % 4, 0), gl_LocalInvocationID.x); }",
    ),
    (
        "draw_and_tally.frag",
        "#version 460
        layout(set = 0, binding = 0) buffer Words { uint word[]; } words;
        layout(set = 0, binding = 1) uniform Base { uint value; } base;
        layout(location = 0) out uint color;
        void main() {
            atomicAdd(words.word[int(gl_FragCoord.y)], 1);
            color = base.value + uint(gl_FragCoord.x);
        }",
    ),
];

fn filled(buffer: framewright_graph::frame::BufferIndex, word: u32) -> Pass {
    let value = FillValue::Bits([word, 0, 0, 0]);
    transfer("fill", Work::Fill { value }, &[(Resource::Buffer(buffer), WHOLE, true)])
}

#[test]
fn a_dispatch_has_as_many_workgroups_as_it_says_and_what_it_leaves_out_stays() {
    let mut small = Small::default();
    let buffer = small.buffer("b", 14);
    small.pass(filled(buffer, 7));
    small.pass(dispatch("number", Groups::Count([3, 1, 1])).block("words", buffer, (true, true)));
    small.buffer_output(buffer);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        assert_eq!(words(executor, "b"), [0, 1, 2, 3, 10, 11, 12, 13, 20, 21, 22, 23, 7, 7]);
    });
}

#[test]
fn a_dispatch_over_a_size_has_workgroups_enough_to_cover_it() {
    let mut small = Small::default();
    let buffer = small.buffer("b", 4);
    small.pass(filled(buffer, 0));
    small.pass(dispatch("count", Groups::Invocations([10, 3, 1])).block("words", buffer, (true, true)));
    small.buffer_output(buffer);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        // Workgroups of 4 × 2: three by two of them.
        assert_eq!(words(executor, "b"), [6, 2, 1, 48]);
    });
}

#[test]
fn an_indirect_dispatch_takes_its_count_from_what_a_pass_wrote() {
    let mut small = Small::default();
    let [counts, buffer] = [small.buffer("counts", 8), small.buffer("b", 4)];
    small.pass(dispatch("decide", ONE).block("counts", counts, (false, true)));
    small.pass(filled(buffer, 0));
    let indirect = dispatch("count", Groups::Indirect { offset: 8 }).takes(counts, BufferRole::Indirect);
    small.pass(indirect.block("words", buffer, (true, true)));
    small.buffer_output(buffer);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        assert_eq!(words(executor, "b"), [6, 1, 2, 48]);
    });
}

#[test]
fn storage_images_are_written_read_and_changed_in_place() {
    let mut small = Small::default();
    let [a, b] = ["a", "b"].map(|name| small.image(name, Format::R32_UINT, [4, 4]));
    small.pass(dispatch("place", ONE).stores("target", a, WHOLE));
    small.pass(dispatch("double", ONE).loads("source", a, WHOLE).stores("target", b, WHOLE));
    small.pass(dispatch("increase", ONE).modifies("target", b));
    small.image_output(b);
    let expected: Vec<u32> = (0..16).map(|at| 2 * (at % 4 + 10 * (at / 4)) + 1).collect();
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        assert_eq!(texels(executor, "b", 0), expected);
    });
}

#[test]
fn atomics_on_an_image_add_up() {
    let mut small = Small::default();
    let image = small.image("i", Format::R32_UINT, [4, 1]);
    let value = FillValue::Bits([1000, 0, 0, 0]);
    small.pass(transfer("fill", Work::Fill { value }, &[(Resource::Image(image), WHOLE, true)]));
    small.pass(dispatch("tally", ONE).modifies("target", image));
    small.image_output(image);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        // 0 + 4 + … + 60 = 480, and 16 more for each next one.
        assert_eq!(texels(executor, "i", 0), [1480, 1496, 1512, 1528]);
    });
}

#[test]
fn a_fragment_shader_counts_in_a_buffer_and_reads_a_uniform_block_that_a_pass_wrote() {
    let mut small = Small::default();
    let [tally, base] = [small.buffer("tally", 3), small.buffer("base", 4)];
    let image = small.image("i", Format::R32_UINT, [5, 3]);
    small.pass(filled(tally, 100));
    small.pass(Pass { name: "fill base".into(), ..filled(base, 40) });
    let drawn = draw("draw_and_tally", Draw::FullScreen).block("words", tally, (true, true)).uniform("base", base);
    small.pass(drawn.draws(image, WHOLE, None));
    small.image_output(image);
    small.buffer_output(tally);
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        assert_eq!(words(executor, "tally"), [105; 3]);
        assert_eq!(texels(executor, "i", 0), [40, 41, 42, 43, 44].repeat(3));
    });
}
