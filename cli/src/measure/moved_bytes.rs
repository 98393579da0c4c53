//! Bytes that a frame moves, after its Plan: what scopes load and store, and what resolves, copies and blits read and write.
//!
//! Samples, clears and fills aren't part of it, nor is what a device compresses or keeps in its caches.

use framewright_graph::plan::{Attachment, ImageId, Plan, Side, Work};
use framewright_graph::vulkan::{LoadOp, StoreOp, Subresources};

/// The sum over all steps.
#[must_use]
pub(crate) fn moved_bytes(plan: &Plan) -> u64 {
    let step = |work: &Work| match work {
        Work::Render(scope) => {
            let attachments = scope.color.iter().chain(&scope.depth).chain(&scope.stencil);
            attachments.map(|attachment| of_attachment(plan, attachment)).sum()
        }
        Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => {
            of_side(plan, transfer.source).saturating_add(of_side(plan, transfer.target))
        }
        Work::Fill(fill) => of_side(plan, fill.target),
        Work::Dispatch(_) | Work::Custom(_) | Work::Export => 0,
    };
    plan.steps.iter().map(|it| step(&it.work)).fold(0, u64::saturating_add)
}

fn of_attachment(plan: &Plan, attachment: &Attachment) -> u64 {
    let bytes = of_range(plan, attachment.image, attachment.range);
    let loaded = if attachment.load == LoadOp::Load { bytes } else { 0 };
    let stored = if attachment.store == StoreOp::Store { bytes } else { 0 };
    let resolved = attachment.resolve.as_ref().map_or(0, |resolve| of_range(plan, resolve.image, resolve.range));
    loaded.saturating_add(stored).saturating_add(resolved)
}

fn of_side(plan: &Plan, side: Side) -> u64 {
    match side {
        Side::Image { image, range, .. } => of_range(plan, image, range),
        Side::Buffer { bytes, .. } => bytes,
    }
}

/// Bytes of a part of an image, all samples among them.
fn of_range(plan: &Plan, image: ImageId, range: Subresources) -> u64 {
    let image = plan.image(image);
    let [width, height, depth] = image.made();
    let texel = image.format.plane_bytes(range.aspects).unwrap_or_else(|| image.format.texel_bytes());
    let mips = range.mips.min(image.mips.saturating_sub(range.base_mip));
    let layers = range.layers.min(image.made_layers().saturating_sub(range.base_layer));
    let mip =
        |mip: u32| [width, height, depth].iter().map(|side| u64::from((side >> mip.min(31)).max(1))).product::<u64>();
    let texels: u64 = (range.base_mip..range.base_mip + mips).map(mip).sum();
    texels.saturating_mul(texel).saturating_mul(u64::from(layers)).saturating_mul(image.samples.into())
}
