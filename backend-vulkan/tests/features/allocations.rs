//! Drawing a frame allocates nothing: what it needs is prepared before, and a report is made only for those who ask for it.
//!
//! Counted are allocations of Rust's allocator on the thread that submits the frame and waits for it. The drivers and the
//! validation layer have allocators of their own, which nobody counts.

use crate::frames::{Small, Uses, copy, dispatch, draw, on_each_driver, planned, transfer};
use crate::testing::{OVER_ALL, WHITE};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, DrawList, Frame, Groups, Image, Lifetime, Resource, Work};
use framewright_graph::plan;
use framewright_graph::shader::{DrawInterface, SuppliedKind, SuppliedResource};
use framewright_graph::vulkan::{FillValue, Filter, Format, Subresources};
use framewright_vulkan::{
    BindGroup, BufferUsage, CustomRecorder, Device, DrawSource, Error, Executor, ExecutorOptions, Recorder,
    ShaderLibrary,
};

const WHOLE: Subresources = Subresources::WHOLE;
const FORMAT: Format = Format::R8G8B8A8_UNORM;
const FRAMES: u64 = 6;

const SHADERS: &[(&str, &str)] = &[
    ("full_screen.vert", OVER_ALL),
    (
        "objects.vert",
        "#version 460
        layout(set = 1, binding = 0) uniform View { vec4 shift; } view;
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) + view.shift.xy, 0.0, 1.0); }",
    ),
    ("white.frag", WHITE),
    (
        "blend.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D now;
        layout(set = 0, binding = 1) uniform sampler2D last;
        layout(location = 0) out vec4 color;
        void main() { color = mix(texelFetch(now, ivec2(0), 0), texelFetch(last, ivec2(0), 0), 0.5); }",
    ),
    (
        "count.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) uniform sampler2D filled;
        layout(set = 0, binding = 1) uniform sampler2D smaller;
        layout(set = 0, binding = 2) buffer Words { uint word[]; };
        void main() { word[0] += uint(texelFetch(filled, ivec2(0), 0).r + texelFetch(smaller, ivec2(0), 0).r); }",
    ),
];

fn interface(draw: Draw) -> DrawInterface {
    let view = SuppliedResource::new(1, 0, "view", SuppliedKind::UniformBlock);
    let supplied = if draw == Draw::Objects(DrawList::Opaque) { vec![view] } else { Vec::new() };
    DrawInterface { supplied, ..DrawInterface::default() }
}

/// A frame of every kind of step that the compiler makes of passes.
fn every_kind_of_step() -> Frame {
    let mut small = Small::default();
    let [drawn, filled] =
        ["drawn", "filled"].map(|name| small.image_like(Image { samples: 4, ..Image::new(name, FORMAT, 4, 4) }));
    let lifetime = Lifetime::History { frames: 1, initial: FillValue::Color([0.0; 4]) };
    let blended = small.image_like(Image { lifetime, ..Image::new("blended", FORMAT, 4, 4) });
    let smaller = small.image("smaller", FORMAT, [2, 2]);
    let shown = small.image("shown", FORMAT, [4, 4]);
    let words = small.buffer_with("words", 4, Lifetime::Persistent { initial: FillValue::Bits([0; 4]) });
    let [copied, custom] = ["copied", "custom"].map(|name| small.buffer(name, 4));

    small.pass(draw("white", Draw::Objects(DrawList::Opaque)).draws(drawn, WHOLE, Some([0.0; 4])));
    let blend = draw("blend", Draw::FullScreen).samples("now", drawn, WHOLE);
    small.pass(blend.samples_earlier("last", blended, 1).draws(blended, WHOLE, None));
    let sides = [blended, smaller].map(Resource::Image);
    let filter = Filter::Linear;
    small.pass(transfer("blit", Work::Blit { filter }, &[(sides[0], WHOLE, false), (sides[1], WHOLE, true)]));
    small.pass(copy("copy", (Resource::Image(blended), WHOLE), (Resource::Image(shown), WHOLE)));
    let value = FillValue::Color([0.5; 4]);
    small.pass(transfer("fill", Work::Fill { value }, &[(Resource::Image(filled), WHOLE, true)]));
    let count = dispatch("count", Groups::Count([1, 1, 1])).samples("filled", filled, WHOLE);
    small.pass(count.samples("smaller", smaller, WHOLE).block("Words", words, (true, true)));
    small.pass(copy("copy words", (Resource::Buffer(words), WHOLE), (Resource::Buffer(copied), WHOLE)));
    let sides = [(Resource::Buffer(copied), WHOLE, false), (Resource::Buffer(custom), WHOLE, true)];
    small.pass(transfer("by hand", Work::Custom { callback: "by_hand".into() }, &sides));
    small.image_output(shown);
    small.buffer_output(custom);
    small.frame
}

/// The kinds of work in the frame.
const KINDS: [fn(&plan::Work) -> bool; 7] = [
    |it| matches!(it, plan::Work::Render(scope) if scope.attachments[0].resolve.is_some()),
    |it| matches!(it, plan::Work::Dispatch(_)),
    |it| matches!(it, plan::Work::Custom(_)),
    |it| matches!(it, plan::Work::Resolve(_)),
    |it| matches!(it, plan::Work::Copy(_)),
    |it| matches!(it, plan::Work::Blit(_)),
    |it| matches!(it, plan::Work::Fill(_)),
];

/// Draws a triangle, and copies in custom passes.
struct Source {
    group: BindGroup,
}

impl Source {
    fn new(device: &Device) -> Source {
        let view = device.buffer(BufferUsage::Uniform, &[0; 16]).expect("a buffer");
        let resources = [(0, framewright_vulkan::Resource::Buffer(&view))];
        let group = device.bind_group(&interface(Draw::Objects(DrawList::Opaque)), 1, &resources);
        Source { group: group.expect("a bind group") }
    }
}

impl DrawSource for Source {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        recorder.bind_group(1, &self.group);
        recorder.draw(0..3, 0..1);
        Ok(1)
    }

    fn custom(&mut self, _: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        recorder.copy("copied", "custom");
        Ok(())
    }
}

/// How often drawing each of some frames allocated.
fn allocations(device: &Device, plan: &plan::Plan, options: &ExecutorOptions) -> Vec<u64> {
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interface);
    let mut executor = Executor::new(device, plan, &mut shaders, options).expect("an executor");
    let mut source = Source::new(device);
    let mut draw = |_| {
        let counted = allocation_counter::measure(|| {
            executor.frame(&mut source).expect("a frame");
        });
        counted.count_total
    };
    (0..FRAMES).map(&mut draw).collect()
}

#[test]
fn from_the_third_frame_on_drawing_allocates_nothing() {
    on_each_driver(|device| {
        for (poison, frames_in_flight, readback, timestamps) in
            [(false, 1, false, false), (true, 1, false, true), (false, 2, true, false)]
        {
            let plan = planned(device, &every_kind_of_step(), &Options { poison, ..Options::default() });
            for is_of_kind in KINDS {
                assert!(plan.steps.iter().any(|step| is_of_kind(&step.work)), "{}", plan.tree());
            }
            let options =
                ExecutorOptions { poison, frames_in_flight, readback, timestamps, ..ExecutorOptions::default() };
            let counted = allocations(device, &plan, &options);
            assert_eq!(counted[2..], [0; FRAMES as usize - 2], "{options:?}: {counted:?}");
            assert!(counted[0] > 0, "the first frame sets initial contents: nothing is counted");
        }
    });
}
