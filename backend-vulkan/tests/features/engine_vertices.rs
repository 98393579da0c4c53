//! Vertices of a draw source: several buffers, any format, by vertex and by instance, and interfaces of custom passes by their names (DO-5).
//! Each picture equals that of the same vertices in one buffer of floats.

use crate::frames::{Small, Uses, draw, on_each_driver, planned, texels, to_bytes};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, DrawList, Pass, RasterState};
use framewright_graph::plan::Plan;
use framewright_graph::shader::{
    Attribute, DrawInterface, DrawInterfaces, DrawKind, PushConstants, VertexBuffer, VertexRate,
};
use framewright_graph::vulkan::{Format, PrimitiveTopology, Stages, Subresources, VertexFormat};
use framewright_vulkan::{
    Buffer, BufferUsage, Device, DrawSource, Error, Executor, ExecutorOptions, IndexType, Recorder, ShaderLibrary,
};

pub(crate) const OBJECTS: Draw = Draw::Objects(DrawList::Opaque);
const EXTENT: [u32; 2] = [8, 8];
/// Six corners of a square.
const CORNERS: [[i16; 2]; 6] = [[-1, -1], [1, -1], [-1, 1], [-1, 1], [1, -1], [1, 1]];

pub(crate) const SHADERS: &[(&str, &str)] = &[
    (
        "many.vert",
        "#version 460
        layout(location = 0) in vec2 place;
        layout(location = 1) in vec4 tint;
        layout(location = 2) in mat2 turn;
        layout(location = 4) in vec2 shift;
        layout(location = 5) in uint number;
        layout(location = 6) in ivec2 signs;
        layout(location = 7) in vec4 bits;
        layout(location = 0) flat out uint value;
        void main() {
            gl_Position = vec4(turn * place + shift, 0.0, 1.0);
            value = uint(round(tint.z * 255.0)) + 1000 * number + uint(10000 * -signs.y) + 100000 * uint(round(bits.x * 1023.0));
        }",
    ),
    (
        "plain.vert",
        "#version 460
        layout(location = 0) in vec2 place;
        layout(location = 1) in float given;
        layout(location = 0) flat out uint value;
        void main() { gl_Position = vec4(place, 0.0, 1.0); gl_PointSize = 1.0; value = uint(given); }",
    ),
    ("many.frag", VALUE),
    ("plain.frag", VALUE),
];

const VALUE: &str = "#version 460
    layout(location = 0) flat in uint value;
    layout(location = 0) out uint color;
    void main() { color = value; }";

/// Places, tints, and what instances have: a matrix, half floats, integers and packed numbers.
fn many(divisor: u32) -> DrawInterface {
    let instance = VertexRate::Instance { divisor };
    DrawInterface {
        vertex_buffers: vec![
            VertexBuffer::of_vertices(4),
            VertexBuffer::of_vertices(8),
            VertexBuffer { stride: 28, rate: instance },
        ],
        attributes: vec![
            Attribute::of_format("place", VertexFormat::R16G16_SNORM, 0),
            Attribute::of_format("tint", VertexFormat::B8G8R8A8_UNORM, 4).in_buffer(1),
            Attribute::new("turn", 2, 0).with_locations(2).in_buffer(2),
            Attribute::of_format("shift", VertexFormat::R16G16_SFLOAT, 16).in_buffer(2),
            Attribute::of_format("number", VertexFormat::R8_UINT, 20).in_buffer(2),
            Attribute::of_format("signs", VertexFormat::R8G8_SINT, 21).in_buffer(2),
            Attribute::of_format("bits", VertexFormat::A2B10G10R10_UNORM_PACK32, 24).in_buffer(2),
        ],
        ..DrawInterface::default()
    }
}

/// Places and values, 32-bit floats of one buffer.
pub(crate) fn plain() -> DrawInterface {
    DrawInterface {
        vertex_buffers: vec![VertexBuffer::of_vertices(12)],
        attributes: vec![Attribute::new("place", 2, 0), Attribute::new("given", 1, 8)],
        ..DrawInterface::default()
    }
}

