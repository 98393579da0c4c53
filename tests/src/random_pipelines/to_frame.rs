//! A random pipeline as the frame that a pipeline file would have become.

use super::pipeline::{
    self, Compute, Count, Draw, Geometry, Groups, Life, Part, Pass, Pipeline, Plane, Read, Region, StoreAccess, Thing,
    Work,
};
use super::{shader, texels, valid};
use crate::parts;
use framewright_graph::base::Span;
use framewright_graph::frame::{self, BufferIndex, BufferRole, BufferUse, Face, Frame, ImageIndex, Lifetime, Resource};
use framewright_graph::vulkan::{
    Accesses, FillValue, Filter, Format, Layout, OutsideOwner, Stages, State, Subresources,
};

/// The frame that `pipeline` says.
#[must_use]
pub fn to_frame(pipeline: &Pipeline) -> Frame {
    let mut frame = Frame::default();
    for (number, image) in pipeline.images.iter().enumerate() {
        let [width, height, _] = image.extent;
        frame.images.push(frame::Image {
            shape: image.shape,
            extent: image.extent,
            mips: image.mips,
            layers: image.layers,
            samples: image.samples,
            resolve: image
                .resolve
                .map(|mode| frame::Resolve { way: frame::ResolveWay::By(mode), because: "it says so".into() }),
            lifetime: lifetime((image.life, number), handed_in(number), |value| texels::fill(image.format, value)),
            ..frame::Image::new(&format!("i{number}"), image.format, width, height)
        });
    }
    for (number, buffer) in pipeline.buffers.iter().enumerate() {
        frame.buffers.push(frame::Buffer {
            name: format!("b{number}").into(),
            span: Span::NONE,
            bytes: 4 * u64::from(buffer.words),
            lifetime: lifetime((buffer.life, number), Layout::Undefined, |value| {
                FillValue::Bits([value.into(), 0, 0, 0])
            }),
        });
    }
    frame.passes = pipeline.passes.iter().map(|pass| to_pass(pipeline, pass)).collect();
    for output in &pipeline.outputs {
        let after = asked_for(pipeline, *output);
        frame.outputs.push(frame::Output { after, ..resource(*output).into() });
    }
    frame
}

/// The layout in which an imported image is handed in.
pub(super) const fn handed_in(image: usize) -> Layout {
    if image.is_multiple_of(2) { Layout::TransferDstOptimal } else { Layout::General }
}

/// Who else has an image or buffer between frames, as the pipeline says: of every third one that is imported.
pub(super) const fn owner(life: Life, number: usize) -> Option<OutsideOwner> {
    match life {
        Life::Imported | Life::Target if number % 3 == 1 => Some(OutsideOwner::External),
        Life::Transient | Life::Persistent(_) | Life::History(..) | Life::Imported | Life::Target => None,
    }
}

/// Whether the pipeline says of a pass that the program records it for both eyes at once: of every other one. It means nothing where one
/// eye is drawn for, so the frame that this module makes doesn't say it.
pub(super) const fn both_eyes(pass: &Pass) -> bool {
    let custom = match &pass.work {
        Work::Draw(draw) => draw.custom,
        Work::Custom { .. } => true,
        Work::Compute(_) | Work::Copy { .. } | Work::Blit { .. } | Work::Fill { .. } | Work::Forward { .. } => false,
    };
    custom && pass.number.is_multiple_of(2)
}

/// The state in which an output is asked for, if the pipeline says so: of every other one that lives no longer than it.
pub(super) fn asked_for(pipeline: &Pipeline, output: Thing) -> Option<State> {
    let copied = State { stages: Stages::COPY, accesses: Accesses::TRANSFER_READ, layout: Layout::TransferSrcOptimal };
    let sampled = State {
        stages: Stages::FRAGMENT_SHADER,
        accesses: Accesses::SHADER_SAMPLED_READ,
        layout: Layout::ShaderReadOnlyOptimal,
    };
    match output {
        Thing::Image(number) => {
            let pipeline::Image { format, life, .. } = pipeline.images[number];
            let state = if number.is_multiple_of(4) && !format.is_depth() { sampled } else { copied };
            (number.is_multiple_of(2) && life == Life::Transient).then_some(state)
        }
        Thing::Buffer(number) => {
            let asks = number.is_multiple_of(2) && pipeline.buffers[number].life == Life::Transient;
            asks.then_some(State { layout: Layout::Undefined, ..copied })
        }
    }
}

fn resource(thing: Thing) -> Resource {
    match thing {
        Thing::Image(image) => Resource::Image(ImageIndex(image as u32)),
        Thing::Buffer(buffer) => Resource::Buffer(BufferIndex(buffer as u32)),
    }
}

