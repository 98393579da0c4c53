//! Memory that changes hands.

use crate::frames::{Small, Uses, dispatch, draw, frame, library, on_each_driver, planned, texels};
use crate::testing::Nothing;
use framewright_graph::compile::{Options, Order};
use framewright_graph::frame::{Draw, Groups};
use framewright_graph::plan::{MemoryBarrier, Plan, Role};
use framewright_graph::vulkan::{Format, Stages, Subresources};
use framewright_vulkan::{Executor, ExecutorOptions};

const WHOLE: Subresources = Subresources::WHOLE;
const ONE: Groups = Groups::Count([1, 1, 1]);

const SHADERS: &[(&str, &str)] = &[
    (
        "begin.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) writeonly buffer Words { uint word[]; };
        layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D image;
        void main() {
            for (int i = 0; i < 16; ++i) word[i] = 1000;
            imageStore(image, ivec2(0), uvec4(3));
        }",
    ),
    (
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D image;
        layout(location = 0) out uint color;
        void main() { color = texelFetch(image, ivec2(0), 0).r; }",
    ),
    (
        "go_on.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) writeonly buffer Words { uint word[]; };
        void main() { for (int i = 0; i < 16; ++i) word[i] = i; }",
    ),
    (
        "sum.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) readonly buffer Words { uint word[]; };
        layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D image;
        void main() {
            uint sum = 0;
            for (int i = 0; i < 16; ++i) sum += word[i];
            imageStore(image, ivec2(0), uvec4(sum));
        }",
    ),
    (
        "store_both.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D last;
        layout(set = 0, binding = 2, r32ui) uniform writeonly uimage2D kept;
        void main() {
            imageStore(last, ivec2(0), uvec4(9));
            imageStore(kept, ivec2(0), texelFetch(source, ivec2(0), 0) + 4);
        }",
    ),
];

/// The first step of a buffer's lifetime, and the step whose barrier hands memory over to it.
fn begins_and_taken(plan: &Plan, name: &str) -> (usize, Option<usize>) {
    let buffer = plan.buffers.iter().find(|it| *it.name == *name).expect("it is there");
    let Role::Transient(place) = &buffer.role else { panic!("it is transient") };
    let names = |it: &MemoryBarrier| it.buffers.iter().any(|hazard| hazard.buffer == buffer.id);
    let taken = plan.steps.iter().position(|step| step.memory_barriers.iter().any(names));
    (place.lifetime[0].0 as usize, taken)
}

#[test]
fn a_buffer_is_poisoned_in_order_where_an_earlier_step_s_barrier_handed_its_memory_over() {
    let mut small = Small::default();
    let [first, second] = [small.buffer("first", 16), small.buffer("second", 16)];
    let image = small.image("image", Format::R32_UINT, [1, 1]);
    let [shown, sum] = ["shown", "sum"].map(|name| small.image(name, Format::R32_UINT, [1, 1]));
    small.pass(dispatch("begin", ONE).block("Words", first, (false, true)).stores("image", image, WHOLE));
    small.pass(draw("show", Draw::FullScreen).samples("image", image, WHOLE).draws(shown, WHOLE, None));
    small.pass(dispatch("go_on", ONE).block("Words", second, (false, true)));
    small.pass(dispatch("sum", ONE).block("Words", second, (true, false)).stores("image", sum, WHOLE));
    small.image_output(shown);
    small.image_output(sum);
    on_each_driver(|device| {
        let compiled = Options { poison: true, order: Order::File, ..Options::default() };
        let plan = planned(device, &small.frame, &compiled);
        assert_eq!(begins_and_taken(&plan, "second"), (2, Some(1)), "{}", plan.tree());
        let options = ExecutorOptions { poison: true, ..ExecutorOptions::default() };
        let mut executor = Executor::new(device, &plan, &mut library(SHADERS), &options).expect("an executor");
        for _ in 0..2 {
            frame(&mut executor);
            assert_eq!(texels(&mut executor, "shown", 0), [3]);
            assert_eq!(texels(&mut executor, "sum", 0), [120]);
        }
    });
}

/// Where the layer doesn't follow barriers of other images, it takes each write of `last` for a hazard of the one in the frame
/// before.
#[test]
fn what_is_handed_over_and_back_is_followed_through_barriers_of_other_images() {
    let mut small = Small::default();
    let [first, second, last, kept] =
        ["first", "second", "last", "kept"].map(|name| small.image(name, Format::R32_UINT, [1, 1]));
    small.pass(draw("number", Draw::FullScreen).draws(first, WHOLE, None));
    small.pass(draw("show", Draw::FullScreen).samples("image", first, WHOLE).draws(second, WHOLE, None));
    let pass = dispatch("store_both", ONE).samples("source", second, WHOLE);
    small.pass(pass.stores("last", last, WHOLE).stores("kept", kept, WHOLE));
    small.image_output(kept);
    on_each_driver(|device| {
        for poison in [false, true] {
            let plan = planned(device, &small.frame, &Options { poison, ..Options::default() });
            assert_eq!(sources(&plan, "last"), [Stages::FRAGMENT_SHADER], "{}", plan.tree());
            let options = ExecutorOptions { poison, frames_in_flight: 3, ..ExecutorOptions::default() };
            let mut executor = Executor::new(device, &plan, &mut library(SHADERS), &options).expect("an executor");
            for _ in 0..3 {
                executor.submit(&mut Nothing).expect("a frame");
            }
            assert_eq!(texels(&mut executor, "kept", 0), [4]);
        }
    });
}

/// The stages that each barrier of an image waits for.
fn sources(plan: &Plan, name: &str) -> Vec<Stages> {
    let barriers = plan.steps.iter().flat_map(|step| &step.image_barriers);
    barriers.filter(|it| *plan.image(it.image).name == *name).map(|it| it.src_stages).collect()
}
