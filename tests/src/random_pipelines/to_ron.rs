//! A random pipeline as the text of a pipeline file.

use super::pipeline::{
    Compute, Count, Draw, Geometry, Groups, Image, Life, Part, Pass, Pipeline, Plane, Read, Region, Store, StoreAccess,
    Thing, Work,
};
use super::{shader, texels, to_frame, valid};
use framewright_graph::frame::{ParamValue, StencilState};
use framewright_graph::vulkan::{
    Aspects, ColorComponents, FillValue, Format, Layout, OutsideOwner, ResolveMode, Shape, Stages,
};

/// The pipeline file that says what `pipeline` says. Its shaders are those of [`shader::shader`]. `per_eye`: each eye has images of its
/// own, which hold the same.
#[must_use]
pub fn to_ron(pipeline: &Pipeline, per_eye: bool) -> String {
    let eyes = if per_eye { ", per_eye: true" } else { "" };
    let images = pipeline.images.iter().enumerate().map(|(number, image)| image_text(number, image, eyes));
    let buffers = pipeline.buffers.iter().enumerate().map(|(number, buffer)| {
        let lifetime = life((buffer.life, number), "", |value| value.to_string());
        format!("(name: \"b{number}\", bytes: {}{lifetime})", 4 * buffer.words)
    });
    let passes = pipeline.passes.iter().map(|pass| pass_text(pipeline, pass));
    let outputs = pipeline.outputs.iter().map(|output| output_text(pipeline, *output));
    let list = |name: &str, entries: Vec<String>| {
        let lines: String = entries.into_iter().map(|entry| format!("        {entry},\n")).collect();
        if lines.is_empty() { String::new() } else { format!("    {name}: [\n{lines}    ],\n") }
    };
    format!(
        "Pipeline(\n    version: 1,\n    settings: [(name: \"switch\", value: Bool(default: false))],\n{}{}    passes: [\n{}    ],\n    outputs: [{}],\n)\n",
        list("images", images.collect()),
        list("buffers", buffers.collect()),
        passes.map(|pass| format!("        {pass},\n")).collect::<String>(),
        outputs.collect::<Vec<_>>().join(", "),
    )
}

fn output_text(pipeline: &Pipeline, output: Thing) -> String {
    let Some(after) = to_frame::asked_for(pipeline, output) else { return format!("\"{output}\"") };
    let field = if let Thing::Image(_) = output { "image" } else { "buffer" };
    let after = if after.stages == Stages::COPY { "TransferSource" } else { "Sampled" };
    format!("({field}: \"{output}\", after: {after})")
}

fn image_text(number: usize, image: &Image, eyes: &str) -> String {
    let [width, height, depth] = image.extent;
    let mut text = format!("(name: \"i{number}\", format: {}, size: Fixed({width}, {height})", image.format);
    match image.shape {
        Shape::D2 => {}
        Shape::D3 => text += &format!(", shape: D3({depth})"),
        Shape::Cube => text += ", shape: Cube",
    }
    let layers = if image.shape == Shape::Cube { 1 } else { image.layers };
    for (field, count) in [("mips", image.mips), ("layers", layers), ("samples", image.samples)] {
        if count > 1 {
            text += &format!(", {field}: {count}");
        }
    }
    text += match image.resolve {
        None => "",
        Some(ResolveMode::SampleZero) => ", resolve: SampleZero",
        Some(ResolveMode::Min) => ", resolve: Min",
        Some(ResolveMode::Max) => ", resolve: Max",
        Some(ResolveMode::Average) => ", resolve: Average",
    };
    let layout = match to_frame::handed_in(number) {
        Layout::General => ", layout: GENERAL",
        _ => ", layout: TRANSFER_DST_OPTIMAL",
    };
    let initial = |value| fill(texels::fill(image.format, value), image.format);
    text + eyes + &life((image.life, number), layout, initial) + ")"
}

fn life((life, number): (Life, usize), layout: &str, initial: impl Fn(u8) -> String) -> String {
    let owner = match to_frame::owner(life, number) {
        None => "",
        Some(OutsideOwner::External) => ", owner: External",
        Some(OutsideOwner::Foreign) => ", owner: Foreign",
    };
    match life {
        Life::Transient => String::new(),
        Life::Persistent(value) => format!(", lifetime: Persistent(initial: {})", initial(value)),
        Life::History(frames, value) => {
            format!(", lifetime: History(frames: {frames}, initial: {})", initial(value))
        }
        Life::Target => format!(", lifetime: Imported(before: Undefined{owner})"),
        Life::Imported => {
            format!(", lifetime: Imported(before: (stages: [COPY], accesses: [TRANSFER_WRITE]{layout}){owner})")
        }
    }
}