fn lifetime((life, number): (Life, usize), layout: Layout, initial: impl Fn(u8) -> FillValue) -> Lifetime {
    match life {
        Life::Transient => Lifetime::Transient,
        Life::Persistent(value) => Lifetime::Persistent { initial: initial(value) },
        Life::History(frames, value) => Lifetime::History { frames, initial: initial(value) },
        Life::Imported => {
            // As the program's own commands leave it.
            let before = State { stages: Stages::COPY, accesses: Accesses::TRANSFER_WRITE, layout };
            Lifetime::Imported { before, after: None, owner: owner(life, number) }
        }
        Life::Target => {
            let before = State { stages: Stages::COPY, accesses: Accesses::empty(), layout: Layout::Undefined };
            Lifetime::Imported { before, after: None, owner: owner(life, number) }
        }
    }
}

fn range(format: Format, part: Part) -> Subresources {
    let Part { mip, mips, layer, layers, plane, .. } = part;
    Subresources { aspects: plane.aspects(format), base_mip: mip, mips, base_layer: layer, layers }
}

fn to_pass(pipeline: &Pipeline, pass: &Pass) -> frame::Pass {
    let shader = shader::shader(pipeline, pass);
    let name = shader.as_ref().map_or("", |shader| &shader.name);
    let mut made = frame::Pass::new(&format!("p{}", pass.number), work(pipeline, pass, name));
    made.side_effect = pass.side_effect;
    if let Some(shader) = &shader {
        made.params = shader.params.iter().map(|(name, value)| (name.as_str().into(), value.clone())).collect();
    }
    let stages = if matches!(pass.work, Work::Draw(_)) { Stages::FRAGMENT_SHADER } else { Stages::COMPUTE_SHADER };
    let (reads, stores) = valid::shader(pass);
    let vertex_reads = if let Work::Draw(draw) = &pass.work { draw.vertex_reads } else { 0 };
    for (number, read) in reads.iter().enumerate() {
        let stages = if number < vertex_reads { Stages::VERTEX_SHADER } else { stages };
        add_read(pipeline, &mut made, &format!("read{number}"), *read, stages);
    }
    for (number, store) in stores.iter().enumerate() {
        let read = store.access != StoreAccess::Write;
        add_store(pipeline, &mut made, &format!("store{number}"), store.region, (read, true), stages);
    }
    match &pass.work {
        Work::Draw(draw) => add_attachments(pipeline, &mut made, draw),
        Work::Compute(Compute { groups: Groups::Indirect(buffer, _), .. }) => {
            made.buffers.push(fixed(*buffer, BufferRole::Indirect));
        }
        Work::Copy { from, frames_ago, to } => {
            let from = frame::TransferUse { frames_ago: *frames_ago, ..transfer(pipeline, *from, false) };
            made.transfers = vec![from, transfer(pipeline, *to, true)];
        }
        Work::Blit { from, to } => {
            let transfer = |part, write| transfer(pipeline, Region::Image(part), write);
            made.transfers = vec![transfer(*from, false), transfer(*to, true)];
        }
        Work::Fill { to, .. } => made.transfers = vec![transfer(pipeline, *to, true)],
        Work::Custom { from, to, .. } => {
            made.transfers = from.iter().map(|from| transfer(pipeline, *from, false)).collect();
            made.transfers.push(transfer(pipeline, *to, true));
        }
        Work::Compute(_) | Work::Forward { .. } => {}
    }
    made
}

fn work(pipeline: &Pipeline, pass: &Pass, shader: &str) -> frame::Work {
    match &pass.work {
        Work::Draw(draw) => frame::Work::Draw {
            draw: match draw.geometry {
                Geometry::FullScreen => frame::Draw::FullScreen,
                Geometry::Triangles { .. } if draw.custom => frame::Draw::Custom,
                Geometry::Triangles { count: Count::Direct(triangles, instances), .. } => {
                    frame::Draw::Vertices { count: 3 * triangles, instances }
                }
                Geometry::Triangles { count: Count::Indirect(_), .. } => frame::Draw::Indirect,
            },
            shader: shader.into(),
            discards: draw.discards,
            per_sample: draw.per_sample,
        },
        Work::Compute(compute) => frame::Work::Dispatch {
            shader: shader.into(),
            groups: match compute.groups {
                Groups::Count(groups) => frame::Groups::Count(groups),
                Groups::Cover => frame::Groups::Invocations(compute.grid),
                Groups::Indirect(_, word) => frame::Groups::Indirect { offset: 4 * u64::from(word) },
            },
        },
        Work::Copy { .. } => frame::Work::Copy,
        Work::Blit { .. } => frame::Work::Blit { filter: Filter::Nearest },
        Work::Fill { to, value } => frame::Work::Fill { value: fill(pipeline, *to, *value) },
        Work::Custom { .. } => frame::Work::Custom { callback: "custom".into() },
        Work::Forward { from, to } => frame::Work::Forward {
            from: ImageIndex(*from as u32),
            to: ImageIndex(*to as u32),
            because: "a switch = false".to_owned(),
        },
    }
}