/// A quarter of the picture of one value: its corner, and the numbers that make it.
pub(crate) const QUARTERS: [([f32; 2], u8, i8, u32); 4] =
    [([-0.5, -0.5], 1, 2, 1), ([0.5, -0.5], 2, 4, 51), ([-0.5, 0.5], 3, 6, 102), ([0.5, 0.5], 4, 8, 7)];

pub(crate) fn value((_, number, sign, bits): ([f32; 2], u8, i8, u32)) -> u32 {
    77 + 1000 * u32::from(number) + 10_000 * u32::from(sign.unsigned_abs()) + 100_000 * bits
}

/// Half floats of ±0.5.
const fn half(number: f32) -> u16 {
    if number < 0.0 { 0xb800 } else { 0x3800 }
}

/// What a source draws.
#[derive(Clone, Copy, Default)]
struct Way {
    /// With indices.
    indexed: bool,
    /// In two draws, of two instances each.
    halves: bool,
    /// Leaves a buffer out.
    without: Option<u32>,
    /// The instances in one draw; 0: four.
    instances: u32,
}

struct Many {
    buffers: [Buffer; 3],
    indices: Buffer,
    way: Way,
}

impl Many {
    /// `before`: bytes in front of the instances.
    fn new(device: &Device, way: Way) -> Many {
        let vertex = |bytes: &[u8]| device.buffer(BufferUsage::Vertex, bytes).expect("a buffer");
        let places = CORNERS.as_flattened().iter().flat_map(|it| (it * i16::MAX).to_ne_bytes()).collect::<Vec<_>>();
        // Blue comes first.
        let tints = [0, 0, 0, 0, 77, 1, 2, 3].repeat(6);
        let instances = QUARTERS.iter().flat_map(|(shift, number, sign, bits)| {
            let turn = [0.0, 0.5, -0.5, 0.0_f32].map(f32::to_ne_bytes).concat();
            let shift = shift.map(|it| half(it).to_ne_bytes()).concat();
            let whole = [*number, 3, sign.wrapping_neg().cast_unsigned(), 0];
            [turn, shift, whole.to_vec(), bits.to_ne_bytes().to_vec()].concat()
        });
        let instances: Vec<u8> = [0; 8].into_iter().chain(instances).collect();
        let indices = [0_u16, 1, 2, 3, 4, 5].map(u16::to_ne_bytes).concat();
        let indices = device.buffer(BufferUsage::Index, &indices).expect("a buffer");
        Many { buffers: [vertex(&places), vertex(&tints), vertex(&instances)], indices, way }
    }
}

impl DrawSource for Many {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let Way { indexed, halves, without, instances } = self.way;
        for (number, buffer) in (0..).zip(&self.buffers).filter(|(number, _)| Some(*number) != without) {
            recorder.bind_vertex_buffer_at(number, buffer, if number == 2 { 8 } else { 0 });
        }
        recorder.bind_index_buffer(&self.indices, IndexType::U16);
        let all = if instances > 0 { instances } else { 4 };
        let parts = if halves { [0..2, 2..4] } else { [0..all, all..all] };
        for part in parts {
            match indexed {
                true => recorder.draw_indexed(0..6, 0, part),
                false => recorder.draw(0..6, part),
            }
        }
        Ok(1)
    }
}

/// Draws one buffer of floats, with or without indices.
pub(crate) struct Plain {
    pub(crate) vertices: Buffer,
    count: u32,
    indices: Option<(Buffer, u32)>,
}

impl Plain {
    fn new(device: &Device, vertices: &[[f32; 3]], indices: &[u32]) -> Plain {
        let words = vertices.as_flattened().iter().map(|it| it.to_bits()).collect::<Vec<_>>();
        let buffer = |usage, words: &[u32]| device.buffer(usage, &to_bytes(words)).expect("a buffer");
        let count = |count: usize| u32::try_from(count).expect("few");
        let indexed = !indices.is_empty();
        Plain {
            vertices: buffer(BufferUsage::Vertex, &words),
            count: count(vertices.len()),
            indices: indexed.then(|| (buffer(BufferUsage::Index, indices), count(indices.len()))),
        }
    }

