//! What a draw source binds and drops at once: it lives until the device is done with the frame, and no longer.

use crate::frames::{Small, Uses, draw, on_each_driver, planned, to_bytes, to_words};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::{Attribute, DrawInterface, SuppliedKind, SuppliedResource, VertexBuffer};
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::{
    BufferUsage, Device, DrawSource, Error, Executor, ExecutorOptions, IndexType, Recorder, Resource, ShaderLibrary,
};

const OBJECTS: Draw = Draw::Objects(DrawList::Opaque);

const SHADERS: &[(&str, &str)] = &[
    (
        "objects.vert",
        "#version 460
        layout(location = 0) in vec2 place;
        void main() { gl_Position = vec4(place, 0.0, 1.0); }",
    ),
    (
        "number.frag",
        "#version 460
        layout(set = 1, binding = 0) uniform Number { uint number; } given;
        layout(location = 0) out uint color;
        void main() { color = given.number; }",
    ),
];

fn interface(draw: Draw) -> DrawInterface {
    if draw != OBJECTS {
        return DrawInterface::default();
    }
    DrawInterface {
        vertex_buffers: vec![VertexBuffer::of_vertices(8)],
        attributes: vec![Attribute::new("place", 2, 0)],
        supplied: vec![SuppliedResource::new(1, 0, "given", SuppliedKind::UniformBlock)],
        ..DrawInterface::default()
    }
}

/// Draws a number everywhere, with buffers and a bind group for each draw that nobody else keeps.
struct Fresh<'d> {
    device: &'d Device,
    number: u32,
    draws: u32,
    fails: bool,
}

impl DrawSource for Fresh<'_> {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let corners = [-1.0, -1.0, 3.0, -1.0, -1.0, 3.0_f32].map(f32::to_bits);
        for _ in 0..self.draws {
            let vertices = self.device.buffer(BufferUsage::Vertex, &to_bytes(&corners))?;
            let indices = self.device.buffer(BufferUsage::Index, &to_bytes(&[0, 1, 2]))?;
            let number = self.device.buffer(BufferUsage::Uniform, &to_bytes(&[self.number, 0, 0, 0]))?;
            let group = self.device.bind_group(&interface(draw), 1, &[(0, Resource::Buffer(&number))])?;
            recorder.bind_group(1, &group);
            recorder.bind_vertex_buffer(&vertices);
            recorder.bind_index_buffer(&indices, IndexType::U32);
            recorder.draw_indexed(0..3, 0, 0..1);
        }
        if self.fails { Err(Error::DrawSource { what: "as it was told".to_owned() }) } else { Ok(self.draws) }
    }
}

/// Frames of one image, two in flight.
fn executor(device: &Device) -> Executor {
    let mut small = Small::default();
    let shown = small.image("shown", Format::R32_UINT, [2, 2]);
    small.pass(draw("number", OBJECTS).draws(shown, Subresources::WHOLE, Some([0.0; 4])));
    small.image_output(shown);
    let plan = planned(device, &small.frame, &Options::default());
    let options = ExecutorOptions { frames_in_flight: 2, readback: true, ..ExecutorOptions::default() };
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interface);
    Executor::new(device, &plan, &mut shaders, &options).expect("an executor")
}

/// Submits the number of frames, waits for each one after the next is submitted, and looks at what it drew.
fn run(executor: &mut Executor, source: &mut Fresh<'_>, frames: u32) {
    let mut last: Option<(u64, u32)> = None;
    for _ in 0..frames {
        source.number += 1;
        let frame = executor.submit(source).expect("a frame");
        let drawn = if source.draws > 0 { source.number } else { 0 };
        if let Some((frame, drawn)) = last.replace((frame, drawn)) {
            let kept = executor.read_back_image(frame, 0).expect("texels").bytes;
            assert_eq!(to_words(&kept), [drawn; 4], "frame {frame}");
        }
    }
}

#[test]
fn what_a_draw_source_drops_lives_as_long_as_its_frame_and_no_longer() {
    on_each_driver(|device| {
        let mut executor = executor(device);
        let mut source = Fresh { device, number: 0, draws: 0, fails: false };
        run(&mut executor, &mut source, 4);
        let nothing_held = device.memory_in_use();
        source.draws = 3;
        run(&mut executor, &mut source, 4);
        let held = device.memory_in_use();
        assert!(held.allocations > nothing_held.allocations);
        run(&mut executor, &mut source, 30);
        assert_eq!(device.memory_in_use(), held, "each frame holds as much as the one before");
        source.draws = 0;
        run(&mut executor, &mut source, 2);
        let left = device.memory_in_use();
        assert_eq!((left.allocations, left.bytes), (nothing_held.allocations, nothing_held.bytes));
    });
}

#[test]
fn a_frame_that_the_draw_source_breaks_off_lets_go_of_nothing_in_use_and_leaves_nothing_behind() {
    on_each_driver(|device| {
        let mut executor = executor(device);
        let mut source = Fresh { device, number: 0, draws: 2, fails: false };
        run(&mut executor, &mut source, 4);
        let held = device.memory_in_use();
        for _ in 0..5 {
            let flying = executor.submit(&mut source).expect("a frame");
            (source.draws, source.fails) = (3, true);
            assert!(matches!(executor.submit(&mut source), Err(Error::DrawSource { .. })));
            assert_eq!(to_words(&executor.read_back_image(flying, 0).expect("texels").bytes), [source.number; 4]);
            (source.draws, source.fails) = (2, false);
            run(&mut executor, &mut source, 2);
        }
        assert_eq!(device.memory_in_use(), held);
    });
}
