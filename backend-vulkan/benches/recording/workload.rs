//! The frames that are recorded, their shaders, and the objects of the one that draws objects.

use framewright_graph::base::Span;
use framewright_graph::compile::{Options, compile};
use framewright_graph::frame::{
    Blend, ColorTarget, DepthTarget, Draw, DrawList, Frame, Groups, Image, ImageIndex, Pass, Resource, SampledImage,
    Storage, Work,
};
use framewright_graph::plan::Plan;
use framewright_graph::shader::{Attribute, DrawInterface, SuppliedKind, SuppliedResource, VertexBuffer};
use framewright_graph::vulkan::{CompareOp, Format, Stages, Subresources};
use framewright_vulkan::Device;
use std::fmt::Write;

/// Shader files: name, GLSL text.
pub(crate) type Shaders = &'static [(&'static str, &'static str)];

/// The set that holds what is the same for all objects.
pub(crate) const FRAME_SET: u32 = 1;
/// The set that holds a material.
pub(crate) const MATERIAL_SET: u32 = 2;
/// Bytes from vertex to vertex: a position of two components.
pub(crate) const VERTEX_BYTES: u32 = 8;

const VERTICES: &str = "#version 460
    void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0); }";
const OBJECT_VERTICES: &str = "#version 460
    layout(set = 1, binding = 0) readonly buffer Objects { vec4 place[]; } objects;
    layout(location = 0) in vec2 position;
    void main() {
        vec4 place = objects.place[gl_InstanceIndex];
        gl_Position = vec4(position * place.zw + place.xy, 0.5, 1.0);
    }";
const OBJECT_FRAGMENTS: &str = "#version 460
    layout(set = 2, binding = 0) uniform Material { vec4 color; } material;
    layout(location = 0) out vec4 color;
    void main() { color = material.color; }";

/// A frame, its shaders and objects.
pub(crate) struct Workload {
    pub(crate) frame: Frame,
    pub(crate) shaders: Shaders,
    pub(crate) objects: Option<Objects>,
}

/// Objects as a scene has them: one mesh, a few materials, and a draw call for each object, sorted by material.
#[derive(Clone)]
pub(crate) struct Objects {
    pub(crate) vertices: Vec<u8>,
    pub(crate) indices: Vec<u8>,
    pub(crate) index_count: u32,
    /// By object: its place.
    pub(crate) places: Vec<u8>,
    /// By material: its colour.
    pub(crate) materials: Vec<Vec<u8>>,
    /// Each run of objects with one material: the material, and how many they are.
    pub(crate) runs: Vec<(usize, u32)>,
}

impl Workload {
    /// The Plan of the frame.
    pub(crate) fn plan(&self, device: &Device) -> Plan {
        let plan = compile(&self.frame, &device.profile(), &mut device.memory(), &Options::default());
        plan.unwrap_or_else(|errors| panic!("{errors:?}"))
    }
}

/// The interface of the draw source.
pub(crate) fn interface(draw: Draw) -> DrawInterface {
    if draw != Draw::Objects(DrawList::Opaque) {
        return DrawInterface::default();
    }
    let supplied = |set, name, kind| SuppliedResource::new(set, 0, name, kind);
    DrawInterface {
        vertex_buffers: vec![VertexBuffer::of_vertices(VERTEX_BYTES)],
        attributes: vec![Attribute::new("position", 2, 0)],
        supplied: vec![
            supplied(FRAME_SET, "objects", SuppliedKind::StorageBlock),
            supplied(MATERIAL_SET, "material", SuppliedKind::UniformBlock),
        ],
        ..DrawInterface::default()
    }
}

/// Full-screen passes, each of which samples the image before and draws the next.
pub(crate) fn chain(passes: u32, side: u32) -> Workload {
    let mut builder = Builder::default();
    let mut before: Option<ImageIndex> = None;
    for number in 0..passes {
        let image = builder.image(&format!("image{number}"), Format::R8G8B8A8_UNORM, side, side);
        builder.draw(&format!("pass{number}"), before.as_slice(), &[image], None);
        before = Some(image);
    }
    builder.finish(ImageIndex(passes - 1))
}

