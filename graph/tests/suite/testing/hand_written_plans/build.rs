//! Short forms for what the Plans have in common.

use super::lifetime;
use framewright_graph::base::Place;
use framewright_graph::frame::{Blend, BufferRole, Cadence, Draw, Groups, RasterState, Stereo};
use framewright_graph::plan::*;
use framewright_graph::vulkan::{
    self, Accesses, BufferUsage, Filter, Format, Layout, LoadOp, Rotation, Sampler, Shape, Sharing, Stages, StoreOp,
    Subresources, Usage,
};

/// A stage, an access and a layout.
pub(crate) type State = (Stages, Accesses, Layout);

pub(crate) const SIZE: [u32; 3] = [64, 32, 1];
pub(crate) const HEAP_ALIGNMENT: u64 = 4096;

pub(crate) const UNDEFINED: Layout = Layout::Undefined;
pub(crate) const COLOR: State =
    (Stages::COLOR_ATTACHMENT_OUTPUT, Accesses::COLOR_ATTACHMENT_WRITE, Layout::ColorAttachmentOptimal);
pub(crate) const SAMPLED: State =
    (Stages::FRAGMENT_SHADER, Accesses::SHADER_SAMPLED_READ, Layout::ShaderReadOnlyOptimal);
pub(crate) const READ_BACK: State = (Stages::COPY, Accesses::TRANSFER_READ, Layout::TransferSrcOptimal);
pub(crate) const TESTS: Stages = Stages::EARLY_FRAGMENT_TESTS.union(Stages::LATE_FRAGMENT_TESTS);

pub(crate) fn at(line: u32) -> Cause {
    Cause::Written(Some(Place { file: "pipeline.ron".into(), line, column: 9 }))
}

pub(crate) fn transient(
    id: u32,
    name: &str,
    format: Format,
    samples: u32,
    usage: Usage,
    [offset, bytes]: [u64; 2],
    [first, last]: [u32; 2],
) -> Image {
    let lifetime = lifetime(first, last);
    let placement = Placement { heap: 0, offset, bytes, alignment: 256, type_bits: 0b11, lifetime };
    Image { role: Role::Transient(placement), samples, ..output(id, name, format, usage) }
}

/// An output that is read back by a copy after each frame.
pub(crate) fn output(id: u32, name: &str, format: Format, usage: Usage) -> Image {
    let (stages, accesses, layout) = READ_BACK;
    Image {
        id: ImageId(id),
        name: name.into(),
        cause: at(4 + id),
        format,
        chosen: None,
        shape: Shape::D2,
        extent: SIZE,
        allocated: None,
        rotation: Rotation::Identity,
        eyes: None,
        mips: 1,
        layers: 1,
        samples: 1,
        usage,
        sharing: Sharing::Exclusive,
        role: Role::External {
            before: vulkan::State { stages: Stages::COPY, accesses: Accesses::empty(), layout: UNDEFINED },
            after: vulkan::State { stages, accesses, layout },
            owner: None,
        },
    }
}

pub(crate) fn range(format: Format) -> Subresources {
    Subresources::all(format, 1, 1)
}

pub(crate) fn barrier(
    image: &Image,
    (src_stages, src_accesses): (Stages, Accesses),
    old_layout: Layout,
    (dst_stages, dst_accesses, new_layout): State,
    hazard: Hazard,
    after: Option<u32>,
) -> ImageBarrier {
    ImageBarrier {
        image: image.id,
        range: range(image.format),
        src_stages,
        src_accesses,
        dst_stages,
        dst_accesses,
        old_layout,
        new_layout,
        ownership: None,
        hazard,
        after: after.map(StepId),
        needed_by: (hazard != Hazard::Export).then_some(StepId(after.map_or(0, |after| after + 1))),
    }
}

/// A barrier after everything that `from` stands for.
pub(crate) fn between(image: &Image, from: State, to: State, hazard: Hazard, after: u32) -> ImageBarrier {
    barrier(image, (from.0, from.1), from.2, to, hazard, Some(after))
}

pub(crate) fn access(image: &Image, (stages, accesses, layout): State) -> Access {
    Access {
        image: image.id,
        range: range(image.format),
        eye: None,
        stages,
        accesses,
        layout,
        binding: None,
        declared: false,
    }
}

