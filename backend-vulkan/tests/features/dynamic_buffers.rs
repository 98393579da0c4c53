//! Buffers that are written in each frame while the frame before is still drawn (EM-6).

use crate::frames::{Small, Uses, draw, on_each_driver, planned, to_bytes, to_words};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::{Attribute, DrawInterface, SuppliedKind, SuppliedResource, VertexBuffer};
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::{
    BindGroup, BufferUsage, Device, DrawSource, DynamicBuffer, Error, Executor, ExecutorOptions, Recorder, Resource,
    ShaderLibrary,
};

const OBJECTS: Draw = Draw::Objects(DrawList::Opaque);

const SHADERS: &[(&str, &str)] = &[
    (
        "objects.vert",
        "#version 460
        layout(location = 0) in vec2 place;
        layout(location = 0) flat out uint instance;
        void main() { gl_Position = vec4(place, 0.0, 1.0); instance = gl_InstanceIndex; }",
    ),
    (
        "number.frag",
        "#version 460
        layout(location = 0) flat in uint instance;
        layout(set = 1, binding = 0) uniform Camera { uint number; } camera;
        layout(set = 1, binding = 1) readonly buffer Objects { uint number[]; } objects;
        layout(set = 1, binding = 2) uniform Fixed { uint number; } fixed_number;
        layout(location = 0) out uint color;
        void main() { color = camera.number + objects.number[instance] + fixed_number.number; }",
    ),
];

fn interface(draw: Draw) -> DrawInterface {
    if draw != OBJECTS {
        return DrawInterface::default();
    }
    DrawInterface {
        vertex_buffers: vec![VertexBuffer::of_vertices(8)],
        attributes: vec![Attribute::new("place", 2, 0)],
        supplied: vec![
            SuppliedResource::new(1, 0, "camera", SuppliedKind::UniformBlock),
            SuppliedResource::new(1, 1, "objects", SuppliedKind::StorageBlock),
            SuppliedResource::new(1, 2, "fixed_number", SuppliedKind::UniformBlock),
        ],
        ..DrawInterface::default()
    }
}

/// Draws the left and the right half, with numbers that differ from frame to frame and within each.
struct Moving {
    camera: DynamicBuffer,
    objects: DynamicBuffer,
    corners: DynamicBuffer,
    group: BindGroup,
}

impl Moving {
    fn new(device: &Device) -> Moving {
        let dynamic = |usage, bytes| device.dynamic_buffer(usage, bytes).expect("memory");
        let camera = dynamic(BufferUsage::Uniform, 16);
        let objects = dynamic(BufferUsage::Storage, 8);
        let fixed = device.buffer(BufferUsage::Uniform, &to_bytes(&[5, 0, 0, 0])).expect("memory");
        let resources =
            [(0, Resource::Dynamic(&camera)), (1, Resource::Dynamic(&objects)), (2, Resource::Buffer(&fixed))];
        let group = device.bind_group(&interface(OBJECTS), 1, &resources).expect("it fits");
        Moving { camera, objects, corners: dynamic(BufferUsage::Vertex, 48), group }
    }

    /// A rectangle from `left` to `right`, in clip space.
    fn half(&self, left: f32, right: f32, recorder: &mut Recorder<'_>) -> Result<(), Error> {
        let corners = [[left, -1.0], [right, -1.0], [left, 1.0], [left, 1.0], [right, -1.0], [right, 1.0]];
        self.corners.write(corners.map(|corner| corner.map(f32::to_ne_bytes)).as_flattened().as_flattened())?;
        recorder.bind_vertex_buffer(&self.corners.current());
        Ok(())
    }
}

impl DrawSource for Moving {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let frame = u32::try_from(recorder.frame()).expect("few");
        // The second number is that of the second instance.
        self.objects.write([100 * frame, 1000 * frame].map(u32::to_ne_bytes).as_flattened())?;
        for (half, [left, right]) in [(0, [-1.0, 0.0]), (1, [0.0, 1.0])] {
            self.camera.write(&(10_u32 + half).to_ne_bytes())?;
            recorder.bind_group(1, &self.group);
            self.half(left, right, recorder)?;
            recorder.draw(0..6, half..half + 1);
        }
        Ok(2)
    }
}

fn executor(device: &Device) -> Executor {
    let mut small = Small::default();
    let shown = small.image("shown", Format::R32_UINT, [2, 1]);
    small.pass(draw("number", OBJECTS).draws(shown, Subresources::WHOLE, Some([0.0; 4])));
    small.image_output(shown);
    let plan = planned(device, &small.frame, &Options::default());
    let options = ExecutorOptions { frames_in_flight: 3, readback: true, ..ExecutorOptions::default() };
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interface);
    Executor::new(device, &plan, &mut shaders, &options).expect("an executor")
}

/// Looks at frames only after two more were recorded.
fn run(executor: &mut Executor, source: &mut Moving, frames: u32) {
    let mut on_their_way = Vec::new();
    for _ in 0..frames {
        on_their_way.push(executor.submit(source).expect("a frame"));
        if on_their_way.len() == 3 {
            let frame = on_their_way.remove(0);
            let number = u32::try_from(frame).expect("few");
            let kept = executor.read_back_image(frame, 0).expect("texels").bytes;
            assert_eq!(to_words(&kept), [15 + 100 * number, 16 + 1000 * number], "frame {frame}");
        }
    }
}

#[test]
fn each_draw_reads_what_was_written_last_before_it() {
    on_each_driver(|device| {
        let (mut executor, mut source) = (executor(device), Moving::new(device));
        run(&mut executor, &mut source, 8);
        let after_some = device.memory_in_use();
        run(&mut executor, &mut source, 40);
        assert_eq!(device.memory_in_use(), after_some, "copies are used again");
    });
}

#[test]
fn once_there_are_copies_enough_a_frame_allocates_nothing() {
    on_each_driver(|device| {
        let (mut executor, mut source) = (executor(device), Moving::new(device));
        run(&mut executor, &mut source, 12);
        let frame = allocation_counter::measure(|| {
            executor.submit(&mut source).expect("a frame");
        });
        assert_eq!(frame.count_total, 0);
    });
}

#[test]
fn what_a_dynamic_buffer_cannot_do_is_refused() {
    on_each_driver(|device| {
        let small = device.dynamic_buffer(BufferUsage::Uniform, 16).expect("memory");
        assert_eq!(small.bytes(), 16);
        let refused = small.write(&[0; 17]).expect_err("too much");
        assert_eq!(refused.to_string(), "17 bytes were written to a dynamic buffer, which holds 16");
        let refused = device.dynamic_buffer(BufferUsage::Uniform, u64::MAX).err().expect("too much");
        assert!(matches!(refused, Error::BadResource { .. }), "{refused}");
        let refused = device.dynamic_buffer(BufferUsage::Vertex, 1 << 50).err().expect("too much");
        assert!(matches!(refused, Error::OutOfMemory { .. } | Error::Vulkan { .. }), "{refused}");
        let vertices = device.dynamic_buffer(BufferUsage::Vertex, 16).expect("memory");
        let fixed = device.buffer(BufferUsage::Uniform, &[0; 16]).expect("memory");
        let given =
            [(0, Resource::Dynamic(&vertices)), (1, Resource::Dynamic(&vertices)), (2, Resource::Buffer(&fixed))];
        let refused = device.bind_group(&interface(OBJECTS), 1, &given).err().expect("made for vertices");
        assert!(refused.to_string().contains("`camera` is a uniform block, and something else was given"), "{refused}");
    });
}