/// A value for all texels.
fn fill(value: FillValue, format: Format) -> String {
    match value {
        FillValue::Color([r, g, b, a]) => format!("({r:?}, {g:?}, {b:?}, {a:?})"),
        FillValue::Bits([word, ..]) => word.to_string(),
        FillValue::Depth(depth, _) if !format.aspects().contains(Aspects::STENCIL) => format!("{depth:?}"),
        FillValue::Depth(depth, stencil) => format!("({depth:?}, {stencil})"),
    }
}

/// The fields that name a part of an image.
fn part(part: Part, wrapped: Option<&str>) -> String {
    let name = format!("\"i{}\"", part.image);
    let name = wrapped.map_or(name.clone(), |face| format!("{face}({name})"));
    let mut text = format!("image: {name}, mip: {}", part.mip);
    for (field, value, plain) in [("mips", part.mips, 1), ("layer", part.layer, u32::MAX), ("layers", part.layers, 1)] {
        if value != plain {
            text += &format!(", {field}: {value}");
        }
    }
    if part.plane != Plane::All {
        text += &format!(", plane: {:?}", part.plane);
    }
    text
}

fn region(of: Region) -> String {
    match of {
        Region::Image(image) => format!("({})", part(image, None)),
        Region::Buffer(buffer) => format!("\"b{buffer}\""),
    }
}

/// A region of an earlier frame.
fn region_of(of: Region, frames_ago: u32) -> String {
    match of {
        _ if frames_ago == 0 => region(of),
        Region::Image(image) => format!("({}, previous: {frames_ago})", part(image, None)),
        Region::Buffer(buffer) => format!("(buffer: \"b{buffer}\", previous: {frames_ago})"),
    }
}

fn pass_text(pipeline: &Pipeline, pass: &Pass) -> String {
    let mut fields = vec![format!("name: \"p{}\"", pass.number)];
    let shader = shader::shader(pipeline, pass);
    let name = shader.as_ref().map_or("", |shader| &shader.name);
    match &pass.work {
        Work::Draw(draw) => draw_fields(pipeline, draw, name, &mut fields),
        Work::Compute(compute) => {
            fields.push(format!("dispatch: \"{name}\""));
            fields.push(format!("groups: {}", groups(compute)));
        }
        Work::Copy { from, frames_ago, to } => {
            fields.push(format!("copy: (from: {}, to: {})", region_of(*from, *frames_ago), region(*to)));
        }
        Work::Blit { from, to } => {
            let [from, to] = [from, to].map(|image| region(Region::Image(*image)));
            fields.push(format!("blit: (from: {from}, to: {to}, filter: Nearest)"));
        }
        Work::Fill { to, value } => {
            let format = match to {
                Region::Image(part) => pipeline.images[part.image].format,
                Region::Buffer(_) => Format::R32_UINT,
            };
            let value = fill(to_frame::fill(pipeline, *to, *value), format);
            fields.push(format!("fill: (to: {}, value: {value})", region(*to)));
        }
        Work::Custom { from, to, .. } => {
            fields.push(format!("custom: \"custom\", writes: [{}]", region(*to)));
            fields.extend(from.map(|from| format!("reads: [{}]", region(from))));
        }
        Work::Forward { from, to } => {
            // Nobody looks for the shader of a pass that is off.
            fields.push("when: \"switch\", draw: FullScreen(\"none\")".to_owned());
            let depth = pipeline.images[*to].format.is_depth();
            fields.push(if depth { format!("depth: \"i{to}\"") } else { format!("color: [\"i{to}\"]") });
            fields.push(format!("otherwise: Forward(from: \"i{from}\", to: \"i{to}\")"));
        }
    }
    bindings(pass, &mut fields);
    if to_frame::both_eyes(pass) {
        fields.push("both_eyes: true".to_owned());
    }
    if pass.side_effect {
        fields.push("side_effect: true".to_owned());
    }
    if let Some(shader) = shader {
        let param = |(name, value): &(String, ParamValue)| format!("\"{name}\": {}", written(value));
        let params: Vec<String> = shader.params.iter().map(param).collect();
        fields.push(format!("params: {{{}}}", params.join(", ")));
    }
    format!("({})", fields.join(", "))
}

