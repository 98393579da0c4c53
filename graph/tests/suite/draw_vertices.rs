//! What a draw source tells of its vertices (DO-5): the file says it, mistakes stand at their places, and shaders read what is there.

use crate::testing::pipelines::{INPUTS, right};
use crate::testing::plans::compiled;
use crate::testing::table::Table;
use framewright_graph::base::{self, Sources};
use framewright_graph::device::{Abilities, Limits};
use framewright_graph::frame::Draw;
use framewright_graph::shader::{
    Attribute, BroughtLocation, DrawInterface, DrawInterfaces, DrawKind, PushConstants, PushedBlock, ShaderInterface,
    ShaderInterfaces, ShaderProblem, Variant, VertexBuffer, VertexInput, VertexRate, push_needs, vertex_needs,
};
use framewright_graph::vulkan::{PrimitiveTopology, Stages, VertexFormat};

fn read(text: &str) -> Result<DrawInterfaces, String> {
    let mut sources = Sources::default();
    let read = DrawInterfaces::read(&mut sources, "engine.ron", "engine.ron", text.to_owned());
    read.map_err(|mistakes| base::render(&sources, &mistakes))
}

const GRASS: &str = r#"Interface(
    version: 1,
    draws: [
        (
            of: [Sky, Custom("grass")],
            vertex_buffers: [
                (stride: 12),
                (stride: 72, rate: Instance),
                (stride: 4, rate: Instance(3)),
            ],
            attributes: [
                (name: "place", components: 2, offset: 0),
                (name: "tint", format: R8G8B8A8_UNORM, location: 4, offset: 8),
                (name: "model", components: 4, locations: 4, buffer: 1, offset: 0),
                (name: "number", format: R32G32_UINT, buffer: 1, offset: 64),
                (name: "wind", format: A2B10G10R10_SNORM_PACK32, buffer: 2, offset: 0),
            ],
            topology: TriangleStrip,
            primitive_restart: true,
            push_constants: [
                (offset: 0, bytes: 64, stages: [Vertex]),
                (offset: 64, bytes: 16),
            ],
            supplied: [
            ],
        ),
    ],
    custom: ["grass"],
)
"#;

fn grass() -> DrawInterface {
    DrawInterface {
        vertex_buffers: vec![
            VertexBuffer::of_vertices(12),
            VertexBuffer::of_instances(72),
            VertexBuffer { stride: 4, rate: VertexRate::Instance { divisor: 3 } },
        ],
        attributes: vec![
            Attribute::new("place", 2, 0),
            Attribute::of_format("tint", VertexFormat::R8G8B8A8_UNORM, 8).at_location(4),
            Attribute::new("model", 4, 0).with_locations(4).in_buffer(1),
            Attribute::of_format("number", VertexFormat::R32G32_UINT, 64).in_buffer(1),
            Attribute::of_format("wind", VertexFormat::A2B10G10R10_SNORM_PACK32, 0).in_buffer(2),
        ],
        topology: Some(PrimitiveTopology::TriangleStrip),
        primitive_restart: true,
        push_constants: vec![PushConstants::new(0, 64).for_stages(Stages::VERTEX_SHADER), PushConstants::new(64, 16)],
        supplied: Vec::new(),
    }
}

#[test]
fn several_buffers_of_any_format_are_written_and_read_again() {
    let interfaces = DrawInterfaces::default()
        .with(DrawKind::Sky, grass())
        .with_custom("grass", grass())
        .with_custom_passes(["grass"]);
    assert_eq!(interfaces.to_ron(), GRASS);
    assert_eq!(read(GRASS), Ok(interfaces.clone()));
    assert_eq!(interfaces.of_pass(Some(Draw::Custom), "grass"), grass());
    assert_eq!(interfaces.of_pass(Some(Draw::Custom), "hair"), DrawInterface::default());
    let hair = DrawInterface { topology: Some(PrimitiveTopology::LineList), ..DrawInterface::default() };
    let both = interfaces.with(DrawKind::Custom, hair.clone());
    assert_eq!(both.of_pass(Some(Draw::Custom), "hair"), hair, "those without one of their own have that of all");
    assert_eq!(both.of_pass(Some(Draw::Custom), "grass"), grass());
}