/// A deferred frame of 25 passes, an eighth as wide and high as 1920×1080: shadow cascades, depth, four targets, occlusion,
/// lighting, transparents, bloom by compute shaders, tone mapping, anti-aliasing, an interface.
pub(crate) fn deferred() -> Workload {
    use Format::{D32_SFLOAT, R8_UNORM, R8G8B8A8_UNORM, R16G16_SFLOAT, R16G16B16A16_SFLOAT};
    let (width, height) = (240, 135);
    let mut builder = Builder::default();
    let cascades: Vec<ImageIndex> =
        (0..4).map(|number| builder.image(&format!("cascade{number}"), D32_SFLOAT, 256, 256)).collect();
    let mut image = |name: &str, format| builder.image(name, format, width, height);
    let depth = image("depth", D32_SFLOAT);
    let targets = [
        ("albedo", R8G8B8A8_UNORM),
        ("normal", R16G16B16A16_SFLOAT),
        ("material", R8G8B8A8_UNORM),
        ("motion", R16G16_SFLOAT),
    ];
    let [albedo, normal, material, motion] = targets.map(|(name, format)| image(name, format));
    let [occlusion, blurred] = ["occlusion", "occlusion_blurred"].map(|name| image(name, R8_UNORM));
    let lit = image("lit", R16G16B16A16_SFLOAT);
    let [mapped, smooth] = ["mapped", "smooth"].map(|name| image(name, R8G8B8A8_UNORM));
    let mut bloom = |way: &str, level: u32| {
        builder.image(&format!("bloom_{way}{level}"), R16G16B16A16_SFLOAT, width >> level, height >> level)
    };
    let down: Vec<ImageIndex> = (1..=6).map(|level| bloom("down", level)).collect();
    let up: Vec<ImageIndex> = (0..6).map(|level| bloom("up", level)).collect();

    for (number, cascade) in cascades.iter().enumerate() {
        builder.draw(&format!("cascade{number}"), &[], &[], Some((*cascade, true)));
    }
    builder.draw("depth", &[], &[], Some((depth, true)));
    builder.draw("g_buffer", &[], &[albedo, normal, material, motion], Some((depth, false)));
    builder.draw("occlusion", &[depth, normal], &[occlusion], None);
    builder.draw("occlusion_blur", &[occlusion], &[blurred], None);
    let shading = [&[albedo, normal, material, depth, blurred][..], &cascades[..]].concat();
    builder.draw("lighting", &shading, &[lit], None);
    builder.blend("transparents", &[&[depth][..], &cascades[..]].concat(), lit);
    for level in 0..6 {
        let source = if level == 0 { lit } else { down[level - 1] };
        builder.dispatch(&format!("bloom_down{level}"), &[source], down[level]);
    }
    for level in (0..6).rev() {
        let sources = if level == 5 { vec![down[5]] } else { vec![up[level + 1], down[level]] };
        builder.dispatch(&format!("bloom_up{level}"), &sources, up[level]);
    }
    builder.draw("tone_map", &[lit, up[0]], &[mapped], None);
    builder.draw("smooth", &[mapped, motion], &[smooth], None);
    builder.blend("interface", &[], smooth);
    builder.finish(smooth)
}