    /// The quarters.
    pub(crate) fn quarters(device: &Device) -> Plain {
        let corner = |it: &([f32; 2], u8, i8, u32), [x, y]: [i16; 2]| {
            #[allow(clippy::cast_precision_loss, reason = "small whole numbers")]
            let value = value(*it) as f32;
            [f32::from(x) * 0.5 + it.0[0], f32::from(y) * 0.5 + it.0[1], value]
        };
        let all = QUARTERS.iter().flat_map(|it| CORNERS.map(|place| corner(it, place)));
        Plain::new(device, &all.collect::<Vec<_>>(), &[])
    }
}

impl DrawSource for Plain {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        recorder.bind_vertex_buffer(&self.vertices);
        match &self.indices {
            Some((indices, count)) => {
                recorder.bind_index_buffer(indices, IndexType::U32);
                recorder.draw_indexed(0..*count, 0, 0..1);
            }
            None => recorder.draw(0..self.count, 0..1),
        }
        Ok(1)
    }
}

/// A frame of one pass.
pub(crate) fn plan(device: &Device, pass: impl Fn(Pass) -> Pass, (shader, drawn): (&str, Draw)) -> Plan {
    let mut small = Small::default();
    let shown = small.image("shown", Format::R32_UINT, EXTENT);
    small.pass(pass(draw(shader, drawn).draws(shown, Subresources::WHOLE, Some([0.0; 4]))));
    small.image_output(shown);
    planned(device, &small.frame, &Options::default())
}

pub(crate) fn executor(device: &Device, plan: &Plan, draws: impl Into<DrawInterfaces>) -> Result<Executor, Error> {
    let options = ExecutorOptions { readback: true, ..ExecutorOptions::default() };
    Executor::new(device, plan, &mut ShaderLibrary::new(Vec::new(), SHADERS, draws), &options)
}

/// What a source draws with this interface.
pub(crate) fn drawn(
    device: &Device,
    shader: &str,
    draws: DrawInterface,
    source: &mut dyn DrawSource,
) -> Result<Vec<u32>, Error> {
    let plan = plan(device, |pass| pass, (shader, OBJECTS));
    let mut executor = executor(device, &plan, move |_| draws.clone())?;
    executor.frame(source)?;
    Ok(texels(&mut executor, "shown", 0))
}

#[test]
fn vertices_of_several_buffers_and_formats_draw_what_floats_of_one_buffer_draw() {
    on_each_driver(|device| {
        let wanted = drawn(device, "plain", plain(), &mut Plain::quarters(device)).expect("a picture");
        assert_eq!([wanted[0], wanted[7], wanted[56], wanted[63]], QUARTERS.map(value));
        for (indexed, halves) in [(false, false), (true, false), (false, true), (true, true)] {
            let way = Way { indexed, halves, ..Way::default() };
            let found = drawn(device, "many", many(1), &mut Many::new(device, way)).expect("a picture");
            assert_eq!(found, wanted, "indexed: {indexed}, halves: {halves}");
        }
    });
}

#[test]
fn an_element_serves_as_many_instances_as_the_interface_says() {
    on_each_driver(|device| {
        let found = drawn(device, "many", many(2), &mut Many::new(device, Way::default()));
        if !device.profile().has_feature("vertexAttributeInstanceRateDivisor") {
            let said = found.expect_err("a refusal").to_string();
            assert!(said.contains("needs the feature vertexAttributeInstanceRateDivisor"), "{said}");
            return;
        }
        let found = found.expect("a picture");
        let [first, second, ..] = QUARTERS.map(value);
        // Two instances of each of the first two elements: the other quarters are left alone.
        assert_eq!([found[0], found[7], found[56], found[63]], [first, second, 0, 0]);
        let way = Way { halves: true, ..Way::default() };
        let said = drawn(device, "many", many(2), &mut Many::new(device, way)).expect_err("a refusal").to_string();
        assert!(said.contains("instances 2 to 3 of which several share an element of vertex buffer 2"), "{said}");
    });
}