#[test]
fn each_mistake_in_vertices_is_told_at_its_place() {
    let wrong = |right: &str, mistake: &str, place: &str, said: &[&str]| {
        assert!(GRASS.contains(right), "the file doesn't hold {right}");
        let rendered = read(&GRASS.replacen(right, mistake, 1)).expect_err(mistake);
        for words in [&format!(" engine.ron:{place}\n")[..]].iter().chain(said) {
            assert!(rendered.contains(words), "`{words}` is not in\n{rendered}");
        }
        assert_eq!(rendered.matches("error").count(), 1, "{rendered}");
    };
    wrong("(stride: 12)", "(stride: 0)", "7:17", &["the vertices of buffer 0 have no bytes"]);
    wrong("stride: 12", "stride: 14", "12:17", &["doesn't fit vertices of 14 bytes: places of R32G32_SFLOAT are mult"]);
    wrong("stride: 12", "stride: 8", "13:17", &["`tint` doesn't fit vertices of 8 bytes"]);
    wrong("rate: Instance)", "rate: Instances)", "8:36", &["`Instances` is not a rate", "did you mean `Instance`?"]);
    wrong("Instance(3)", "Instance(0)", "9:17", &["one element for 0 instances"]);
    wrong("Instance(3)", "Instance(65536)", "9:17", &["more instances than every device allows, 65535"]);
    wrong("R8G8B8A8_UNORM", "R8G8B8A8_UNORN", "13:40", &["not a format of vertices", "did you mean `R8G8B8A8_UNORM`?"]);
    wrong("R8G8B8A8_UNORM", "R8G8B8A8_SRGB", "13:40", &["`R8G8B8A8_SRGB` is not a format of vertices"]);
    wrong("format: R8G8B8A8_UNORM, ", "", "13:17", &["an attribute lacks its format"]);
    wrong("components: 2,", "components: 2, format: R8_UINT,", "12:45", &["`components` is short for"]);
    wrong("locations: 4", "locations: 0", "14:17", &["`model` takes no location"]);
    wrong("locations: 4", "locations: 5", "14:17", &["`model` doesn't fit vertices of 72 bytes"]);
    wrong("buffer: 2,", "buffer: 3,", "16:17", &["`wind` is in vertex buffer 3, and there are 3"]);
    wrong("offset: 64", "offset: 66", "15:17", &["places of R32G32_UINT are multiples of 4 bytes"]);
    wrong("TriangleStrip", "TriangleList", "19:32", &["take a `topology` of strips or fans"]);
    wrong("TriangleStrip", "Triangles", "18:23", &["`Triangles` is not a topology"]);
    wrong("primitive_restart: true", "primitive_restart: 1", "19:32", &["`true` or `false`"]);
    wrong("vertex_buffers: [", "vertex_stride: 8, vertex_buffers: [", "6:28", &["short for one vertex buffer"]);
    wrong("bytes: 64", "bytes: 62", "21:17", &["62 bytes of push constants from byte 0 on: both are multiples of 4"]);
    wrong("bytes: 64", "bytes: 0", "21:17", &["0 bytes of push constants"]);
    wrong("[Vertex]", "[Compute]", "21:17", &["push constants are for the stages `Vertex` and `Fragment`"]);
    wrong("[Vertex]", "[]", "21:17", &["push constants are for the stages"]);
    wrong("[Vertex]", "[Pixel]", "21:49", &["`Pixel` is not a stage"]);
    wrong("offset: 64, bytes", "offset: -4, bytes", "22:26", &["the offset can't be -4"]);
    wrong("[Sky, ", "[Custom(\"grass\"), ", "5:35", &["stands here twice"]);
    wrong("custom: [\"grass\"]", "custom: [\"hair\"]", "5:23", &["no custom pass is called `grass`"]);
    wrong("[Sky, Custom(\"grass\")]", "[Compute]", "11:25", &["compute passes have no vertices"]);
}

