//! Memory of buffers that changes hands, under poison.

use crate::frames::{Small, Uses, dispatch, draw, frame, library, on_each_driver, planned, texels};
use framewright_graph::compile::{Options, Order};
use framewright_graph::format::Format;
use framewright_graph::frame::{Draw, Groups};
use framewright_graph::plan::{MemoryBarrier, Plan, Role};
use framewright_graph::vocabulary::Subresources;
use framewright_vulkan::{Executor, ExecutorOptions};

const WHOLE: Subresources = Subresources::WHOLE;
const ONE: Groups = Groups::Count([1, 1, 1]);

const SHADERS: &[(&str, &str)] = &[
    (
        "begin.comp",
        "#version 460
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
        layout(set = 0, binding = 0) writeonly buffer Words { uint word[]; };
        void main() { for (int i = 0; i < 16; ++i) word[i] = i; }",
    ),
    (
        "sum.comp",
        "#version 460
        layout(set = 0, binding = 0) readonly buffer Words { uint word[]; };
        layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D image;
        void main() {
            uint sum = 0;
            for (int i = 0; i < 16; ++i) sum += word[i];
            imageStore(image, ivec2(0), uvec4(sum));
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
