//! Plans written by hand, with the memory needs of the device that is here.

use framewright_graph::device::{ImageDescriptor, MemoryProvider};
use framewright_graph::frame::{Blend, Cadence, Draw, ParamValue, RasterState, Stereo};
use framewright_graph::plan::{
    Access, Attachment, AttachmentKind, AttachmentResolve, Binding, BindingKind, Cause, DeviceUsed, FORMAT_VERSION,
    Hazard, Heap, Image, ImageBarrier, ImageId, Output, Param, Pass, Placement, Plan, Queue, RenderScope, Resource,
    Role, Step, StepId, Totals, Work,
};
use framewright_graph::vulkan::{
    Accesses, Filter, Format, Layout, LoadOp, ResolveMode, Rotation, Sampler, Shape, Sharing, Stages, State, StoreOp,
    Subresources, Usage,
};
use framewright_vulkan::Device;

pub(crate) const FORMAT: Format = Format::R8G8B8A8_UNORM;
pub(crate) const EXTENT: [u32; 2] = [16, 4];
pub(crate) const MULTISAMPLED: ImageId = ImageId(0);
pub(crate) const RESOLVED: ImageId = ImageId(1);
pub(crate) const SCREEN: ImageId = ImageId(2);

const NONE: State = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::Undefined };
const DRAWN: State = State {
    stages: Stages::COLOR_ATTACHMENT_OUTPUT,
    accesses: Accesses::COLOR_ATTACHMENT_READ.union(Accesses::COLOR_ATTACHMENT_WRITE),
    layout: Layout::ColorAttachmentOptimal,
};
const SAMPLED: State = State {
    stages: Stages::FRAGMENT_SHADER,
    accesses: Accesses::SHADER_SAMPLED_READ,
    layout: Layout::ShaderReadOnlyOptimal,
};
const COPIED: State =
    State { stages: Stages::COPY, accesses: Accesses::TRANSFER_READ, layout: Layout::TransferSrcOptimal };

/// A scope clears a 4× image, draws `first` into it and resolves it; a second scope draws `second`, which samples the
/// result as `source` and takes the parameter `invert`, to the output.
pub(crate) fn resolve_then_sample(device: &Device, first: (&str, Draw), second: &str) -> Plan {
    let mut plan = Plan {
        format_version: FORMAT_VERSION,
        device: DeviceUsed { name: device.profile().name, exact_memory: true },
        settings: Vec::new(),
        changes: Vec::new(),
        decided: [].into(),
        extent: EXTENT,
        stereo: Stereo::Off,
        views: Vec::new(),
        images: Vec::new(),
        buffers: Vec::new(),
        heaps: vec![Heap { bytes: 0, alignment: 1, type_bits: u32::MAX, lazily_allocated: false }],
        steps: Vec::new(),
        outputs: vec![Output::new("screen", Resource::Image(SCREEN))],
        notes: Vec::new(),
        totals: Totals::default(),
    };
    // Images can be poisoned, so that the same Plan serves both ways.
    let usage = Usage::COLOR_ATTACHMENT | Usage::TRANSFER_DST;
    transient(&mut plan, device, "color", 4, usage, [StepId(0), StepId(0)]);
    transient(&mut plan, device, "color resolved", 1, usage | Usage::SAMPLED, [StepId(0), StepId(1)]);
    let role = Role::External { before: NONE, after: COPIED, owner: None };
    plan.images.push(image(SCREEN, "screen", 1, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC, role));

    let resolve = AttachmentResolve {
        image: RESOLVED,
        range: range(),
        layout: Layout::ColorAttachmentOptimal,
        mode: ResolveMode::Average,
        cause: Cause::Written(None),
    };
    let mut color = attachment(MULTISAMPLED, LoadOp::Clear, StoreOp::DontCare);
    color.clear = Some([0.0, 0.0, 1.0, 1.0]);
    color.resolve = Some(resolve);
    let barriers = vec![
        barrier(MULTISAMPLED, State { layout: Layout::Undefined, ..DRAWN }, DRAWN, Hazard::FirstUse),
        barrier(RESOLVED, State { layout: Layout::Undefined, ..SAMPLED }, DRAWN, Hazard::FirstUse),
    ];
    let drawn = pass("draw", first.0, first.1, MULTISAMPLED);
    plan.steps.push(render(barriers, 4, color, vec![drawn]));

    let mut shown = pass("show", second, Draw::FullScreen, SCREEN);
    let binding = Some(Binding {
        name: "source".into(),
        kind: BindingKind::Sampled(Sampler::new(Filter::Nearest)),
        texture: None,
    });
    shown.accesses.push(Access { binding, ..access(RESOLVED, SAMPLED) });
    shown.params.push(Param { name: "invert".into(), value: ParamValue::Bool(true) });
    let barriers = vec![
        barrier(RESOLVED, DRAWN, SAMPLED, Hazard::ReadAfterWrite),
        barrier(SCREEN, State { layout: Layout::Undefined, ..COPIED }, DRAWN, Hazard::FirstUse),
    ];
    plan.steps.push(render(barriers, 1, attachment(SCREEN, LoadOp::DontCare, StoreOp::Store), vec![shown]));

    let barriers = vec![barrier(SCREEN, DRAWN, COPIED, Hazard::Export)];
    plan.steps.push(step(barriers, Work::Export));
    add_up(&mut plan);
    plan
}

