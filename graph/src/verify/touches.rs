//! Everything that a step's work does to images, as a list of accesses.
//!
//! Load, store and resolve operations become accesses in the stages that Vulkan gives them: colour operations and every
//! resolve, of depth too, in `COLOR_ATTACHMENT_OUTPUT`; depth loads in `EARLY_FRAGMENT_TESTS`, depth stores in
//! `LATE_FRAGMENT_TESTS`. A `DONT_CARE` load or store is a write; a `NONE` store is nothing.

use super::scopes::{PairSet, StageSet};
use crate::plan::{Access, Attachment, ImageId, RenderScope, Side, Step, Subresources, Transfer, Work};
use crate::vocabulary::{Accesses, Layout, LoadOp, Stages, StoreOp};

/// One access of a step's work.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub(super) image: ImageId,
    pub(super) range: Subresources,
    pub(super) layout: Layout,
    pub(super) stages: StageSet,
    pub(super) pairs: PairSet,
    /// Whether rasterisation order keeps it apart from other such accesses of its scope.
    pub(super) attachment: bool,
}

/// Accesses of images as attachments.
pub(super) const ATTACHMENT: Accesses = Accesses::COLOR_ATTACHMENT_READ
    .union(Accesses::COLOR_ATTACHMENT_WRITE)
    .union(Accesses::DEPTH_STENCIL_ATTACHMENT_READ)
    .union(Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE);

/// Lists what the work of `step` touches, in the order in which it happens.
pub(super) fn list(step: &Step, touches: &mut Vec<Touch>) {
    touches.clear();
    match &step.work {
        Work::Render(scope) => render(scope, touches),
        Work::Dispatch(pass) | Work::Custom(pass) => touches.extend(pass.accesses.iter().map(pass_access)),
        Work::Resolve(transfer) => both(transfer, Stages::RESOLVE, touches),
        Work::Copy(transfer) => both(transfer, Stages::COPY, touches),
        Work::Blit(transfer) => both(transfer, Stages::BLIT, touches),
        Work::Fill(fill) => side(&fill.target, Stages::CLEAR, Accesses::TRANSFER_WRITE, touches),
        Work::Export => {}
    }
}

fn both(transfer: &Transfer, stages: Stages, touches: &mut Vec<Touch>) {
    side(&transfer.source, stages, Accesses::TRANSFER_READ, touches);
    side(&transfer.target, stages, Accesses::TRANSFER_WRITE, touches);
}

fn side(side: &Side, stages: Stages, accesses: Accesses, touches: &mut Vec<Touch>) {
    if let Side::Image { image, range, layout, .. } = *side {
        touches.push(touch(image, range, layout, stages, accesses));
    }
}

fn render(scope: &RenderScope, touches: &mut Vec<Touch>) {
    let color = scope.color.iter().map(|attachment| (attachment, true));
    let attachments =
        || color.clone().chain(scope.depth.iter().chain(&scope.stencil).map(|attachment| (attachment, false)));
    for (attachment, is_color) in attachments() {
        let (stages, read, write) = if is_color { COLOR_LOAD } else { DEPTH_LOAD };
        let accesses = if attachment.load == LoadOp::Load { read } else { write };
        touches.push(of_attachment(attachment, stages, accesses));
    }
    for pass in &scope.passes {
        touches.extend(pass.accesses.iter().map(pass_access));
    }
    for (attachment, is_color) in attachments() {
        if let Some(resolve) = &attachment.resolve {
            let output = Stages::COLOR_ATTACHMENT_OUTPUT;
            touches.push(of_attachment(attachment, output, Accesses::COLOR_ATTACHMENT_READ));
            let write = Accesses::COLOR_ATTACHMENT_WRITE;
            touches.push(touch(resolve.image, resolve.range, resolve.layout, output, write));
        }
        if attachment.store != StoreOp::None {
            let (stages, write) = if is_color {
                (Stages::COLOR_ATTACHMENT_OUTPUT, Accesses::COLOR_ATTACHMENT_WRITE)
            } else {
                (Stages::LATE_FRAGMENT_TESTS, Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE)
            };
            touches.push(of_attachment(attachment, stages, write));
        }
    }
}

const COLOR_LOAD: (Stages, Accesses, Accesses) =
    (Stages::COLOR_ATTACHMENT_OUTPUT, Accesses::COLOR_ATTACHMENT_READ, Accesses::COLOR_ATTACHMENT_WRITE);
const DEPTH_LOAD: (Stages, Accesses, Accesses) =
    (Stages::EARLY_FRAGMENT_TESTS, Accesses::DEPTH_STENCIL_ATTACHMENT_READ, Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE);

fn of_attachment(attachment: &Attachment, stages: Stages, accesses: Accesses) -> Touch {
    touch(attachment.image, attachment.range, attachment.layout, stages, accesses)
}

fn pass_access(access: &Access) -> Touch {
    touch(access.image, access.range, access.layout, access.stages, access.accesses)
}

fn touch(image: ImageId, range: Subresources, layout: Layout, stages: Stages, accesses: Accesses) -> Touch {
    let attachment = accesses.intersects(ATTACHMENT);
    Touch { image, range, layout, stages: StageSet::of(stages), pairs: PairSet::of(stages, accesses), attachment }
}