#[test]
fn what_a_draw_reads_of_vertex_buffers_must_be_bound_and_long_enough() {
    on_each_driver(|device| {
        let refused =
            |way, draws| drawn(device, "many", draws, &mut Many::new(device, way)).expect_err("a refusal").to_string();
        let without = |number| refused(Way { without: Some(number), ..Way::default() }, many(1));
        let said = |what: &str| format!("pass `many`, while recording: {what}");
        assert_eq!(without(0), said("a draw without vertex buffer"));
        assert_eq!(without(1), said("a draw without vertex buffer 1"));
        assert_eq!(without(2), said("a draw without vertex buffer 2"));
        let five = refused(Way { instances: 5, ..Way::default() }, many(1));
        assert_eq!(five, said("instances 0 to 4 lie beyond vertex buffer 2"));
        let indexed = refused(Way { instances: 5, indexed: true, ..Way::default() }, many(1));
        assert_eq!(indexed, five);
        let mut fewer = many(1);
        fewer.vertex_buffers[1].stride = 12;
        assert_eq!(refused(Way::default(), fewer), said("vertices 0 to 5 lie beyond vertex buffer 1"));
        let plan = plan(device, |pass| pass, ("plain", OBJECTS));
        let mut executor = executor(device, &plan, |_| plain()).expect("an executor");
        let stray = executor.frame(&mut Many::new(device, Way::default())).expect_err("a refusal").to_string();
        assert_eq!(stray, "pass `plain`, while recording: the draw interface has no vertex buffer 1");
    });
}

#[test]
fn a_shader_reads_what_is_brought_along_as_what_it_is() {
    on_each_driver(|device| {
        let refused = |change: fn(&mut DrawInterface)| {
            let mut draws = many(1);
            change(&mut draws);
            drawn(device, "many", draws, &mut Many::new(device, Way::default())).expect_err("a refusal").to_string()
        };
        let whole = refused(|it| it.attributes[0].format = VertexFormat::R16G16_SINT);
        assert!(whole.contains("`place` is signed integers, in the format R16G16_SINT"), "{whole}");
        let unsigned = refused(|it| it.attributes[4].format = VertexFormat::R8_UNORM);
        assert!(unsigned.contains("`number` is floating point, in the format R8_UNORM"), "{unsigned}");
        let column = refused(|it| it.attributes[2].locations = 1);
        assert!(column.contains("declares the vertex attribute `turn` as mat2: `turn` is a vector"), "{column}");
        let nowhere = refused(|it| it.attributes[0].buffer = 3);
        assert!(nowhere.contains("`place` is in vertex buffer 3, and there are 3"), "{nowhere}");
        let askew = refused(|it| it.attributes[3].offset = 17);
        assert!(askew.contains("places of R16G16_SFLOAT are multiples of 2 bytes"), "{askew}");
        let wide = refused(|it| it.vertex_buffers[1].stride = u32::MAX);
        assert!(wide.contains("maxVertexInputBindingStride"), "{wide}");
        let unread = |it: &VertexFormat| !device.profile().reads_vertices(*it);
        let named = VertexFormat::NAMED.iter().map(|(_, format)| *format);
        if let Some(format) = named.filter(|it| it.components() == 3 && it.bytes() <= 4).find(unread) {
            let mut draws = many(1);
            draws.attributes[1].format = format;
            let said = drawn(device, "many", draws, &mut Many::new(device, Way::default()));
            if format.component() == framewright_graph::vulkan::Component::Float {
                let said = said.expect_err("a refusal").to_string();
                assert!(
                    said.contains(&format!("has the format {format}, of which this device reads no vertices")),
                    "{said}"
                );
            }
        }
    });
}