/// Sets the Plan's sums. All its images are alive at once.
pub(crate) fn add_up(plan: &mut Plan) {
    let transient_bytes = plan.images.iter().map(|image| match &image.role {
        Role::Transient(place) => place.bytes,
        Role::External { .. } | Role::Persistent { .. } => 0,
    });
    let transient_bytes = transient_bytes.sum();
    let placed_bytes = plan.heaps.iter().map(|heap| heap.bytes).sum();
    let live_peak_bytes = transient_bytes;
    plan.totals = Totals { transient_bytes, placed_bytes, live_peak_bytes, ..Totals::count(&plan.steps) };
}

/// All of a color image.
pub(crate) fn range() -> Subresources {
    Subresources::all(FORMAT, 1, 1)
}

fn image(id: ImageId, name: &str, samples: u32, usage: Usage, role: Role) -> Image {
    let extent = [EXTENT[0], EXTENT[1], 1];
    let cause = Cause::Written(None);
    Image {
        id,
        name: name.into(),
        cause,
        format: FORMAT,
        chosen: None,
        shape: Shape::D2,
        extent,
        allocated: None,
        rotation: Rotation::Identity,
        eyes: None,
        mips: 1,
        layers: 1,
        samples,
        usage,
        sharing: Sharing::Exclusive,
        role,
    }
}

fn transient(plan: &mut Plan, device: &Device, name: &str, samples: u32, usage: Usage, lifetime: [StepId; 2]) {
    let extent = [EXTENT[0], EXTENT[1], 1];
    let descriptor = ImageDescriptor {
        format: FORMAT,
        shape: Shape::D2,
        extent,
        mips: 1,
        layers: 1,
        samples,
        usage,
        sharing: Sharing::Exclusive,
    };
    let needs = device.memory().image(&descriptor);
    let heap = &mut plan.heaps[0];
    let offset = heap.bytes.next_multiple_of(needs.alignment);
    heap.bytes = offset + needs.bytes;
    heap.alignment = heap.alignment.max(needs.alignment);
    heap.type_bits &= needs.type_bits;
    let place = Placement {
        heap: 0,
        offset,
        bytes: needs.bytes,
        alignment: needs.alignment,
        type_bits: needs.type_bits,
        lifetime,
    };
    let id = ImageId(u32::try_from(plan.images.len()).expect("few images"));
    plan.images.push(image(id, name, samples, usage, Role::Transient(place)));
}

fn barrier(image: ImageId, from: State, to: State, hazard: Hazard) -> ImageBarrier {
    ImageBarrier {
        image,
        range: range(),
        src_stages: from.stages,
        src_accesses: from.accesses.writes(),
        dst_stages: to.stages,
        dst_accesses: to.accesses,
        old_layout: from.layout,
        new_layout: to.layout,
        ownership: None,
        hazard,
        after: None,
        needed_by: Some(StepId(0)),
    }
}

fn attachment(image: ImageId, load: LoadOp, store: StoreOp) -> Attachment {
    let layout = Layout::ColorAttachmentOptimal;
    let because = "the test says so".into();
    let kind = AttachmentKind::Color;
    Attachment { kind, image, range: range(), layout, load, store, clear: None, resolve: None, because }
}

fn access(image: ImageId, state: State) -> Access {
    Access {
        image,
        range: range(),
        eye: None,
        stages: state.stages,
        accesses: state.accesses,
        layout: state.layout,
        binding: None,
        declared: false,
    }
}

fn pass(name: &str, shader: &str, draw: Draw, target: ImageId) -> Pass {
    Pass {
        name: name.into(),
        cause: Cause::Written(None),
        view: None,
        draw: Some(draw),
        groups: None,
        shader: shader.into(),
        redraws: None,
        alpha_to_coverage: false,
        discards: false,
        untouched: None,
        covers: false,
        blend: vec![Blend::Replace],
        write_masks: Vec::new(),
        raster: RasterState::default(),
        depth: None,
        stencil: None,
        params: Vec::new(),
        constants: Vec::new(),
        accesses: vec![access(target, State { accesses: Accesses::COLOR_ATTACHMENT_WRITE, ..DRAWN })],
        buffers: Vec::new(),
        local_barrier: false,
        any_queue: false,
        both_eyes: false,
        merged: None,
    }
}

fn render(image_barriers: Vec<ImageBarrier>, samples: u32, color: Attachment, passes: Vec<Pass>) -> Step {
    let scope = RenderScope { extent: EXTENT, layers: 1, samples, attachments: vec![color], passes };
    step(image_barriers, Work::Render(Box::new(scope)))
}

fn step(image_barriers: Vec<ImageBarrier>, work: Work) -> Step {
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