/// Objects of four materials, drawn one by one in one pass, and a full-screen pass over them.
pub(crate) fn objects(count: u32) -> Workload {
    let mut builder = Builder::default();
    let [drawn, shown] = ["drawn", "shown"].map(|name| builder.image(name, Format::R8G8B8A8_UNORM, 256, 256));
    let draw = Draw::Objects(DrawList::Opaque);
    let mut pass = builder.drawing("objects", draw, "objects", &[]);
    pass.color.push(ColorTarget { clear: Some([0.0, 0.0, 0.0, 1.0]), ..color(drawn, Blend::Replace) });
    builder.frame.passes.push(pass);
    builder.shader("objects.vert", || OBJECT_VERTICES.to_owned());
    builder.shader("objects.frag", || OBJECT_FRAGMENTS.to_owned());
    builder.draw("show", &[drawn], &[shown], None);

    let side = count.isqrt().max(1);
    let floats = |values: &[f32]| values.iter().flat_map(|value| value.to_ne_bytes()).collect::<Vec<u8>>();
    let step = 2.0 / side as f32;
    let place = |number: u32| {
        let at = [number % side, number / side].map(|at| at as f32 * step - 1.0);
        floats(&[at[0], at[1], 0.8 * step, 0.8 * step])
    };
    let material_of: Vec<usize> = (0..count as usize).map(|number| number * 4 / count as usize).collect();
    let objects = Objects {
        vertices: floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
        indices: [0_u32, 1, 2, 2, 1, 3].iter().flat_map(|index| index.to_ne_bytes()).collect(),
        index_count: 6,
        places: (0..count).flat_map(place).collect(),
        materials: [[0.8, 0.2, 0.2, 1.0], [0.2, 0.3, 0.7, 1.0], [0.9, 0.9, 0.9, 1.0], [0.2, 0.6, 0.3, 1.0]]
            .iter()
            .map(|color| floats(color))
            .collect(),
        runs: material_of.chunk_by(|a, b| a == b).map(|run| (run[0], run.len() as u32)).collect(),
    };
    Workload { objects: Some(objects), ..builder.finish(shown) }
}

/// A frame that grows, with the shaders of its passes.
#[derive(Default)]
struct Builder {
    frame: Frame,
    shaders: Vec<(String, String)>,
}

impl Builder {
    fn image(&mut self, name: &str, format: Format, width: u32, height: u32) -> ImageIndex {
        self.frame.images.push(Image::new(name, format, width.max(1), height.max(1)));
        ImageIndex(self.frame.images.len() as u32 - 1)
    }

    /// A full-screen pass that samples `reads` and draws `targets` anew. A depth image is drawn too, or tested.
    fn draw(&mut self, name: &str, reads: &[ImageIndex], targets: &[ImageIndex], depth: Option<(ImageIndex, bool)>) {
        let shader = self.full_screen(reads.len(), targets.len());
        let mut pass = self.drawing(name, Draw::FullScreen, &shader, reads);
        // Where depth is tested, texels may stay as they were.
        let clear = depth.is_some_and(|(_, write)| !write).then_some([0.0; 4]);
        pass.color = targets.iter().map(|target| ColorTarget { clear, ..color(*target, Blend::Replace) }).collect();
        pass.depth = depth.map(|(image, write)| DepthTarget {
            image,
            range: Subresources::WHOLE,
            span: Span::NONE,
            clear: write.then_some(0.0),
            test: if write { CompareOp::Always } else { CompareOp::GreaterOrEqual },
            write,
            stencil: None,
        });
        self.frame.passes.push(pass);
    }

    /// A full-screen pass that samples `reads` and blends over `target`.
    fn blend(&mut self, name: &str, reads: &[ImageIndex], target: ImageIndex) {
        let shader = self.full_screen(reads.len(), 1);
        let mut pass = self.drawing(name, Draw::FullScreen, &shader, reads);
        pass.color.push(color(target, Blend::Alpha));
        self.frame.passes.push(pass);
    }

