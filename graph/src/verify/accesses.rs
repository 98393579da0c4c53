//! Everything that a step's work does to images and buffers, as a list of accesses.
//!
//! Load, store and resolve operations become accesses in the stages that Vulkan gives them: colour operations and every
//! resolve, of depth too, in `COLOR_ATTACHMENT_OUTPUT`; depth loads in `EARLY_FRAGMENT_TESTS`, depth stores in
//! `LATE_FRAGMENT_TESTS`. A `DONT_CARE` load or store is a write; a `NONE` store is nothing.
//!
//! Beside each access stands its effect on contents. Only some accesses are sure to set all that they name: a `CLEAR`
//! load, a full-screen draw without blending, depth or stencil test to one layer whose shader is known to set all, or any draw
//! that is promised to, a resolve, a whole copy, and every write without attachments. Undefined contents stay so, in part, after any other.

use super::lookup::Scope;
use super::part_in_use::mip_extent;
use super::parts::overlap;
use super::program::Builder;
use super::scopes::{PairSet, StageSet};
use super::work::is_attached;
use crate::frame::{Blend, Draw};
use crate::plan::{self, Attachment, AttachmentKind, BufferId, ImageId, Pass, RenderScope, Side, Transfer, Work};
use crate::vulkan::{
    Accesses, BufferUsage, ColorComponents, CompareOp, CullMode, Layout, LoadOp, Stages, StencilOp, StoreOp,
    Subresources, Usage,
};

/// How an access is kept apart from others of its step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Not at all.
    Plain,
    /// As an attachment: by rasterisation order.
    Attachment,
    /// As an attachment that its own scope has drawn to, read at its own position: by barriers within the scope.
    Local,
}

/// Effects of an access on contents: any of these, in this order.
pub(super) mod does {
    /// Needs them.
    pub(crate) const READ: u8 = 1;
    /// Sets all of them.
    pub(crate) const FILL: u8 = 2;
    /// Writes some of them.
    pub(crate) const ADD: u8 = 4;
    /// Loses them at the beginning of a rendering scope.
    pub(crate) const NOT_LOAD: u8 = 8;
    /// Loses them at the end of a rendering scope.
    pub(crate) const NOT_STORE: u8 = 16;
    /// Loses the scope's writes, and keeps the contents before it.
    pub(crate) const STORE_NONE: u8 = 32;
}

/// An access to an image, before it is numbered.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImageAccess {
    pub(super) image: ImageId,
    pub(super) range: Subresources,
    pub(super) layout: Layout,
    pub(super) stages: StageSet,
    pub(super) pairs: PairSet,
    pub(super) kind: Kind,
    pub(super) contents: u8,
    /// The usage that the image must have been made with.
    pub(super) usage: Usage,
}

/// An access to a buffer, before it is numbered.
#[derive(Debug, Clone, Copy)]
pub(super) struct BufferAccess {
    pub(super) buffer: BufferId,
    pub(super) stages: StageSet,
    pub(super) pairs: PairSet,
    pub(super) contents: u8,
    /// The usage that the buffer must have been made with.
    pub(super) usage: BufferUsage,
}

/// Accesses of images as attachments.
pub(super) const ATTACHMENT: Accesses = Accesses::COLOR_ATTACHMENT_READ
    .union(Accesses::COLOR_ATTACHMENT_WRITE)
    .union(Accesses::DEPTH_STENCIL_ATTACHMENT_READ)
    .union(Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE);

/// Lists the accesses of `work`, in the order in which they happen.
pub(super) fn list(work: &Work, to: &mut Builder) {
    match work {
        Work::Render(scope) => render(scope, to),
        Work::Dispatch(pass) | Work::Custom(pass) => pass_accesses(pass, None, to),
        Work::Resolve(transfer) => both(transfer, Stages::RESOLVE, to),
        Work::Copy(transfer) => both(transfer, Stages::COPY, to),
        Work::Blit(transfer) => both(transfer, Stages::BLIT, to),
        Work::Fill(fill) => written(&fill.target, Stages::CLEAR, to),
        Work::Export => {}
    }
}

