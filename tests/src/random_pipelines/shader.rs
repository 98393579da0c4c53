//! The shaders of random pipelines: few texts, told apart by what is bound to them; all else are parameters.

use super::hash::{CONTENT_GLSL, GLSL, QUARTER_GLSL};
use super::pipeline::{
    Compute, Draw, Geometry, Image, Pass, Pipeline, Plane, Read, Region, SAMPLES, Store, StoreAccess, WORKGROUP, Work,
};
use super::{texels, valid};
use framewright_graph::frame::{Blend, ParamValue};
use framewright_graph::vulkan::{Format, Numeric, Shape};
use std::fmt::Write;

/// A pass's shader and the values of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Shader {
    /// Its name, which follows from its text.
    pub name: String,
    /// File names and GLSL.
    pub files: Vec<(String, String)>,
    /// Parameters in order.
    pub params: Vec<(String, ParamValue)>,
}

/// The shader of a pass; `None` if it needs none.
#[must_use]
pub fn shader(pipeline: &Pipeline, pass: &Pass) -> Option<Shader> {
    let mut text = Text::default();
    text.param("number", ParamValue::Integer(pass.number.into()));
    let (reads, stores) = valid::shader(pass);
    let vertex_reads = if let Work::Draw(draw) = &pass.work { draw.vertex_reads } else { 0 };
    for (number, read) in reads.iter().enumerate() {
        text.read(pipeline, number, *read);
        if number + 1 == vertex_reads {
            text.vertex = Some((std::mem::take(&mut text.declarations), std::mem::take(&mut text.body)));
            text.key += "_v";
        }
    }
    match &pass.work {
        Work::Draw(draw) => {
            text.draw(pipeline, draw);
            stores.iter().enumerate().for_each(|(number, store)| text.store(pipeline, number, *store));
            Some(text.draw_shader(draw))
        }
        Work::Compute(compute) => {
            text.compute(pipeline, compute);
            stores.iter().enumerate().for_each(|(number, store)| text.store(pipeline, number, *store));
            Some(text.compute_shader())
        }
        _ => None,
    }
}

/// A shader that grows.
#[derive(Default)]
struct Text {
    /// The key that tells the shader from others.
    key: String,
    declarations: String,
    body: String,
    members: String,
    /// Where in vectors and matrices parameters are.
    places: String,
    params: Vec<(String, ParamValue)>,
    bindings: u32,
    structured: bool,
    /// Declarations and body of what the vertex shader reads.
    vertex: Option<(String, String)>,
}

impl Text {
    /// Adds a parameter: by itself, as a component of a vector, or of a matrix, in turn.
    fn param(&mut self, name: &str, value: ParamValue) {
        let is_float = matches!(value, ParamValue::Number(_));
        let (scalar, vector) = if is_float { ("float", "vec3") } else { ("uint", "uvec3") };
        let other = || ParamValue::Integer(9);
        let column = |value| ParamValue::list([other(), value, other()]);
        // Names of one word may be others elsewhere.
        let (ty, place, value) = match self.params.len() % 3 {
            _ if !name.contains('_') => (scalar, "", value),
            0 => (scalar, "", value),
            1 if is_float => ("mat2x3", "[1].y", ParamValue::list([column(other()), column(value)])),
            _ => (vector, ".y", column(value)),
        };
        // Writing into a String can't fail.
        if place.is_empty() {
            let _ = writeln!(self.members, "    {ty} {name};");
            self.params.push((name.to_owned(), value));
        } else {
            let _ = writeln!(self.members, "    {ty} {name}_within;");
            let _ = writeln!(self.places, "#define {name} {name}_within{place}");
            self.params.push((format!("{name}_within"), value));
        }
    }

    fn whole(&mut self, name: &str, value: u32) {
        self.param(name, ParamValue::Integer(value.into()));
    }

    fn number(&mut self, name: &str, value: f32) {
        self.param(name, ParamValue::Number(value.into()));
    }

    /// The next binding number; 0 belongs to the parameters.
    fn binding(&mut self) -> u32 {
        self.bindings += 1;
        self.bindings
    }

