//! Which stages, accesses and layouts each use of an image or buffer takes.

use crate::compile::model::{Adapted, InitialContents, OpKind, PhysicalIndex, Role, Use};
use crate::frame::{Blend, BufferRole, BufferUse, ColorTarget, Resource, Sampled, Storage, TransferUse, Work};
use crate::vulkan::{Accesses, Aspects, Format, Layout, Stages};

const DEPTH_TESTS: Stages = Stages::EARLY_FRAGMENT_TESTS.union(Stages::LATE_FRAGMENT_TESTS);

/// A reading use, from which the others are made.
fn used(resource: PhysicalIndex, range: u32, role: Role) -> Use {
    Use {
        resource,
        range,
        subresource: Use::SEVERAL,
        entry: 0,
        role,
        contents: InitialContents::Keep,
        reads: true,
        writes: false,
        layout: Layout::Undefined,
        stages: Stages::empty(),
        accesses: Accesses::empty(),
    }
}

pub(super) fn sampled(sampled: &Sampled, entry: u32, resource: PhysicalIndex, range: u32) -> Use {
    let (layout, accesses) = (Layout::ShaderReadOnlyOptimal, Accesses::SHADER_SAMPLED_READ);
    Use { entry, layout, stages: sampled.stages, accesses, ..used(resource, range, Role::Sampled) }
}

/// Gives depth that is an attachment somewhere the layouts in which it can be sampled and tested at once.
pub(super) fn settle_depth(adapted: &mut Adapted) {
    let attaches = |used: &Use| matches!(used.role, Role::Depth | Role::Stencil);
    if !adapted.uses.iter().any(attaches) {
        return;
    }
    let mut attached = vec![false; adapted.resources.len()];
    adapted.uses.iter().filter(|used| attaches(used)).for_each(|used| attached[used.resource as usize] = true);
    for op in adapted.ops.iter().filter(|op| matches!(op.kind, OpKind::Resolve { .. })) {
        // Depth is resolved where it is drawn, into an attachment.
        let uses = &adapted.uses[op.uses.start as usize..op.uses.end as usize];
        uses.iter().for_each(|used| attached[used.resource as usize] = true);
    }
    for at in 0..adapted.uses.len() {
        let used = &adapted.uses[at];
        let Some(image) = adapted.resources[used.resource as usize].image() else { continue };
        if used.role == Role::Sampled && attached[used.resource as usize] && image.format.is_depth() {
            let layout = read_only(image.format, adapted.range(used).aspects);
            adapted.uses[at].layout = layout;
        }
    }
}

/// The layout of planes that are attachments somewhere, where they are only read.
fn read_only(format: Format, planes: Aspects) -> Layout {
    match (format.aspects().contains(Aspects::STENCIL), planes == Aspects::STENCIL) {
        (false, _) => Layout::DepthStencilReadOnlyOptimal,
        (true, false) => Layout::DepthReadOnlyOptimal,
        (true, true) => Layout::StencilReadOnlyOptimal,
    }
}

/// The layout of a plane that is an attachment and written.
pub(crate) fn attached(format: Format, plane: Aspects) -> Layout {
    match (format.aspects().contains(Aspects::STENCIL), plane == Aspects::STENCIL) {
        (false, _) => Layout::DepthStencilAttachmentOptimal,
        (true, false) => Layout::DepthAttachmentOptimal,
        (true, true) => Layout::StencilAttachmentOptimal,
    }
}

pub(super) fn storage(storage: &Storage, entry: u32, resource: PhysicalIndex, range: u32) -> Use {
    let mut accesses = Accesses::empty();
    accesses.set(Accesses::SHADER_STORAGE_READ, storage.read);
    accesses.set(Accesses::SHADER_STORAGE_WRITE, storage.write);
    let (reads, writes, stages) = (storage.read, storage.write, storage.stages);
    Use { entry, reads, writes, layout: Layout::General, stages, accesses, ..used(resource, range, Role::Storage) }
}

pub(super) fn color(
    target: &ColorTarget,
    entry: u32,
    resource: PhysicalIndex,
    range: u32,
    contents: InitialContents,
) -> Use {
    let mut accesses = Accesses::COLOR_ATTACHMENT_WRITE;
    accesses.set(Accesses::COLOR_ATTACHMENT_READ, target.blend != Blend::Replace);
    let (stages, layout) = (Stages::COLOR_ATTACHMENT_OUTPUT, Layout::ColorAttachmentOptimal);
    let reads = contents == InitialContents::Keep;
    Use { entry, contents, reads, writes: true, layout, stages, accesses, ..used(resource, range, Role::Color) }
}

pub(super) fn depth(
    plane: Aspects,
    resource: PhysicalIndex,
    range: u32,
    contents: InitialContents,
    writes: bool,
    format: Format,
) -> Use {
    let role = if plane == Aspects::STENCIL { Role::Stencil } else { Role::Depth };
    let mut accesses = Accesses::empty();
    // A draw that covers passes every depth test, so that nothing is read.
    accesses.set(Accesses::DEPTH_STENCIL_ATTACHMENT_READ, contents != InitialContents::Discard);
    accesses.set(Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE, writes);
    let layout = if writes { attached(format, plane) } else { read_only(format, plane) };
    let reads = contents == InitialContents::Keep;
    Use { contents, reads, writes, layout, stages: DEPTH_TESTS, accesses, ..used(resource, range, role) }
}

