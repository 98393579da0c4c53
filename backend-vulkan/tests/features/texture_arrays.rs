//! Arrays of textures that a draw source brings along (EM-5).

use crate::frames::{Small, Uses, dispatch, draw, indexing, lacks, on_each_driver, placeless, planned, texels};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, DrawList, Frame, Groups};
use framewright_graph::shader::{
    Attribute, DrawInterface, DrawInterfaces, DrawKind, SuppliedKind, SuppliedResource, VertexBuffer,
};
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::{
    BindGroup, BufferUsage, Device, DispatchRecorder, DrawSource, Error, Executor, ExecutorOptions, Recorder, Resource,
    SamplerDescriptor, ShaderLibrary, Texture,
};

const OBJECTS: Draw = Draw::Objects(DrawList::Opaque);

/// How many textures are brought along.
const COUNT: u32 = 8;

const SHADERS: &[(&str, &str)] = &[
    (
        "objects.vert",
        "#version 460
        layout(location = 0) in vec2 place;
        layout(location = 0) flat out uint instance;
        void main() { gl_Position = vec4(place, 0.0, 1.0); instance = gl_InstanceIndex; }",
    ),
    // Every device has numbers that are constants.
    (
        "by_constants.frag",
        "#version 460
        layout(location = 0) flat in uint instance;
        layout(set = 2, binding = 3) uniform sampler2D textures[8];
        layout(location = 0) out uint color;
        float red[8];
        void look(int number, float found) { red[number] = found; }
        void main() {
            vec2 uv = vec2(0.5);
            look(0, texture(textures[0], uv).r);
            look(1, texture(textures[1], uv).r);
            look(2, texture(textures[2], uv).r);
            look(3, texture(textures[3], uv).r);
            look(4, texture(textures[4], uv).r);
            look(5, texture(textures[5], uv).r);
            look(6, texture(textures[6], uv).r);
            look(7, texture(textures[7], uv).r);
            color = uint(round(red[7 - int(gl_FragCoord.x)] * 255.0));
        }",
    ),
    // The number is the same for all pixels of a draw.
    (
        "by_turns.frag",
        "#version 460
        layout(location = 0) flat in uint instance;
        layout(set = 2, binding = 3) uniform sampler2D textures[8];
        layout(location = 0) out uint color;
        void main() {
            for (int number = 0; number < 8; number++) {
                float red = texture(textures[number], vec2(0.5)).r;
                if (number == 7 - int(gl_FragCoord.x)) { color = uint(round(red * 255.0)); }
            }
        }",
    ),
    // The number is another one in each pixel.
    (
        "by_pixel.frag",
        "#version 460
        #extension GL_EXT_nonuniform_qualifier : require
        layout(location = 0) flat in uint instance;
        layout(set = 2, binding = 3) uniform sampler2D textures[8];
        layout(location = 0) out uint color;
        void main() {
            int number = 7 - int(gl_FragCoord.x);
            color = uint(round(textureLod(textures[nonuniformEXT(number)], vec2(0.5), 0.0).r * 255.0));
        }",
    ),
    (
        "shorter.frag",
        "#version 460
        layout(location = 0) flat in uint instance;
        layout(set = 2, binding = 3) uniform sampler2D textures[3];
        layout(location = 0) out uint color;
        void main() { color = uint(round(texture(textures[2], vec2(0.5)).r * 255.0)); }",
    ),
    (
        "longer.frag",
        "#version 460
        layout(location = 0) flat in uint instance;
        layout(set = 2, binding = 3) uniform sampler2D textures[9];
        layout(location = 0) out uint color;
        void main() { color = uint(round(texture(textures[2], vec2(0.5)).r * 255.0)); }",
    ),
    (
        "computed.comp",
        "#version 460
        layout(local_size_x = 8) in;
        layout(set = 0, binding = 0, r32ui) uniform writeonly uimage2D target;
        layout(set = 2, binding = 3) uniform sampler2D textures[8];
        void main() {
            uint at = gl_LocalInvocationID.x;
            float red = at == 0 ? textureLod(textures[7], vec2(0.5), 0.0).r : textureLod(textures[3], vec2(0.5), 0.0).r;
            imageStore(target, ivec2(at, 0), uvec4(round(red * 255.0)));
        }",
    ),
];