    fn read(&mut self, pipeline: &Pipeline, number: usize, read: Read) {
        let binding = self.binding();
        let name = format!("read{number}");
        let (image, dimension) = match read {
            Read::Uniform(..) => {
                self.key += "_b";
                self.declare(&format!(
                    "layout(set = 0, binding = {binding}) uniform {name} {{ uvec4 {name}_words[4]; }};"
                ));
                self.say(&format!("state = hash(state, {name}_words[(state >> 2) & 3u][state & 3u]);"));
                return;
            }
            Read::Block(..) => {
                self.key += "_s";
                let words = format!("readonly buffer {name} {{ uint {name}_words[]; }};");
                self.declare(&format!("layout(set = 0, binding = {binding}, std430) {words}"));
                self.say(&format!("state = hash(state, {name}_words[state % uint({name}_words.length())]);"));
                return;
            }
            Read::Storage(part) => {
                let image = &pipeline.images[part.image];
                (image, dimension(image, part.layers))
            }
            Read::Own(part) => (&pipeline.images[part.image], "2D"),
            Read::Sampled { part, per_sample: true, .. } => (&pipeline.images[part.image], "2DMS"),
            Read::Sampled { part, .. } => {
                let image = &pipeline.images[part.image];
                (image, dimension(image, part.layers))
            }
        };
        let plane = match read {
            Read::Sampled { part, .. } | Read::Own(part) => part.plane,
            _ => Plane::All,
        };
        let (format, _) = texels::seen(image.format, plane, [0; 4]);
        let uint = texels::is_uint(format);
        let prefix = if uint { "u" } else { "" };
        self.whole(&format!("{name}_parts"), texels::parts(format));
        if !uint {
            self.number(&format!("{name}_scale"), texels::scale(format));
        }
        let whole = |texel: &str| if uint { texel.to_owned() } else { format!("uvec4({texel} * {name}_scale + 0.5)") };
        if matches!(read, Read::Own(_)) {
            self.key += if uint { "_uown" } else { "_fown" };
            return self.own(&name, binding, prefix, whole);
        }
        if matches!(read, Read::Sampled { part, .. } if part.mip > 0 && part.mips > 1) {
            self.key += "_o";
        }
        if matches!(read, Read::Storage(_)) {
            let layout = qualifier(image.format);
            self.key += &format!("_l{layout}{dimension}");
            let declared = format!("uniform readonly {prefix}image{dimension} {name};");
            self.declare(&format!("layout(set = 0, binding = {binding}, {layout}) {declared}"));
        } else {
            self.key += &format!("_{}{dimension}", if uint { "u" } else { "f" });
            self.declare(&format!("layout(set = 0, binding = {binding}) uniform {prefix}sampler{dimension} {name};"));
        }
        if dimension == "2DMS" {
            self.say(&format!("for (int at_sample = 0; at_sample < {SAMPLES}; ++at_sample)"));
            let at = format!("ivec2(near(uvec3(textureSize({name}), 1u), state, here).xy)");
            let texel = whole(&format!("texelFetch({name}, {at}, at_sample)"));
            return self.say(&format!("    state = hash4(state, {texel}, {name}_parts);"));
        }
        let (texel, level) = if matches!(read, Read::Storage(_)) {
            let (size, place) = places(dimension, &format!("imageSize({name})"));
            self.say(&format!("place = near({size}, state, here);"));
            (format!("imageLoad({name}, {place})"), "")
        } else {
            // Of one quad all fragments take the same level: lavapipe knows no others. Of several quads it asks for the
            // size of one's level, so the size follows from that of the first level.
            self.say(&format!("level = int((here.x / 2u + here.y / 2u + here.z) % uint(textureQueryLevels({name})));"));
            let (size, place) = places(dimension, &format!("textureSize({name}, 0)"));
            self.say(&format!("size = level_of({size}, level, {});", dimension == "3D"));
            self.say("place = near(size, state, here);");
            let sampled = |at: &str| (format!("textureLod({name}, {at}, float(level))"), "");
            // SwiftShader fetches nothing from levels of a view of several that begins beyond the image's first.
            let later = matches!(read, Read::Sampled { part, .. } if part.mip > 0 && part.mips > 1);
            match dimension {
                "Cube" => sampled("towards(place, int(size.x))"),
                "2D" if later => sampled("(vec2(place.xy) + 0.5) / vec2(size.xy)"),
                "2DArray" if later => sampled("vec3((vec2(place.xy) + 0.5) / vec2(size.xy), place.z)"),
                _ => (format!("texelFetch({name}, {place}"), ", level)"),
            }
        };
        let texel = whole(&format!("{texel}{level}"));
        self.say(&format!("state = hash4(state, {texel}, {name}_parts);"));
    }