pub(super) fn buffer(buffer: &BufferUse, entry: u32, resource: PhysicalIndex) -> Use {
    let (reads, writes) = (buffer.role.reads(), buffer.role.writes());
    let (stages, accesses) = match buffer.role {
        BufferRole::Uniform => (buffer.stages, Accesses::UNIFORM_READ),
        BufferRole::Storage { read, write } => {
            let mut accesses = Accesses::empty();
            accesses.set(Accesses::SHADER_STORAGE_READ, read);
            accesses.set(Accesses::SHADER_STORAGE_WRITE, write);
            (buffer.stages, accesses)
        }
        BufferRole::Vertex => (Stages::VERTEX_INPUT, Accesses::VERTEX_ATTRIBUTE_READ),
        BufferRole::Index => (Stages::VERTEX_INPUT, Accesses::INDEX_READ),
        BufferRole::Indirect => (Stages::DRAW_INDIRECT, Accesses::INDIRECT_COMMAND_READ),
    };
    Use { entry, reads, writes, stages, accesses, ..used(resource, Use::ALL, Role::Buffer) }
}

/// The use of an image or buffer by a transfer.
pub(super) fn transfer(work: &Work, transfer: &TransferUse, entry: u32, resource: PhysicalIndex, range: u32) -> Use {
    let stages = match work {
        Work::Blit { .. } => Stages::BLIT,
        Work::Fill { .. } => Stages::CLEAR,
        Work::Copy => Stages::COPY,
        _ => Stages::COPY | Stages::BLIT | Stages::CLEAR,
    };
    let made = if transfer.write { target(resource, range, stages) } else { source(resource, range, stages) };
    let layout = if let Resource::Buffer(_) = transfer.resource { Layout::Undefined } else { made.layout };
    Use { entry, layout, reads: made.reads || transfer.keeps, ..made }
}

/// Widens a use by a pass that the program records. The pass says what it reads and writes, not by which commands: indirect draws,
/// builds of acceleration structures, mesh shaders. So all of them wait, and are waited for.
pub(super) fn widen_for_program(used: &mut Use) {
    if used.role.is_attachment() {
        return;
    }
    used.stages = Stages::ALL_COMMANDS;
    used.accesses.set(Accesses::MEMORY_READ, used.reads);
    used.accesses.set(Accesses::MEMORY_WRITE, used.writes);
}

pub(super) fn source(resource: PhysicalIndex, range: u32, stages: Stages) -> Use {
    Use {
        layout: Layout::TransferSrcOptimal,
        stages,
        accesses: Accesses::TRANSFER_READ,
        ..used(resource, range, Role::Source)
    }
}

pub(super) fn target(resource: PhysicalIndex, range: u32, stages: Stages) -> Use {
    let accesses = Accesses::TRANSFER_WRITE;
    Use {
        reads: false,
        writes: true,
        layout: Layout::TransferDstOptimal,
        stages,
        accesses,
        ..used(resource, range, Role::Target)
    }
}

/// The stage in which an inserted transfer happens, if it is not folded into a scope.
pub(super) fn transfer_stage(kind: &OpKind) -> Stages {
    if matches!(kind, OpKind::Resolve { .. }) { Stages::RESOLVE } else { Stages::COPY }
}

/// The uses of a full-screen draw that resolves depth into another image.
pub(super) fn resolve_draw(source: PhysicalIndex, target: PhysicalIndex, range: u32, format: Format) -> [Use; 2] {
    let [read, _] = forward_draw(source, target);
    let write = depth(Aspects::DEPTH, target, range, InitialContents::Discard, true, format);
    [Use { range, ..read }, write]
}

/// The uses of a full-screen draw of one image into another.
pub(super) fn forward_draw(source: PhysicalIndex, target: PhysicalIndex) -> [Use; 2] {
    let read = Use {
        layout: Layout::ShaderReadOnlyOptimal,
        stages: Stages::FRAGMENT_SHADER,
        accesses: Accesses::SHADER_SAMPLED_READ,
        ..used(source, Use::ALL, Role::Sampled)
    };
    let write = Use {
        contents: InitialContents::Discard,
        reads: false,
        writes: true,
        layout: Layout::ColorAttachmentOptimal,
        stages: Stages::COLOR_ATTACHMENT_OUTPUT,
        accesses: Accesses::COLOR_ATTACHMENT_WRITE,
        ..used(target, Use::ALL, Role::Color)
    };
    [read, write]
}

/// Whether a pass with these uses draws colour into several samples.
pub(crate) fn has_samples(adapted: &Adapted, uses: &[Use]) -> bool {
    let mut colors = uses.iter().filter(|used| used.role == Role::Color);
    colors.any(|used| adapted.resources[used.resource as usize].image().is_some_and(|image| image.samples > 1))
}