fn textures(count: u32) -> SuppliedResource {
    SuppliedResource::new(2, 3, "textures", SuppliedKind::SampledImage).with_count(count)
}

fn interface(count: u32) -> DrawInterface {
    DrawInterface {
        vertex_buffers: vec![VertexBuffer::of_vertices(8)],
        attributes: vec![Attribute::new("place", 2, 0)],
        supplied: vec![textures(count)],
        ..DrawInterface::default()
    }
}

fn interfaces(count: u32) -> DrawInterfaces {
    let brought = move |draw| if draw == OBJECTS { interface(count) } else { DrawInterface::default() };
    DrawInterfaces::from(brought)
        .with(DrawKind::Compute, DrawInterface { supplied: vec![textures(count)], ..DrawInterface::default() })
}

/// Draws a triangle over everything, with textures of the reds 0, 10, 20, ….
struct Textured {
    group: BindGroup,
    corners: framewright_vulkan::Buffer,
}

fn reds(device: &Device, count: u32) -> Vec<Texture> {
    let red = |number: u32| u8::try_from(number % 25 * 10).expect("a byte");
    let texture = |number| {
        let texel = [red(number), 0, 0, 255];
        device.texture(1, 1, Format::R8G8B8A8_UNORM, &texel, &SamplerDescriptor::default(), false).expect("a texture")
    };
    (0..count).map(texture).collect()
}

impl Textured {
    fn new(device: &Device) -> Textured {
        let all = reds(device, COUNT);
        let group = device.bind_group(&interface(COUNT), 2, &[(3, Resource::Textures(&all))]).expect("it fits");
        let corners = [[-1.0_f32, -1.0], [3.0, -1.0], [-1.0, 3.0]].map(|corner| corner.map(f32::to_ne_bytes));
        let corners = device.buffer(BufferUsage::Vertex, corners.as_flattened().as_flattened()).expect("memory");
        Textured { group, corners }
    }
}

impl DrawSource for Textured {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        recorder.bind_vertex_buffer(&self.corners);
        recorder.bind_group(2, &self.group);
        recorder.draw(0..3, 0..1);
        Ok(1)
    }

    fn dispatch(&mut self, recorder: &mut DispatchRecorder<'_>) -> Result<(), Error> {
        recorder.bind_group(2, &self.group);
        Ok(())
    }
}

/// A pass over eight pixels in a row.
fn shown(shader: &str) -> Frame {
    let mut small = Small::default();
    let shown = small.image("shown", Format::R32_UINT, [8, 1]);
    if shader == "computed" {
        small.pass(dispatch(shader, Groups::Count([1, 1, 1])).stores("target", shown, Subresources::WHOLE));
    } else {
        small.pass(draw(shader, OBJECTS).draws(shown, Subresources::WHOLE, Some([255.0; 4])));
    }
    small.image_output(shown);
    small.frame
}

fn executor(device: &Device, shader: &str, count: u32) -> Result<Executor, Error> {
    let plan = planned(device, &shown(shader), &Options::default());
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interfaces(count));
    Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())
}

/// The row that a shader makes of the textures.
fn row(device: &Device, shader: &str) -> Result<Vec<u32>, String> {
    let mut executor = executor(device, shader, COUNT).map_err(|error| error.to_string())?;
    let mut source = Textured::new(device);
    for _ in 0..3 {
        executor.frame(&mut source).expect("a frame");
    }
    Ok(texels(&mut executor, "shown", 0))
}

/// Why a shader isn't drawn.
fn refused(device: &Device, shader: &str, count: u32) -> String {
    executor(device, shader, count).err().expect("it is refused").to_string()
}