/// The value that a fill sets its target to.
#[must_use]
pub fn fill(pipeline: &Pipeline, to: Region, value: u8) -> FillValue {
    match to {
        Region::Image(part) => match (texels::fill(pipeline.images[part.image].format, value), part.plane) {
            (FillValue::Depth(depth, _), Plane::Depth) => FillValue::Depth(depth, 0),
            (FillValue::Depth(_, stencil), Plane::Stencil) => FillValue::Depth(0.0, stencil),
            (value, _) => value,
        },
        Region::Buffer(_) => FillValue::Bits([value.into(), 0, 0, 0]),
    }
}

fn add_read(pipeline: &Pipeline, made: &mut frame::Pass, binding: &str, read: Read, stages: Stages) {
    let mut buffer = |buffer: usize, frames_ago, role| {
        let binding = Some(binding.into());
        made.buffers.push(BufferUse { binding, frames_ago, role, stages, ..fixed(buffer, role) });
    };
    match read {
        Read::Uniform(number, frames_ago) => buffer(number, frames_ago, BufferRole::Uniform),
        Read::Block(number, frames_ago) => {
            buffer(number, frames_ago, BufferRole::Storage { read: true, write: false });
        }
        Read::Storage(part) => add_store(pipeline, made, binding, Region::Image(part), (true, false), stages),
        Read::Sampled { part, frames_ago, per_sample } => {
            let sampled = sampled(pipeline, binding, part, stages);
            let face = if per_sample { Face::Samples } else { Face::Resolved };
            made.sampled.push(frame::SampledImage { frames_ago, face, ..sampled });
        }
        Read::Own(part) => {
            made.sampled.push(frame::SampledImage { own_pixel: true, ..sampled(pipeline, binding, part, stages) });
        }
    }
}

fn sampled(pipeline: &Pipeline, binding: &str, part: Part, stages: Stages) -> frame::SampledImage {
    let range = range(pipeline.images[part.image].format, part);
    frame::SampledImage { range, ..frame::SampledImage::new(binding, ImageIndex(part.image as u32), stages) }
}

fn add_store(
    pipeline: &Pipeline,
    made: &mut frame::Pass,
    binding: &str,
    region: Region,
    (read, write): (bool, bool),
    stages: Stages,
) {
    match region {
        Region::Image(part) => {
            let range = range(pipeline.images[part.image].format, part);
            let stored = parts::stored(binding, ImageIndex(part.image as u32), read);
            made.storage.push(frame::Storage { range, write, stages, ..stored });
        }
        Region::Buffer(buffer) => {
            let role = BufferRole::Storage { read, write };
            made.buffers.push(BufferUse { binding: Some(binding.into()), stages, ..fixed(buffer, role) });
        }
    }
}

/// A buffer that no shader names.
fn fixed(buffer: usize, role: BufferRole) -> BufferUse {
    let buffer = BufferIndex(buffer as u32);
    BufferUse { binding: None, buffer, frames_ago: 0, span: Span::NONE, role, stages: Stages::empty() }
}

fn add_attachments(pipeline: &Pipeline, made: &mut frame::Pass, draw: &Draw) {
    if let Geometry::Triangles { count, vertices, indices } = draw.geometry {
        made.buffers.extend(vertices.map(|buffer| fixed(buffer, BufferRole::Vertex)));
        made.buffers.extend(indices.map(|buffer| fixed(buffer, BufferRole::Index)));
        if let Count::Indirect(buffer) = count {
            made.buffers.push(fixed(buffer, BufferRole::Indirect));
        }
    }
    for pipeline::Target { part, clear, blend, write_mask } in &draw.color {
        let format = pipeline.images[part.image].format;
        made.color.push(frame::ColorTarget {
            image: ImageIndex(part.image as u32),
            range: range(format, *part),
            span: Span::NONE,
            clear: clear.map(|value| [texels::float(format, texels::plain(format, value)).into(); 4]),
            blend: *blend,
            write_mask: *write_mask,
        });
    }
    made.depth = draw.depth.map(|pipeline::DepthTarget { part, clear, test, write, stencil }| {
        let format = pipeline.images[part.image].format;
        frame::DepthTarget {
            image: ImageIndex(part.image as u32),
            range: range(format, Part { plane: Plane::All, ..part }),
            span: Span::NONE,
            clear: clear.map(|value| texels::float(format, texels::plain(format, value)).into()),
            test,
            write,
            stencil,
        }
    });
}

fn transfer(pipeline: &Pipeline, region: Region, write: bool) -> frame::TransferUse {
    let (thing, range) = match region {
        Region::Image(part) => (Thing::Image(part.image), range(pipeline.images[part.image].format, part)),
        Region::Buffer(buffer) => (Thing::Buffer(buffer), Subresources::WHOLE),
    };
    frame::TransferUse { resource: resource(thing), range, frames_ago: 0, span: Span::NONE, write, keeps: false }
}