    /// A texel at the fragment's own position, from memory or from what the rendering scope has there.
    fn own(&mut self, name: &str, binding: u32, prefix: &str, whole: impl Fn(&str) -> String) {
        let local = format!("LOCAL_READ_{name}");
        let place = format!("set = 0, binding = {binding}");
        self.declare(&format!("#ifdef {local}"));
        self.declare(&format!(
            "layout({place}, input_attachment_index = {binding}) uniform {prefix}subpassInput {name};"
        ));
        self.declare(&format!("#else\nlayout({place}) uniform {prefix}sampler2D {name};\n#endif"));
        self.say(&format!("#ifdef {local}"));
        self.say(&format!("state = hash4(state, {}, {name}_parts);", whole(&format!("subpassLoad({name})"))));
        self.say("#else");
        let texel = whole(&format!("texelFetch({name}, ivec2(here.xy), 0)"));
        self.say(&format!("state = hash4(state, {texel}, {name}_parts);"));
        self.say("#endif");
    }

    fn draw(&mut self, pipeline: &Pipeline, draw: &Draw) {
        if let Geometry::Triangles { vertices, .. } = draw.geometry {
            self.key += if vertices.is_some() { "_tv" } else { "_t" };
            let part = draw.color.first().map(|target| target.part).or(draw.depth.map(|depth| depth.part));
            let [width, height, _] = part.map_or([1; 3], |part| pipeline.images[part.image].extent_of(part.mip));
            self.whole("width", width);
            self.whole("height", height);
        }
        if draw.discards {
            self.key += "_x";
            self.say("if ((state & 7u) == 0u) discard;");
        }
        if draw.per_sample {
            self.key += "_p";
        }
        for (number, target) in draw.color.iter().enumerate() {
            let format = pipeline.images[target.part.image].format;
            let uint = texels::is_uint(format);
            let ty = if uint { "uvec4" } else { "vec4" };
            self.key += if uint { "_cu" } else { "_cf" };
            self.declare(&format!("layout(location = {number}) out {ty} color{number};"));
            self.value(&format!("color{number}"), number as u32 * 4, format, target.blend);
            if !uint {
                let opaque = matches!(target.blend, Blend::Alpha | Blend::Premultiplied);
                self.whole(&format!("color{number}_opaque"), opaque.into());
                let alpha = format!("color{number}.a = float(hash(state, {}u) & 1u);", number * 4 + 3);
                self.say(&format!("if (color{number}_opaque == 1u) {alpha}"));
            }
        }
    }

    /// Sets `target` to four words from the hash, as `format` holds them.
    fn value(&mut self, target: &str, from: u32, format: Format, blend: Blend) {
        let mask = format!("{target}_mask");
        self.whole(&mask, texels::mask(format, blend));
        let words = format!("(hashes(state, {from}u) & {mask})");
        if texels::is_uint(format) {
            self.say(&format!("{target} = {words};"));
        } else {
            self.number(&format!("{target}_divisor"), texels::divisor(format));
            self.say(&format!("{target} = vec4{words} / {target}_divisor;"));
        }
    }

    fn compute(&mut self, pipeline: &Pipeline, compute: &Compute) {
        for (name, side) in ["grid_x", "grid_y", "grid_z"].into_iter().zip(compute.grid) {
            self.whole(name, side);
        }
        let contents = compute.stores.iter().find_map(|store| match store.region {
            Region::Buffer(buffer) => Some(pipeline.buffers[buffer].contents),
            Region::Image(_) => None,
        });
        if let Some(contents) = contents {
            self.structured = true;
            self.key += "_w";
            self.whole("contents", contents.number());
            self.whole("together", contents.group());
        }
    }

