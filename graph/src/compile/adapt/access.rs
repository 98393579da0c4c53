//! Which stages, accesses and layouts each use of an image or buffer takes.

use crate::compile::model::{AdaptedFrame, InitialContents, OpKind, PhysicalIndex, Role, Use};
use crate::frame::{
    Blend, BufferUse, ColorTarget, DeclaredUse, Image, Pass, Resource, SampledImage, Storage, TransferUse, Work,
};
use crate::vulkan::{AccessKind, Accesses, Aspects, Format, Layout, Stages, State};

/// A reading use of this kind, from which the others are made.
fn used(resource: PhysicalIndex, range: u32, role: Role, kind: AccessKind) -> Use {
    Use {
        resource,
        range,
        subresource: Use::SEVERAL,
        entry: 0,
        role,
        contents: InitialContents::Keep,
        reads: true,
        writes: false,
        layout: kind.layout(),
        stages: kind.stages(),
        accesses: kind.accesses(true, false),
    }
}

pub(super) fn sampled(sampled: &SampledImage, entry: u32, resource: PhysicalIndex, range: u32) -> Use {
    Use { entry, stages: sampled.stages, ..used(resource, range, Role::Sampled, AccessKind::Sampled) }
}

/// Gives depth that is an attachment somewhere the layouts in which it can be sampled and tested at once.
pub(super) fn settle_depth(adapted: &mut AdaptedFrame) {
    let attaches = |used: &Use| used.role.is_attachment() && !used.role.is_color();
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
        if used.role.is_sampled() && attached[used.resource as usize] && image.format.is_depth() {
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
    let (reads, writes, stages) = (storage.read, storage.write, storage.stages);
    let accesses = AccessKind::Storage.accesses(reads, writes);
    Use { entry, reads, writes, stages, accesses, ..used(resource, range, Role::Storage, AccessKind::Storage) }
}

pub(super) fn color(
    target: &ColorTarget,
    entry: u32,
    resource: PhysicalIndex,
    range: u32,
    contents: InitialContents,
) -> Use {
    let kind = AccessKind::ColorAttachment;
    let accesses = kind.accesses(target.blend != Blend::Replace, true);
    let reads = contents == InitialContents::Keep;
    Use { entry, contents, reads, writes: true, accesses, ..used(resource, range, Role::Color, kind) }
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
    let kind = AccessKind::DepthAttachment;
    // A draw that covers passes every depth test, so that nothing is read.
    let accesses = kind.accesses(contents != InitialContents::Discard, writes);
    let layout = if writes { attached(format, plane) } else { read_only(format, plane) };
    let reads = contents == InitialContents::Keep;
    Use { contents, reads, writes, layout, accesses, ..used(resource, range, role, kind) }
}

pub(super) fn buffer(buffer: &BufferUse, entry: u32, resource: PhysicalIndex) -> Use {
    let (reads, writes) = (buffer.role.reads(), buffer.role.writes());
    let kind = buffer.role.kind();
    let stages = if buffer.role.is_of_shaders() { buffer.stages } else { kind.stages() };
    let (layout, accesses) = (Layout::Undefined, kind.accesses(reads, writes));
    Use { entry, reads, writes, layout, stages, accesses, ..used(resource, Use::ALL, Role::Buffer, kind) }
}

/// The use of an image or buffer by a transfer.
pub(super) fn transfer(work: &Work, transfer: &TransferUse, entry: u32, resource: PhysicalIndex, range: u32) -> Use {
    let stages = work.transfer_stages();
    let made = if transfer.write { target(resource, range, stages) } else { source(resource, range, stages) };
    let layout = if let Resource::Buffer(_) = transfer.resource { Layout::Undefined } else { made.layout };
    Use { entry, layout, reads: made.reads || transfer.keeps, ..made }
}

/// The use of what a pass of the program reads and writes, of the two that it names.
pub(super) fn read_and_written(one: Use, other: &Use) -> Use {
    let layout = if one.layout == Layout::Undefined { Layout::Undefined } else { Layout::General };
    let (stages, accesses) = (one.stages | other.stages, one.accesses | other.accesses);
    Use { role: Role::Target, reads: true, writes: true, layout, stages, accesses, ..one }
}

/// Gives a use by a pass that the program records the stages, accesses and layout that the pass declares of it. What it doesn't declare
/// may be used by any command: indirect draws, builds of acceleration structures, mesh shaders. So all of them wait, and are waited for.
pub(super) fn by_program(used: &mut Use, pass: &Pass, images: &[Image]) {
    if used.role.is_attachment() {
        return;
    }
    if let Some((entry, declared)) = declared(used, pass, images) {
        let State { stages, accesses, layout } = declared.state;
        let [read, written] = [accesses - accesses.writes(), accesses.writes()];
        let accesses = match (used.reads, used.writes) {
            (true, false) => read,
            (false, true) => written,
            _ => accesses,
        };
        *used = Use { entry, role: Role::Declared, stages, accesses, layout, ..*used };
        return;
    }
    used.stages = Stages::ALL_COMMANDS;
    used.accesses.set(Accesses::MEMORY_READ, used.reads);
    used.accesses.set(Accesses::MEMORY_WRITE, used.writes);
}

/// The use that a pass declares of what a use of its own is about, and the place of that among the pass's accesses.
fn declared<'p>(used: &Use, pass: &'p Pass, images: &[Image]) -> Option<(u32, &'p DeclaredUse)> {
    if pass.uses.is_empty() {
        return None;
    }
    let entry = used.entry as usize;
    let of_targets = pass.color.len() + usize::from(pass.depth.is_some());
    let buffers = pass.sampled.len() + pass.storage.len() + of_targets;
    let at = match used.role {
        Role::Sampled => entry,
        Role::Storage => pass.sampled.len() + entry,
        Role::Buffer => buffers + entry,
        Role::Source | Role::Target => buffers + pass.buffers.len() + entry,
        Role::Input | Role::Color | Role::Depth | Role::Stencil | Role::Declared => return None,
    };
    let access = pass.accesses().nth(at)?;
    let image = access.image_index().and_then(|image| images.get(image.0 as usize));
    Some((at as u32, pass.declared_use(&access, image)?))
}

pub(super) fn source(resource: PhysicalIndex, range: u32, stages: Stages) -> Use {
    Use { stages, ..used(resource, range, Role::Source, AccessKind::TransferSource) }
}

pub(super) fn target(resource: PhysicalIndex, range: u32, stages: Stages) -> Use {
    let kind = AccessKind::TransferTarget;
    let accesses = kind.accesses(false, true);
    Use { reads: false, writes: true, stages, accesses, ..used(resource, range, Role::Target, kind) }
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
    let read = Use { stages: Stages::FRAGMENT_SHADER, ..used(source, Use::ALL, Role::Sampled, AccessKind::Sampled) };
    let write = Use {
        contents: InitialContents::Discard,
        reads: false,
        writes: true,
        accesses: AccessKind::ColorAttachment.accesses(false, true),
        ..used(target, Use::ALL, Role::Color, AccessKind::ColorAttachment)
    };
    [read, write]
}

/// Whether a pass with these uses draws colour into several samples.
pub(crate) fn has_samples(adapted: &AdaptedFrame, uses: &[Use]) -> bool {
    let mut colors = uses.iter().filter(|used| used.role.is_color());
    colors.any(|used| adapted.resources[used.resource as usize].image().is_some_and(|image| image.samples > 1))
}