const BACKWARDS: [u32; 8] = [70, 60, 50, 40, 30, 20, 10, 0];

#[test]
fn each_pixel_shows_the_texture_of_its_number() {
    on_each_driver(|device| {
        assert_eq!(row(device, "by_constants"), Ok(BACKWARDS.to_vec()));
        assert_eq!(row(device, "computed"), Ok(vec![70, 30, 30, 30, 30, 30, 30, 30]));
        for (shader, needed) in [("by_turns", 1), ("by_pixel", 2)] {
            let lacking = indexing(device).iter().take(needed).find(|(_, there)| !there).map(|(name, _)| *name);
            let expected = lacking.map_or_else(|| Ok(BACKWARDS.to_vec()), |name| Err(lacks(shader, name)));
            assert_eq!(row(device, shader).map_err(|said| placeless(&said)), expected);
        }
    });
}

#[test]
fn a_shader_declares_as_many_elements_as_are_brought_along_or_fewer() {
    on_each_driver(|device| {
        assert_eq!(row(device, "shorter").expect("it fits"), [20; 8]);
        let said = refused(device, "longer", COUNT);
        let what = "the shader reads `textures[9]` at set 2, binding 3, where this kind of draw brings along `textures`, \
                    an array of 8, each a two-dimensional floating-point image (`sampler2D`)";
        assert_eq!(said, format!("pass `longer`: {what}"));
    });
}

#[test]
fn a_group_takes_a_texture_for_each_element() {
    on_each_driver(|device| {
        let all = reds(device, COUNT);
        let said = |count, resource| {
            let group = device.bind_group(&interface(count), 2, &[(3, resource)]);
            group.err().map(|error| error.to_string()).unwrap_or_default()
        };
        assert_eq!(said(8, Resource::Textures(&all)), "");
        assert_eq!(said(1, Resource::Texture(&all[0])), "");
        assert_eq!(said(1, Resource::Textures(&all[..1])), "");
        let few = "bind group for set 2: `textures` takes 8 textures and was given ";
        assert_eq!(said(8, Resource::Textures(&all[..7])), format!("{few}7"));
        assert_eq!(said(8, Resource::Texture(&all[0])), format!("{few}1"));
        assert_eq!(said(8, Resource::Textures(&[])), format!("{few}0"));
        let twice = [(3, Resource::Texture(&all[0])), (3, Resource::Texture(&all[1]))];
        let said = device.bind_group(&interface(2), 2, &twice).err().expect("it is refused").to_string();
        assert_eq!(said, "bind group for set 2: `textures` is needed once and was given 2 times");
    });
}

#[test]
fn more_textures_than_a_stage_may_see_are_refused_with_the_limit() {
    on_each_driver(|device| {
        let (instance, physical) = device.raw_physical();
        // SAFETY: the physical device belongs to the instance.
        let limits = unsafe { instance.get_physical_device_properties(physical) }.limits;
        let most = limits.max_per_stage_descriptor_samplers.min(limits.max_per_stage_descriptor_sampled_images);
        let most = most.min(limits.max_descriptor_set_samplers).min(limits.max_descriptor_set_sampled_images);
        let words = format!(
            "{} sampled images are bound, {} of them as `textures`; this device allows {most} (max",
            most + 1,
            most + 1
        );
        let said = refused(device, "shorter", most + 1);
        assert!(said.starts_with(&format!("pass `shorter`: {words}")), "{said}");
        let group = device.bind_group(&interface(most + 1), 2, &[]).err().expect("it is refused").to_string();
        assert!(group.starts_with(&format!("bind group for set 2: {words}")), "{group}");
        if most <= 4096 {
            let all = vec![reds(device, 1).remove(0); most as usize];
            device.bind_group(&interface(most), 2, &[(3, Resource::Textures(&all))]).expect("it fits");
            executor(device, "shorter", most).expect("it fits");
        }
    });
}