    fn store(&mut self, pipeline: &Pipeline, number: usize, store: Store) {
        let binding = self.binding();
        let name = format!("store{number}");
        let from = 64 + 4 * number as u32;
        let letter = match store.access {
            StoreAccess::Write => "w",
            StoreAccess::Modify => "m",
            StoreAccess::Add => "a",
        };
        let part = match store.region {
            Region::Image(part) => part,
            Region::Buffer(_) => {
                self.key += &format!("_{letter}b");
                let access = if store.access == StoreAccess::Write { "writeonly " } else { "" };
                let words = format!("{access}buffer {name} {{ uint {name}_words[]; }};");
                self.declare(&format!("layout(set = 0, binding = {binding}, std430) {words}"));
                let word = format!("{name}_words[line]");
                let inside = format!("if (line < uint({name}_words.length()))");
                return match store.access {
                    StoreAccess::Write => {
                        self.say(&format!("{inside} {word} = content(contents, line, hash(state, {from}u));"));
                    }
                    StoreAccess::Modify => self.say(&format!("{inside} {word} = hash(hash(state, {from}u), {word});")),
                    StoreAccess::Add => {
                        let anywhere = format!("{name}_words[state % uint({name}_words.length())]");
                        self.say(&format!("atomicAdd({anywhere}, state >> 20);"));
                    }
                };
            }
        };
        let image = &pipeline.images[part.image];
        let dimension = dimension(image, part.layers);
        let layout = qualifier(image.format);
        let uint = texels::is_uint(image.format);
        self.key += &format!("_{letter}{layout}{dimension}");
        let prefix = if uint { "u" } else { "" };
        let access = if store.access == StoreAccess::Write { "writeonly " } else { "" };
        let declared = format!("uniform {access}{prefix}image{dimension} {name};");
        self.declare(&format!("layout(set = 0, binding = {binding}, {layout}) {declared}"));
        let (size, place) = places(dimension, &format!("imageSize({name})"));
        if store.access == StoreAccess::Add {
            self.say(&format!("place = near({size}, state, at);"));
            return self.say(&format!("imageAtomicAdd({name}, {place}, state >> 20);"));
        }
        let local = format!("{name}_value");
        self.say("place = at;");
        self.say(&format!("if (all(lessThan(at, {size}))) {{"));
        self.say(&format!("    {}vec4 {local};", prefix));
        if store.access == StoreAccess::Modify {
            self.whole(&format!("{name}_parts"), texels::parts(image.format));
            self.whole(&format!("{local}_mask"), texels::mask(image.format, Blend::Replace));
            let old = format!("hash4(state, imageLoad({name}, {place}), {name}_parts)");
            self.say(&format!("    {local} = hashes({old}, {from}u) & {local}_mask;"));
        } else {
            self.value(&local, from, image.format, Blend::Replace);
        }
        self.say(&format!("    imageStore({name}, {place}, {local});\n    }}"));
    }

    fn declare(&mut self, line: &str) {
        self.declarations += line;
        self.declarations.push('\n');
    }

    fn say(&mut self, line: &str) {
        self.body += "    ";
        self.body += line;
        self.body.push('\n');
    }

    fn block(&self) -> String {
        format!("layout(set = 0, binding = 0) uniform params {{\n{}}};\n{}", self.members, self.places)
    }

    fn draw_shader(self, draw: &Draw) -> Shader {
        let name = format!("draw{}", self.key);
        let triangles = matches!(draw.geometry, Geometry::Triangles { .. });
        let block = self.block();
        let head = format!("#version 460\n{block}{GLSL}");
        let sample = if draw.per_sample { "state = hash(state, uint(gl_SampleID));\n    " } else { "" };
        let (input, triangle) = if triangles {
            ("layout(location = 0) flat in uint triangle;\n", "state = hash(state, triangle);\n    ")
        } else {
            ("", "")
        };
        let start =
            "const uvec3 at = uvec3(gl_FragCoord.xy, 0.0), here = at;\n    uvec3 place, size;\n    int level;\n    ";
        let state = "uint state = hash(hash(hash(number, at.x), at.y), at.z);\n    ";
        let fragment = format!(
            "{head}{NEAR}{}{input}void main() {{\n    {start}{state}{triangle}{sample}\n{}}}\n",
            self.declarations, self.body
        );
        let mut files = vec![(format!("{name}.frag"), fragment)];
        if triangles {
            let seeded = matches!(draw.geometry, Geometry::Triangles { vertices: Some(_), .. });
            let attribute = if seeded { "layout(location = 0) in float seed;\n" } else { "" };
            let main = QUARTER_GLSL.replace("VERTEX", if seeded { "floatBitsToUint(seed)" } else { "0u" });
            let output = "layout(location = 0) flat out uint triangle;\n";
            let (declarations, reads) = match self.vertex {
                Some((declarations, body)) => {
                    let here = "    const uvec3 here = uvec3(0u);\n    uvec3 place, size;\n    int level;\n";
                    (format!("{NEAR}{declarations}"), format!("{here}{body}"))
                }
                None => (String::new(), String::new()),
            };
            let main = main.replace("READS", &reads);
            files.push((format!("{name}.vert"), format!("{head}{attribute}{output}{declarations}{main}")));
        }
        Shader { name, files, params: self.params }
    }