    /// A compute pass that samples `reads` and writes all of `target`.
    fn dispatch(&mut self, name: &str, reads: &[ImageIndex], target: ImageIndex) {
        let shader = format!("compute{}", reads.len());
        self.shader(&format!("{shader}.comp"), || {
            let mut text = sources(reads.len());
            let binding = reads.len();
            let _ = write!(
                text,
                "layout(local_size_x = 8, local_size_y = 8) in;
                layout(set = 0, binding = {binding}, rgba16f) uniform writeonly image2D stored;
                void main() {{
                    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
                    if (any(greaterThanEqual(at, imageSize(stored)))) return;
                    imageStore(stored, at, {});
                }}",
                sum(reads.len(), "at")
            );
            text
        });
        let [width, height, _] = self.frame.images[target.0 as usize].extent;
        let work = Work::Dispatch { shader: shader.into(), groups: Groups::Invocations([width, height, 1]) };
        let storage = Storage {
            binding: "stored".into(),
            image: target,
            range: Subresources::WHOLE,
            span: Span::NONE,
            read: false,
            write: true,
            eye: None,
            stages: Stages::COMPUTE_SHADER,
        };
        let sampled = sampled(reads, Stages::COMPUTE_SHADER);
        self.frame.passes.push(Pass { sampled, storage: vec![storage], ..Pass::new(name, work) });
    }

    fn drawing(&self, name: &str, draw: Draw, shader: &str, reads: &[ImageIndex]) -> Pass {
        let work = Work::Draw { draw, shader: shader.into(), discards: false, per_sample: false };
        Pass { sampled: sampled(reads, Stages::FRAGMENT_SHADER), ..Pass::new(name, work) }
    }

    /// The name of the shader of full-screen passes with `reads` sources and `targets` targets.
    fn full_screen(&mut self, reads: usize, targets: usize) -> String {
        let name = format!("draw{reads}_{targets}");
        self.shader(&format!("{name}.frag"), || {
            let mut text = sources(reads);
            for target in 0..targets {
                let _ = writeln!(text, "layout(location = {target}) out vec4 target{target};");
            }
            let _ = writeln!(text, "void main() {{ ivec2 at = ivec2(gl_FragCoord.xy);");
            for target in 0..targets {
                let _ = writeln!(text, "target{target} = {};", sum(reads, "at"));
            }
            text + "}"
        });
        name
    }

    fn shader(&mut self, name: &str, text: impl FnOnce() -> String) {
        if self.shaders.iter().all(|(known, _)| known != name) {
            self.shaders.push((name.to_owned(), text()));
        }
    }

    fn finish(mut self, output: ImageIndex) -> Workload {
        self.shader("full_screen.vert", || VERTICES.to_owned());
        self.frame.outputs.push(Resource::Image(output).into());
        let kept = |text: String| -> &'static str { text.leak() };
        let shaders: Vec<_> = self.shaders.into_iter().map(|(name, text)| (kept(name), kept(text))).collect();
        Workload { frame: self.frame, shaders: shaders.leak(), objects: None }
    }
}

/// The declarations of a shader with `count` sources.
fn sources(count: usize) -> String {
    (0..count).fold("#version 460\n".to_owned(), |mut text, number| {
        let _ = writeln!(text, "layout(set = 0, binding = {number}) uniform sampler2D source{number};");
        text
    })
}

/// A colour made of all sources.
fn sum(sources: usize, at: &str) -> String {
    (0..sources).fold(format!("vec4(0.1, 0.2, float(({at}.x ^ {at}.y) & 15) / 32.0, 0.5)"), |mut text, number| {
        let _ = write!(text, " + 0.4 * texelFetch(source{number}, {at} % textureSize(source{number}, 0), 0)");
        text
    })
}

fn sampled(reads: &[ImageIndex], stages: Stages) -> Vec<SampledImage> {
    let one = |(number, image): (usize, &ImageIndex)| SampledImage::new(format!("source{number}"), *image, stages);
    reads.iter().enumerate().map(one).collect()
}

fn color(image: ImageIndex, blend: Blend) -> ColorTarget {
    ColorTarget {
        image,
        range: Subresources::WHOLE,
        span: Span::NONE,
        clear: None,
        blend,
        write_mask: Default::default(),
    }
}