/// About how many accesses `work` makes.
pub(super) fn expected(work: &Work) -> usize {
    let of_pass = |pass: &Pass| pass.accesses.len() + pass.buffers.len();
    match work {
        Work::Render(scope) => 3 * scope.attachments.len() + scope.passes.iter().map(of_pass).sum::<usize>(),
        Work::Dispatch(pass) | Work::Custom(pass) => of_pass(pass),
        Work::Resolve(_) | Work::Copy(_) | Work::Blit(_) | Work::Fill(_) => 2,
        Work::Export => 0,
    }
}

fn both(transfer: &Transfer, stages: Stages, to: &mut Builder) {
    let access = Accesses::TRANSFER_READ;
    side(
        &transfer.source,
        stages,
        access,
        [Usage::TRANSFER_SRC.bits(), BufferUsage::TRANSFER_SRC.bits()],
        does::READ,
        to,
    );
    written(&transfer.target, stages, to);
}

/// The target of a transfer: a transfer that doesn't reach all of it leaves the rest as it was.
fn written(target: &Side, stages: Stages, to: &mut Builder) {
    let whole = match *target {
        Side::Image { image, range, extent, .. } => extent == mip_extent(to.plan.image(image), range.base_mip),
        Side::Buffer { buffer, bytes } => bytes == to.plan.buffers[buffer.0 as usize].bytes,
    };
    let contents = if whole { does::FILL } else { does::ADD };
    let usage = [Usage::TRANSFER_DST.bits(), BufferUsage::TRANSFER_DST.bits()];
    side(target, stages, Accesses::TRANSFER_WRITE, usage, contents, to);
}

fn side(side: &Side, stages: Stages, accesses: Accesses, usage: [u32; 2], contents: u8, to: &mut Builder) {
    let Scope { stages, pairs, .. } = to.scopes.of(stages, accesses);
    match *side {
        Side::Image { image, range, layout, .. } => {
            let usage = Usage::from_bits_truncate(usage[0]);
            to.image(ImageAccess { image, range, layout, stages, pairs, kind: Kind::Plain, contents, usage });
        }
        Side::Buffer { buffer, .. } => {
            let usage = BufferUsage::from_bits_truncate(usage[1]);
            to.buffer(BufferAccess { buffer, stages, pairs, contents, usage });
        }
    }
}

fn render(scope: &RenderScope, to: &mut Builder) {
    to.drawn.clear();
    let is_local =
        |attachment: &Attachment| matches!(attachment.layout, Layout::RenderingLocalReadKhr | Layout::General);
    let local = scope.attachments.iter().any(is_local);
    for attachment in &scope.attachments {
        let (stages, read, write) = if is_color(attachment) { COLOR_LOAD } else { DEPTH_LOAD };
        let (accesses, contents) = match attachment.load {
            LoadOp::Load => (read, does::READ),
            LoadOp::Clear => (write, does::FILL),
            LoadOp::DontCare => (write, does::NOT_LOAD),
        };
        if local && attachment.load != LoadOp::Load {
            to.drawn.push((attachment.image, attachment.range));
        }
        attached(attachment, stages, accesses, contents, to);
    }
    for pass in &scope.passes {
        pass_accesses(pass, Some(scope), to);
        if local {
            let writes =
                pass.accesses.iter().filter(|access| access.accesses.intersects(ATTACHMENT & Accesses::WRITES));
            for write in writes.filter(|access| is_attached(scope, access)).map(|access| (access.image, access.range)) {
                if !to.drawn.contains(&write) {
                    to.drawn.push(write);
                }
            }
        }
    }
    for attachment in &scope.attachments {
        if let Some(resolve) = &attachment.resolve {
            let output = Stages::COLOR_ATTACHMENT_OUTPUT;
            attached(attachment, output, Accesses::COLOR_ATTACHMENT_READ, does::READ, to);
            let part = (resolve.image, resolve.range, resolve.layout);
            part_attached(part, is_color(attachment), output, Accesses::COLOR_ATTACHMENT_WRITE, does::FILL, to);
        }
    }
    for attachment in &scope.attachments {
        let (stages, write) = if is_color(attachment) {
            (Stages::COLOR_ATTACHMENT_OUTPUT, Accesses::COLOR_ATTACHMENT_WRITE)
        } else {
            (Stages::LATE_FRAGMENT_TESTS, Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE)
        };
        let (stages, accesses, contents) = match attachment.store {
            StoreOp::Store => (stages, write, 0),
            StoreOp::DontCare => (stages, write, does::NOT_STORE),
            StoreOp::None => (Stages::empty(), Accesses::empty(), does::STORE_NONE),
        };
        attached(attachment, stages, accesses, contents, to);
    }
}

