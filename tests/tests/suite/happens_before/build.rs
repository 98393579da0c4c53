//! Plans built by hand, step by step.

use crate::hand_written_plans::build;
use framewright_graph::frame::Stereo;
use framewright_graph::plan::{
    Access, Binding, BindingKind, DeviceUsed, FORMAT_VERSION, FirstContents, Hazard, Heap, Image, ImageBarrier,
    ImageId, Output, Placement, Plan, Resource, Role, Step, StepId, Totals, Work,
};
use framewright_graph::vulkan::{
    Accesses, FillValue, Filter, Format, Layout, Sampler, Stages, State, Subresources, Usage,
};

pub(crate) const R: Accesses = Accesses::SHADER_SAMPLED_READ;
pub(crate) const W: Accesses = Accesses::SHADER_STORAGE_WRITE;
pub(crate) const CS: Stages = Stages::COMPUTE_SHADER;
pub(crate) const NONE: (Stages, Accesses) = (Stages::empty(), Accesses::empty());
const FORMAT: Format = Format::R8G8B8A8_UNORM;
const BYTES: u64 = 16 * 16 * 4;

/// A Plan without images and steps.
pub(crate) fn empty() -> Plan {
    Plan {
        format_version: FORMAT_VERSION,
        device: DeviceUsed { name: "built by hand".to_owned(), exact_memory: true },
        settings: Vec::new(),
        changes: Vec::new(),
        decided: [].into(),
        extent: [4, 4],
        stereo: Stereo::Off,
        views: Vec::new(),
        images: Vec::new(),
        buffers: Vec::new(),
        heaps: vec![Heap { bytes: 8 * BYTES, alignment: 256, type_bits: 1, lazily_allocated: false }],
        steps: Vec::new(),
        outputs: Vec::new(),
        notes: Vec::new(),
        totals: Totals::default(),
    }
}

fn image(plan: &mut Plan, name: &str, role: Role) -> ImageId {
    let id = plan.images.len() as u32;
    let output = build::output(id, name, FORMAT, Usage::STORAGE | Usage::SAMPLED);
    plan.images.push(Image { extent: [16, 16, 1], role, ..output });
    ImageId(id)
}

/// A transient image in a place of its heap.
pub(crate) fn transient(plan: &mut Plan, name: &str, place: u64) -> ImageId {
    let lifetime = [StepId(0), StepId(0)];
    let placement = Placement { heap: 0, offset: place * BYTES, bytes: BYTES, alignment: 256, type_bits: 1, lifetime };
    image(plan, name, Role::Transient(placement))
}

/// An output that is left in `GENERAL`, last written by compute shaders.
pub(crate) fn output(plan: &mut Plan, name: &str) -> ImageId {
    let before = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::Undefined };
    let after = State { stages: CS, accesses: W, layout: Layout::General };
    let id = image(plan, name, Role::External { before, after, owner: None });
    plan.outputs.push(Output::new(name, Resource::Image(id)));
    id
}

/// An image that frames hand on in `GENERAL`; the next frame knows it as the image number `becomes`.
pub(crate) fn persistent(plan: &mut Plan, name: &str, becomes: u32) -> ImageId {
    let state = State { stages: CS, accesses: W, layout: Layout::General };
    image(
        plan,
        name,
        Role::Persistent {
            becomes,
            initial: FirstContents::Value(FillValue::Color([0.0; 4])),
            before: state,
            after: state,
        },
    )
}

/// An access of a compute pass: sampled in `SHADER_READ_ONLY_OPTIMAL`, or written in `GENERAL`.
pub(crate) fn access(image: ImageId, accesses: Accesses) -> Access {
    let (layout, kind) = match accesses {
        R => (Layout::ShaderReadOnlyOptimal, BindingKind::Sampled(Sampler::new(Filter::Nearest))),
        _ => (Layout::General, BindingKind::Storage),
    };
    let range = Subresources::all(FORMAT, 1, 1);
    let binding = Some(Binding { name: format!("i{}", image.0).into(), kind, texture: None });
    Access { image, range, eye: None, stages: CS, accesses, layout, binding, declared: false }
}

/// A dispatch with these accesses.
pub(crate) fn dispatch(name: &str, accesses: Vec<Access>) -> Step {
    build::step(Vec::new(), Work::Dispatch(build::dispatch(name, 1, accesses)))
}

/// A barrier that brings an image from one layout to another.
pub(crate) fn barrier(
    image: ImageId,
    layouts: [Layout; 2],
    (src_stages, src_accesses): (Stages, Accesses),
    (dst_stages, dst_accesses): (Stages, Accesses),
) -> ImageBarrier {
    let [old_layout, new_layout] = layouts;
    ImageBarrier {
        image,
        range: Subresources::all(FORMAT, 1, 1),
        src_stages,
        src_accesses,
        dst_stages,
        dst_accesses,
        old_layout,
        new_layout,
        ownership: None,
        hazard: Hazard::FirstUse,
        after: None,
        needed_by: Some(StepId(0)),
    }
}