fn draw_fields(pipeline: &Pipeline, draw: &Draw, shader: &str, fields: &mut Vec<String>) {
    match draw.geometry {
        Geometry::FullScreen => fields.push(format!("draw: FullScreen(\"{shader}\")")),
        Geometry::Triangles { .. } if draw.custom => fields.push(format!("custom: \"{shader}\"")),
        Geometry::Triangles { count, vertices, indices } => {
            fields.push(match count {
                Count::Direct(triangles, instances) => format!("draw: Vertices({}, {instances})", 3 * triangles),
                Count::Indirect(buffer) => format!("draw: Indirect(\"b{buffer}\")"),
            });
            fields.push(format!("shader: \"{shader}\""));
            fields.extend(vertices.map(|buffer| format!("vertex: \"b{buffer}\"")));
            fields.extend(indices.map(|buffer| format!("index: \"b{buffer}\"")));
        }
    }
    let value = |image: usize, value: u8| {
        let format = pipeline.images[image].format;
        texels::float(format, texels::plain(format, value))
    };
    let color = draw.color.iter().map(|target| {
        let clear = target.clear.map(|clear| value(target.part.image, clear));
        let clear = clear.map_or(String::new(), |v| format!(", clear: ({v:?}, {v:?}, {v:?}, {v:?})"));
        let mask = match target.write_mask {
            ColorComponents::RGBA => String::new(),
            mask => {
                let channels = [ColorComponents::R, ColorComponents::G, ColorComponents::B, ColorComponents::A];
                let [r, g, b, a] = channels.map(|channel| mask.contains(channel));
                format!(", write_mask: ({r}, {g}, {b}, {a})")
            }
        };
        format!("({}{clear}, blend: {:?}{mask})", part(target.part, None), target.blend)
    });
    let color: Vec<String> = color.collect();
    if !color.is_empty() {
        fields.push(format!("color: [{}]", color.join(", ")));
    }
    fields.extend(draw.depth.map(|depth| {
        let clear = depth.clear.map(|clear| value(depth.part.image, clear));
        let clear = clear.map_or(String::new(), |value| format!(", clear: {value:?}"));
        let stencil = depth.stencil.map_or(String::new(), |stencil| {
            let StencilState { clear, test, reference, pass } = stencil;
            let clear = clear.map_or(String::new(), |value| format!("clear: {value}, "));
            format!(", stencil: ({clear}test: {test:?}, reference: {reference}, pass: {pass:?})")
        });
        let of = part(Part { plane: Plane::All, ..depth.part }, None);
        format!("depth: ({of}{clear}, test: {:?}, write: {}{stencil})", depth.test, depth.write)
    }));
}

fn groups(compute: &Compute) -> String {
    let [x, y, z] = compute.grid;
    match compute.groups {
        Groups::Cover => format!("Invocations({x}, {y}, {z})"),
        Groups::Count([x, y, z]) => format!("Count({x}, {y}, {z})"),
        Groups::Indirect(buffer, word) => format!("Indirect(\"b{buffer}\", {})", 4 * word),
    }
}

/// The images and buffers that the shader is given, by its names.
fn bindings(pass: &Pass, fields: &mut Vec<String>) {
    let (reads, stores) = valid::shader(pass);
    let (mut sample, mut storage, mut uniform) = (Vec::new(), Vec::new(), Vec::new());
    let ago = |frames: u32| if frames == 0 { String::new() } else { format!(", previous: {frames}") };
    for (number, read) in reads.iter().enumerate() {
        let name = format!("\"read{number}\"");
        match *read {
            Read::Sampled { part: of, frames_ago, per_sample } => {
                let face = per_sample.then_some("Samples");
                sample.push(format!("{name}: ({}{}, filter: Nearest)", part(of, face), ago(frames_ago)));
            }
            Read::Own(of) => sample.push(format!("{name}: ({}, filter: Nearest, own_pixel: true)", part(of, None))),
            Read::Storage(of) => storage.push(format!("{name}: ({}, access: Read)", part(of, None))),
            Read::Uniform(buffer, frames_ago) => {
                uniform.push(format!("{name}: (buffer: \"b{buffer}\"{})", ago(frames_ago)));
            }
            Read::Block(buffer, frames_ago) => {
                storage.push(format!("{name}: (buffer: \"b{buffer}\"{}, access: Read)", ago(frames_ago)));
            }
        }
    }
    for (number, Store { region, access }) in stores.iter().enumerate() {
        let access = if *access == StoreAccess::Write { "Write" } else { "ReadWrite" };
        let of = match region {
            Region::Image(of) => part(*of, None),
            Region::Buffer(buffer) => format!("buffer: \"b{buffer}\""),
        };
        storage.push(format!("\"store{number}\": ({of}, access: {access})"));
    }
    for (field, entries) in [("sample", sample), ("storage", storage), ("uniform", uniform)] {
        if !entries.is_empty() {
            fields.push(format!("{field}: {{{}}}", entries.join(", ")));
        }
    }
}

/// A parameter's value, numbers with all their digits.
fn written(value: &ParamValue) -> String {
    match value {
        ParamValue::Number(number) => format!("{number:?}"),
        ParamValue::Integer(_) | ParamValue::Bool(_) => value.to_string(),
        ParamValue::OfFrame(value) => format!("\"{}\"", value.word()),
        ParamValue::List(values) => format!("({})", values.iter().map(written).collect::<Vec<_>>().join(", ")),
    }
}