#[test]
fn custom_passes_have_interfaces_by_their_names() {
    on_each_driver(|device| {
        let wanted = drawn(device, "plain", plain(), &mut Plain::quarters(device)).expect("a picture");
        let draws = DrawInterfaces::default()
            .with(DrawKind::Custom, DrawInterface::default())
            .with_custom("many", many(1))
            .with_custom("plain", plain());
        for name in ["many", "plain"] {
            let plan = plan(device, |pass| pass, (name, Draw::Custom));
            let mut executor = executor(device, &plan, draws.clone()).expect("an executor");
            match name {
                "many" => executor.frame(&mut Many::new(device, Way::default())),
                _ => executor.frame(&mut Plain::quarters(device)),
            }
            .expect("a frame");
            assert_eq!(texels(&mut executor, "shown", 0), wanted, "{name}");
        }
        let one = DrawInterfaces::default().with(DrawKind::Custom, plain());
        let plan = plan(device, |pass| pass, ("many", Draw::Custom));
        let said = executor(device, &plan, one).map(drop).expect_err("a refusal").to_string();
        assert!(said.contains("vertices of this kind of draw have no `tint`"), "{said}");
    });
}

#[test]
fn a_draw_source_draws_strips_fans_lines_and_points() {
    on_each_driver(|device| {
        let of = |topology, restart, source: &mut Plain| {
            let raster = RasterState { topology, primitive_restart: restart, ..RasterState::default() };
            let plan = plan(device, |pass| Pass { raster, ..pass }, ("plain", OBJECTS));
            let mut executor = executor(device, &plan, |_| plain()).expect("an executor");
            executor.frame(source).expect("a frame");
            texels(&mut executor, "shown", 0)
        };
        let wanted = of(PrimitiveTopology::TriangleList, false, &mut Plain::quarters(device));
        let corners = |it: &([f32; 2], u8, i8, u32), round: [[f32; 2]; 4]| {
            #[allow(clippy::cast_precision_loss, reason = "small whole numbers")]
            let value = value(*it) as f32;
            round.map(|[x, y]| [x * 0.5 + it.0[0], y * 0.5 + it.0[1], value])
        };
        const STRIP: [[f32; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
        const FAN: [[f32; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let anew: Vec<u32> = (0..4).flat_map(|at| [4 * at, 4 * at + 1, 4 * at + 2, 4 * at + 3, u32::MAX]).collect();
        for (topology, round) in [(PrimitiveTopology::TriangleStrip, STRIP), (PrimitiveTopology::TriangleFan, FAN)] {
            let all: Vec<_> = QUARTERS.iter().flat_map(|it| corners(it, round)).collect();
            assert_eq!(of(topology, true, &mut Plain::new(device, &all, &anew)), wanted, "{topology:?}");
        }
        // A point in the middle of each texel, of the value of its quarter.
        let middle = |at: u32| f32::from(u16::try_from(at).expect("small")) / 4.0 - 1.0 + 0.125;
        let quarter = |x: u32, y: u32| QUARTERS[(x / 4 + y / 4 * 2) as usize];
        #[allow(clippy::cast_precision_loss, reason = "small whole numbers")]
        let points = (0..64).map(|at| [middle(at % 8), middle(at / 8), value(quarter(at % 8, at / 8)) as f32]);
        let points: Vec<_> = points.collect();
        assert_eq!(of(PrimitiveTopology::PointList, false, &mut Plain::new(device, &points, &[])), wanted);
        // A line through each row, from the left edge to the right one, in each quarter's colour.
        let row = |y: u32, half: u16| {
            let [left, right] = [f32::from(half) - 1.0, f32::from(half)];
            #[allow(clippy::cast_precision_loss, reason = "small whole numbers")]
            let value = value(quarter(4 * u32::from(half), y)) as f32;
            [[left, middle(y), value], [right, middle(y), value]]
        };
        let rows: Vec<_> = (0..8).flat_map(|y| [row(y, 0), row(y, 1)].concat()).collect();
        assert_eq!(of(PrimitiveTopology::LineList, false, &mut Plain::new(device, &rows, &[])), wanted);
        let strips: Vec<u32> = (0..16).flat_map(|at| [2 * at, 2 * at + 1, u32::MAX]).collect();
        assert_eq!(of(PrimitiveTopology::LineStrip, true, &mut Plain::new(device, &rows, &strips)), wanted);
    });
}

const PUSHED: &[(&str, &str)] = &[
    (
        "pushed.vert",
        "#version 460
        layout(push_constant) uniform Place { layout(offset = 16) vec2 shift; } place;
        void main() {
            vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
            gl_Position = vec4(corner - 1.0 + place.shift, 0.0, 1.0);
        }",
    ),
    (
        "pushed.frag",
        "#version 460
        layout(push_constant) uniform Number { uint number; } given;
        layout(location = 0) out uint color;
        void main() { color = given.number; }",
    ),
];

/// A number for the fragment stage, and a place for the vertex stage.
fn pushing() -> DrawInterface {
    DrawInterface {
        push_constants: vec![
            PushConstants::new(0, 4).for_stages(Stages::FRAGMENT_SHADER),
            PushConstants::new(16, 8).for_stages(Stages::VERTEX_SHADER),
        ],
        ..DrawInterface::default()
    }
}

/// Draws a square of a number in each quarter, but for what is left out.
struct Pushes {
    number: bool,
    shift: &'static [f32],
}

impl DrawSource for Pushes {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        for quarter in QUARTERS {
            if self.number {
                recorder.push_constants(0, &value(quarter).to_ne_bytes());
            }
            let at = quarter.0.map(|it| it + 0.5);
            let bytes = at.iter().chain(self.shift).flat_map(|it| it.to_ne_bytes()).collect::<Vec<_>>();
            recorder.push_constants(16, &bytes);
            recorder.draw(0..4, 0..1);
        }
        Ok(4)
    }
}

#[test]
fn push_constants_tell_draws_what_attributes_tell_them() {
    on_each_driver(|device| {
        let wanted = drawn(device, "plain", plain(), &mut Plain::quarters(device)).expect("a picture");
        let raster = RasterState { topology: PrimitiveTopology::TriangleStrip, ..RasterState::default() };
        let plan = plan(device, |pass| Pass { raster, ..pass }, ("pushed", OBJECTS));
        let executor = |draws: DrawInterface| {
            let options = ExecutorOptions { readback: true, ..ExecutorOptions::default() };
            let mut shaders = ShaderLibrary::new(Vec::new(), PUSHED, move |_| draws.clone());
            Executor::new(device, &plan, &mut shaders, &options)
        };
        let mut drawn = executor(pushing()).expect("an executor");
        drawn.frame(&mut Pushes { number: true, shift: &[] }).expect("a frame");
        assert_eq!(texels(&mut drawn, "shown", 0), wanted);
        let mut refused = |source: &mut Pushes| drawn.frame(source).expect_err("a refusal").to_string();
        let said = |what: &str| format!("pass `pushed`, while recording: {what}");
        let unset = refused(&mut Pushes { number: false, shift: &[] });
        assert_eq!(unset, said("a draw without all push constants of `given`"), "not those of the frame before");
        let beyond = refused(&mut Pushes { number: true, shift: &[0.0] });
        assert_eq!(beyond, said("12 bytes of push constants from byte 16 on: there are 24, set by four"));
        let mut short = pushing();
        short.push_constants[1].bytes = 4;
        let said = executor(short).map(drop).expect_err("a refusal").to_string();
        assert!(said.contains("push constants `place`") && said.contains("bytes 16 to 19"), "{said}");
        let mut other = pushing();
        other.push_constants.remove(0);
        let said = executor(other).map(drop).expect_err("a refusal").to_string();
        assert!(said.contains("push constants `given`") && said.contains("is brought none"), "{said}");
        let none = executor(DrawInterface::default()).map(drop).expect_err("a refusal").to_string();
        assert!(none.contains("parameters come in the uniform block `params`"), "{none}");
        let mut far = pushing();
        far.push_constants.push(PushConstants::new(1 << 20, 4));
        let said = executor(far).map(drop).expect_err("a refusal").to_string();
        assert!(said.contains("1048580 bytes of push constants") && said.contains("maxPushConstantsSize"), "{said}");
    });
}