/// A storage image by its shader's name.
pub(crate) fn storage(name: &str, image: &Image, state: State) -> Access {
    Access {
        binding: Some(Binding { name: name.into(), kind: BindingKind::Storage, texture: None }),
        ..access(image, state)
    }
}

/// A sampled image by its shader's name.
pub(crate) fn sampled(name: &str, image: &Image, state: State) -> Access {
    let kind = BindingKind::Sampled(Sampler::new(Filter::Nearest));
    Access { binding: Some(Binding { name: name.into(), kind, texture: None }), ..access(image, state) }
}

pub(crate) fn attachment(image: &Image, layout: Layout, load: LoadOp, store: StoreOp, because: &str) -> Attachment {
    let kind = if image.format.is_depth() { AttachmentKind::Depth } else { AttachmentKind::Color };
    Attachment {
        kind,
        image: image.id,
        range: range(image.format),
        layout,
        load,
        store,
        clear: (load == LoadOp::Clear).then_some([0.0; 4]),
        resolve: None,
        because: because.into(),
    }
}

pub(crate) fn draw(
    name: &str,
    line: u32,
    draw: Draw,
    blend: &[Blend],
    depth: Option<DepthState>,
    accesses: Vec<Access>,
) -> Pass {
    Pass {
        name: name.into(),
        cause: at(line),
        view: None,
        draw: Some(draw),
        groups: None,
        shader: name.into(),
        redraws: None,
        alpha_to_coverage: false,
        discards: false,
        untouched: None,
        covers: false,
        blend: blend.to_vec(),
        write_masks: Vec::new(),
        raster: RasterState::default(),
        depth,
        stencil: None,
        params: Vec::new(),
        constants: Vec::new(),
        accesses,
        buffers: Vec::new(),
        local_barrier: false,
        any_queue: false,
        both_eyes: false,
        merged: None,
    }
}

pub(crate) fn dispatch(name: &str, line: u32, accesses: Vec<Access>) -> Pass {
    Pass { draw: None, groups: Some(Groups::Count([8, 4, 1])), ..draw(name, line, Draw::Sky, &[], None, accesses) }
}

pub(crate) fn scope(samples: u32, color: Vec<Attachment>, depth: Option<Attachment>, passes: Vec<Pass>) -> Work {
    let attachments = color.into_iter().chain(depth).collect();
    let scope = RenderScope { extent: [SIZE[0], SIZE[1]], layers: 1, samples, attachments, passes };
    Work::Render(Box::new(scope))
}

pub(crate) fn step(image_barriers: Vec<ImageBarrier>, work: Work) -> Step {
    Step {
        queue: Queue::Graphics,
        run: Cadence::Always,
        waits: Vec::new(),
        memory_barriers: Vec::new(),
        image_barriers,
        work,
        releases: Vec::new(),
        outside: Vec::new(),
    }
}

/// A release or an acquiring barrier.
pub(crate) fn hand_over(queues: [Queue; 2], barrier: ImageBarrier) -> ImageBarrier {
    ImageBarrier { ownership: Some(queues), hazard: Hazard::Ownership, ..barrier }
}

pub(crate) fn wait(step: u32, frames_ago: u32, stages: Stages) -> Wait {
    Wait { step: StepId(step), frames_ago, stages }
}

/// A memory barrier for buffers.
pub(crate) fn memory(src: (Stages, Accesses), dst: (Stages, Accesses)) -> MemoryBarrier {
    let [(src_stages, src_accesses), (dst_stages, dst_accesses)] = [src, dst];
    MemoryBarrier { src_stages, src_accesses, dst_stages, dst_accesses, hand_overs: Vec::new(), buffers: Vec::new() }
}

pub(crate) fn buffer(id: u32, name: &str, bytes: u64, usage: BufferUsage, role: Role) -> Buffer {
    let sharing = Sharing::Exclusive;
    Buffer { id: BufferId(id), name: name.into(), cause: at(60 + id), bytes, usage, sharing, role }
}