    fn compute_shader(self) -> Shader {
        let name = format!("compute{}", self.key);
        let block = self.block();
        let head = format!("#version 460\nlayout(local_size_x = {WORKGROUP}, local_size_y = {WORKGROUP}) in;\n{block}");
        let content = if self.structured { CONTENT_GLSL } else { "" };
        let start = "const uvec3 at = gl_GlobalInvocationID, grid = uvec3(grid_x, grid_y, grid_z);\n    \
            if (any(greaterThanEqual(at, grid))) return;\n    uvec3 place, size;\n    int level;\n    \
            const uint line = (at.z * grid.y + at.y) * grid.x + at.x;\n    ";
        // Values that are made together are read at one position.
        let group = if self.structured { "at.x - at.x % together" } else { "at.x" };
        let state = format!(
            "const uvec3 here = uvec3({group}, at.yz);\n    \
             uint state = hash(hash(hash(number, here.x), here.y), here.z);\n"
        );
        let body = format!("void main() {{\n    {start}{state}{}}}\n", self.body);
        let text = format!("{head}{GLSL}{content}{NEAR}{}{body}", self.declarations);
        Shader { files: vec![(format!("{name}.comp"), text)], name, params: self.params }
    }
}

/// A position near one's own inside an image of this size, and the direction in which a cube's texel lies.
const NEAR: &str = "\
uvec3 near(uvec3 size, uint state, uvec3 at) {
    return (at + uvec3(state & 3u, (state >> 2) & 3u, (state >> 4) & 3u)) % size;
}

uvec3 level_of(uvec3 size, int level, bool deep) {
    return uvec3(max(size.xy >> level, uvec2(1u)), deep ? max(size.z >> level, 1u) : size.z);
}

vec3 towards(uvec3 place, int size) {
    const vec2 on = (vec2(place.xy) + 0.5) / float(size) * 2.0 - 1.0;
    switch (place.z) {
        case 0: return vec3(1.0, -on.y, -on.x);
        case 1: return vec3(-1.0, -on.y, on.x);
        case 2: return vec3(on.x, 1.0, on.y);
        case 3: return vec3(on.x, -1.0, -on.y);
        case 4: return vec3(on.x, -on.y, 1.0);
        default: return vec3(-on.x, -on.y, -1.0);
    }
}

";

/// The dimension of an image with this many layers in GLSL.
fn dimension(image: &Image, layers: u32) -> &'static str {
    match (image.shape, layers) {
        (Shape::D3, _) => "3D",
        (Shape::Cube, 6) => "Cube",
        (_, 1) => "2D",
        _ => "2DArray",
    }
}

/// The size of an image as a `uvec3`, and `place` as its coordinates.
fn places(dimension: &str, size: &str) -> (String, &'static str) {
    match dimension {
        "2D" => (format!("uvec3({size}, 1u)"), "ivec2(place.xy)"),
        "Cube" => (format!("uvec3({size}, 6u)"), "ivec3(place)"),
        _ => (format!("uvec3({size})"), "ivec3(place)"),
    }
}

/// The format of a storage image in GLSL.
fn qualifier(format: Format) -> String {
    let letters = ["r", "rg", "rgb", "rgba"][format.components() as usize - 1];
    let bits = 8 * format.texel_bytes() / u64::from(format.components());
    let kind = match format.numeric() {
        Numeric::Uint => "ui",
        Numeric::Sfloat => "f",
        _ => "",
    };
    format!("{letters}{bits}{kind}")
}