fn input(location: u32, component: u32, name: &str, ty: &str) -> VertexInput {
    VertexInput { location, component, name: name.to_owned(), ty: ty.to_owned(), used: true }
}

#[test]
fn a_shader_reads_each_location_where_it_lies() {
    let at = |location, buffer, offset, format| BroughtLocation { location, buffer, offset, format };
    let read = |input: &VertexInput| grass().locations(input).map(Iterator::collect::<Vec<_>>);
    let model = (0..4).map(|column| at(3 + column, 1, 16 * column, VertexFormat::R32G32B32A32_SFLOAT));
    assert_eq!(read(&input(3, 0, "model", "mat4")), Ok(model.clone().collect()));
    assert_eq!(read(&input(3, 0, "model", "vec3[2]")), Ok(model.take(2).collect()), "an array, without the end");
    let tint = at(4, 0, 8, VertexFormat::R8G8B8A8_UNORM);
    assert_eq!(read(&input(4, 0, "location 4", "vec3")), Ok(vec![tint]), "by its place, without names");
    assert!(read(&input(5, 0, "location 5", "vec3")).is_err());
    assert!(read(&input(0, 1, "place", "float")).is_err(), "from the second component on");
    assert!(read(&input(0, 0, "number", "ivec2")).is_err(), "signed, of unsigned integers");
    assert!(read(&input(0, 0, "place", "mat2")).is_err(), "two locations of one");
    assert!(read(&input(0, 0, "place", "dvec2")).is_err());
    assert!(read(&input(0, 0, "place", "vec4")).is_ok(), "what is lacking is 0 and 1");
}

#[test]
fn do_5_compilers_of_hlsl_keep_other_names_than_those_of_the_interface() {
    let mut brought = grass();
    brought.attributes[0].location = Some(6);
    let called = |location, name: &str, ty| {
        let input = input(location, 0, name, ty);
        brought.attribute(&input).map(|it| it.name.to_string())
    };
    for name in
        ["place", "vertex.place", "scene.vertex.place", "in.var.PLACE", "in.var.Place", "anything", "location 6"]
    {
        assert_eq!(called(6, name, "vec2").as_deref(), Some("place"), "{name}");
    }
    for name in ["tint", "vertex.tint", "in.var.TINT"] {
        assert_eq!(called(6, name, "vec4").as_deref(), Some("tint"), "{name}: a name comes before a location");
    }
    for name in ["PLACE", "vertex.PLACE", "place.vertex", "in.var.PLACE0", "vertex.in.var.PLACE", "location 5"] {
        assert_eq!(called(5, name, "vec2"), None, "{name}");
    }
}

/// Why a device of the least limits, which reads these formats, doesn't draw what such a shader reads.
fn unmet(inputs: &[VertexInput], brought: &DrawInterface, formats: &[VertexFormat]) -> Vec<String> {
    let abilities = Abilities {
        device: "this device",
        limits: Some(&Limits::LEAST),
        has: &|_| false,
        reads_vertices: &|format| formats.contains(&format),
    };
    vertex_needs(inputs, brought).iter().filter_map(|need| need.unmet(&abilities)).collect()
}