/// A place in the second heap, that of buffers.
pub(crate) fn place([offset, bytes]: [u64; 2], [first, last]: [u32; 2]) -> Role {
    Role::Transient(Placement {
        heap: 1,
        offset,
        bytes,
        alignment: 256,
        type_bits: 0b11,
        lifetime: lifetime(first, last),
    })
}

/// A use of a buffer that no shader names.
pub(crate) fn fetch(buffer: &Buffer, role: BufferRole, stages: Stages, accesses: Accesses) -> BufferAccess {
    BufferAccess { buffer: buffer.id, role: Some(role), stages, accesses, binding: None, declared: false }
}

/// A storage buffer by its own name.
pub(crate) fn block(buffer: &Buffer, stages: Stages, read: bool, write: bool) -> BufferAccess {
    let of = |on: bool, access: Accesses| if on { access } else { Accesses::empty() };
    BufferAccess {
        buffer: buffer.id,
        role: Some(BufferRole::Storage { read, write }),
        stages,
        accesses: of(read, Accesses::SHADER_STORAGE_READ) | of(write, Accesses::SHADER_STORAGE_WRITE),
        binding: Some(buffer.name.clone()),
        declared: false,
    }
}

/// Adds buffers to a Plan: those that are external leave the frame; transient ones lie in a heap of their own.
pub(crate) fn with_buffers(mut plan: Plan, buffers: Vec<Buffer>, heap_bytes: u64) -> Plan {
    let external = buffers.iter().filter(|buffer| matches!(buffer.role, Role::External { .. }));
    plan.outputs.extend(external.map(|buffer| Output::new(&buffer.name, Resource::Buffer(buffer.id))));
    plan.buffers = buffers;
    plan.heaps.push(Heap { bytes: heap_bytes, ..plan.heaps[0].clone() });
    super::recount(&mut plan);
    plan
}

/// Samples `source` and covers the output, which the next step, the last, leaves to be read back.
pub(crate) fn tone_map(source: &Image, written: State, screen: &Image, step_number: u32) -> [Step; 2] {
    let mut pass = draw(
        "tonemap",
        40,
        Draw::FullScreen,
        &[Blend::Replace],
        None,
        vec![sampled("source", source, SAMPLED), access(screen, COLOR)],
    );
    pass.params = vec![Param { name: "white_point".into(), value: framewright_graph::frame::ParamValue::Number(0.1) }];
    let covered = attachment(screen, COLOR.2, LoadOp::DontCare, StoreOp::Store, "`tonemap` covers it; it is an output");
    let barriers = vec![
        between(source, written, SAMPLED, Hazard::ReadAfterWrite, step_number - 1),
        barrier(screen, (Stages::COPY, Accesses::empty()), UNDEFINED, COLOR, Hazard::FirstUse, None),
    ];
    [
        step(barriers, scope(1, vec![covered], None, vec![pass])),
        step(vec![between(screen, COLOR, READ_BACK, Hazard::Export, step_number)], Work::Export),
    ]
}

pub(crate) fn plan(images: Vec<Image>, heap_bytes: u64, steps: Vec<Step>) -> Plan {
    let outputs = images.iter().filter(|image| matches!(image.role, Role::External { .. }));
    let outputs = outputs.map(|image| Output::new(&image.name, Resource::Image(image.id))).collect();
    let heap = Heap { bytes: heap_bytes, alignment: HEAP_ALIGNMENT, type_bits: 0b1, lazily_allocated: false };
    let mut plan = Plan {
        format_version: FORMAT_VERSION,
        device: DeviceUsed { name: "made up".to_owned(), exact_memory: false },
        changes: Vec::new(),
        decided: [].into(),
        extent: [8, 8],
        stereo: Stereo::Off,
        views: Vec::new(),
        settings: vec![SettingUsed { name: "msaa".into(), value: "4".to_owned() }],
        images,
        buffers: Vec::new(),
        heaps: vec![heap],
        steps,
        outputs,
        notes: vec![Note {
            kind: NoteKind::OwnScope,
            subject: "tonemap".into(),
            text: "begins a scope of its own: it samples what the scope before it writes".to_owned(),
            at: Some(Place { file: "pipeline.ron".into(), line: 40, column: 9 }),
        }],
        totals: Totals { kept_bytes: 8192, ..Totals::default() },
    };
    super::recount(&mut plan);
    plan
}