fn is_color(attachment: &Attachment) -> bool {
    attachment.kind == AttachmentKind::Color
}

const COLOR_LOAD: (Stages, Accesses, Accesses) =
    (Stages::COLOR_ATTACHMENT_OUTPUT, Accesses::COLOR_ATTACHMENT_READ, Accesses::COLOR_ATTACHMENT_WRITE);
const DEPTH_LOAD: (Stages, Accesses, Accesses) =
    (Stages::EARLY_FRAGMENT_TESTS, Accesses::DEPTH_STENCIL_ATTACHMENT_READ, Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE);

fn attached(attachment: &Attachment, stages: Stages, accesses: Accesses, contents: u8, to: &mut Builder) {
    let part = (attachment.image, attachment.range, attachment.layout);
    part_attached(part, is_color(attachment), stages, accesses, contents, to);
}

fn part_attached(
    (image, range, layout): (ImageId, Subresources, Layout),
    color: bool,
    stages: Stages,
    accesses: Accesses,
    contents: u8,
    to: &mut Builder,
) {
    let usage = if color { Usage::COLOR_ATTACHMENT } else { Usage::DEPTH_STENCIL_ATTACHMENT };
    let Scope { stages, pairs, .. } = to.scopes.of(stages, accesses);
    to.image(ImageAccess { image, range, layout, stages, pairs, kind: Kind::Attachment, contents, usage });
}

fn pass_accesses(pass: &Pass, scope: Option<&RenderScope>, to: &mut Builder) {
    for access in &pass.accesses {
        let plan::Access { image, range, layout, .. } = *access;
        let Scope { stages, pairs, mut usage, .. } = to.scopes.of(access.stages, access.accesses);
        let attachment = access.accesses.intersects(ATTACHMENT);
        let own = || to.drawn.iter().any(|(drawn, part)| *drawn == image && overlap(*part, range));
        let kind = match access.accesses {
            _ if attachment => Kind::Attachment,
            accesses if accesses.intersects(Accesses::INPUT_ATTACHMENT_READ) && own() => Kind::Local,
            _ => Kind::Plain,
        };
        let whole = |scope| if attachment { replaces(&to.plan.images, scope, pass, access) } else { true };
        let read = if pairs.reads().is_empty() { 0 } else { does::READ };
        let write = match (pairs.writes().is_empty(), scope) {
            (true, _) => 0,
            (false, None) => does::FILL,
            (false, Some(scope)) if whole(scope) => does::FILL,
            (false, Some(_)) => does::ADD,
        };
        if attachment {
            let depth = to.plan.image(image).format.is_depth();
            usage |= if depth { Usage::DEPTH_STENCIL_ATTACHMENT } else { Usage::COLOR_ATTACHMENT };
        }
        to.image(ImageAccess { image, range, layout, stages, pairs, kind, contents: read | write, usage });
    }
    for access in &pass.buffers {
        let plan::BufferAccess { buffer, stages, accesses, .. } = *access;
        let Scope { stages, pairs, .. } = to.scopes.of(stages, accesses);
        let read = if pairs.reads().is_empty() { 0 } else { does::READ };
        let write = if pairs.writes().is_empty() { 0 } else { does::FILL };
        let usage = buffer_usage(accesses);
        to.buffer(BufferAccess { buffer, stages, pairs, contents: read | write, usage });
    }
}