#[test]
fn devices_bound_the_vertices_that_a_shader_reads_and_no_others() {
    assert_eq!(unmet(&[input(0, 0, "place", "vec2"), input(1, 0, "model", "mat4")], &grass(), &[]), [""; 0]);
    let wind = [input(2, 0, "wind", "vec4")];
    let said = [
        "the vertex attribute `wind` has the format A2B10G10R10_SNORM_PACK32, of which this device reads no vertices",
        "a vertex attribute that several instances share needs the feature vertexAttributeInstanceRateDivisor, which this device \
         doesn't have",
    ];
    assert_eq!(unmet(&wind, &grass(), &[]), said);
    assert_eq!(unmet(&wind, &grass(), &[VertexFormat::A2B10G10R10_SNORM_PACK32]), said[1..]);
    let high = [input(13, 0, "model", "mat4")];
    assert_eq!(
        unmet(&high, &grass(), &[]),
        ["the locations of its vertex attributes go up to 16; this device allows 16 (maxVertexInputAttributes)"]
    );
    let mut far = grass();
    far.vertex_buffers = vec![VertexBuffer::of_vertices(4000); 18];
    far.attributes = vec![Attribute::new("place", 2, 2048).in_buffer(17)];
    assert_eq!(
        unmet(&[input(0, 0, "place", "vec2")], &far, &[]),
        [
            "its vertex buffers go up to 17; this device allows 16 (maxVertexInputBindings)",
            "the offset of a vertex attribute is 2048; this device allows 2047 (maxVertexInputAttributeOffset)",
            "the bytes from vertex to vertex are 4000; this device allows 2048 (maxVertexInputBindingStride)",
        ]
    );
}

#[test]
fn blocks_of_push_constants_lie_within_what_their_stage_is_brought() {
    let block = |stages, offset, end| PushedBlock { name: "block".to_owned(), stages, offset, end };
    let misfit = |stages, offset, end| grass().pushed_misfit(&block(stages, offset, end));
    let (vertex, fragment) = (Stages::VERTEX_SHADER, Stages::FRAGMENT_SHADER);
    assert_eq!(misfit(vertex, 0, 64), None);
    assert_eq!(misfit(vertex, 64, 80), None);
    assert_eq!(misfit(fragment, 68, 72), None);
    let said = misfit(fragment, 0, 64).expect("a misfit");
    assert_eq!(said, "push constants `block`, bytes 0 to 63, and the stage is brought bytes 64 to 79");
    assert!(misfit(vertex, 60, 68).expect("a misfit").ends_with("is brought bytes 0 to 63 and 64 to 79"));
    let none = DrawInterface::default().pushed_misfit(&block(vertex, 0, 4)).expect("a misfit");
    assert!(none.ends_with("is brought none"), "{none}");
    assert_eq!(push_needs(&grass()), None, "every device has 128");
    let far = DrawInterface { push_constants: vec![PushConstants::new(128, 4)], ..DrawInterface::default() };
    assert!(push_needs(&far).is_some());
}

/// The table of shaders, with a draw source that brings a direction for four instances at once along.
struct Shared(Table);

impl ShaderInterfaces for Shared {
    fn draw_shader(&mut self, name: &str, draw: Draw, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        self.0.draw_shader(name, draw, variant)
    }

    fn compute_shader(&mut self, name: &str, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        self.0.compute_shader(name, variant)
    }

    fn brought_along(&self, draw: Option<Draw>, name: &str) -> DrawInterface {
        let mut brought = self.0.brought_along(draw, name);
        for buffer in &mut brought.vertex_buffers {
            buffer.rate = VertexRate::Instance { divisor: 4 };
        }
        brought
    }
}

#[test]
fn do_5_a_plan_tells_the_feature_for_attributes_that_several_instances_share() {
    let text = r#"Pipeline(version: 1, images: [(name: "screen", format: R8G8B8A8_UNORM, size: Output)],
        passes: [(name: "draw", draw: Objects(Opaque), shader: "lit", color: [(image: "screen", clear: (0, 0, 0, 1))])],
        outputs: ["screen"])"#;
    let plan = compiled(&right(text, &INPUTS));
    let has = |shaders: &mut dyn ShaderInterfaces| {
        let used = plan.features(shaders).expect("its shaders are right");
        used.into_iter().find(|it| it.name == "vertexAttributeInstanceRateDivisor").map(|it| it.by)
    };
    assert_eq!(has(&mut Table), None);
    let by = has(&mut Shared(Table)).expect("the draw source shares them");
    assert_eq!(by, "pass `draw`: a vertex attribute that several instances share");
}