/// Whether a draw is sure to set every texel of its attachment.
fn replaces(images: &[plan::Image], scope: &RenderScope, pass: &Pass, access: &plan::Access) -> bool {
    let untested = pass.depth.is_none_or(|depth| depth.test == CompareOp::Always);
    let unmasked = pass.stencil.is_none_or(|stencil| stencil.test == CompareOp::Always);
    let same = |attachment: &Attachment| attachment.image == access.image && attachment.range == access.range;
    let deep = pass.depth.is_some_and(|depth| depth.write);
    let set = pass.stencil.is_some_and(|stencil| matches!(stencil.pass, StencilOp::Zero | StencilOp::Replace));
    let mut targets = scope.color().iter().enumerate().zip(&pass.blend);
    let passes = untested && unmasked;
    // A face that is left out leaves what was there; which one the screen's triangle shows is its shader's business.
    let culled = pass.raster.cull_mode.filter(|_| pass.raster.topology.has_faces()).unwrap_or(CullMode::None);
    let proven = pass.draw.is_some_and(Draw::is_full_screen) && !pass.discards && pass.untouched.is_none() && passes;
    let all_channels = |at: usize, target: &Attachment| {
        let has = ColorComponents::first(images[target.image.0 as usize].format.components());
        pass.write_masks.get(at).is_none_or(|mask| mask.contains(has))
    };
    scope.layers == 1
        && (proven && culled == CullMode::None || pass.covers && culled != CullMode::FrontAndBack)
        && (targets.any(|((at, target), blend)| same(target) && *blend == Blend::Replace && all_channels(at, target))
            || passes && deep && scope.depth().is_some_and(same)
            || passes && set && scope.stencil().is_some_and(same))
}

pub(super) fn buffer_usage(accesses: Accesses) -> BufferUsage {
    let storage = Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE;
    let addressed = BufferUsage::SHADER_DEVICE_ADDRESS;
    [
        (Accesses::UNIFORM_READ, BufferUsage::UNIFORM_BUFFER),
        (storage, BufferUsage::STORAGE_BUFFER),
        (Accesses::VERTEX_ATTRIBUTE_READ, BufferUsage::VERTEX_BUFFER),
        (Accesses::INDEX_READ, BufferUsage::INDEX_BUFFER),
        (Accesses::INDIRECT_COMMAND_READ, BufferUsage::INDIRECT_BUFFER),
        (Accesses::TRANSFER_READ, BufferUsage::TRANSFER_SRC),
        (Accesses::TRANSFER_WRITE, BufferUsage::TRANSFER_DST),
        (
            Accesses::ACCELERATION_STRUCTURE_READ_KHR | Accesses::ACCELERATION_STRUCTURE_WRITE_KHR,
            // The memory that a build works in is a storage buffer.
            BufferUsage::ACCELERATION_STRUCTURE_STORAGE_KHR | BufferUsage::STORAGE_BUFFER | addressed,
        ),
        (Accesses::SHADER_READ, BufferUsage::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR | addressed),
        (Accesses::SHADER_BINDING_TABLE_READ_KHR, BufferUsage::SHADER_BINDING_TABLE_KHR | addressed),
        // Whatever a program records with it.
        (Accesses::MEMORY_READ, BufferUsage::CORE.difference(BufferUsage::TRANSFER_DST)),
        (Accesses::MEMORY_WRITE, BufferUsage::STORAGE_BUFFER.union(BufferUsage::TRANSFER_DST)),
    ]
    .into_iter()
    .filter(|(those, _)| accesses.intersects(*those))
    .fold(BufferUsage::empty(), |all, (_, usage)| all | usage)
}
