//! Whether turned images are turned all along: nothing in a frame but a draw turns a picture, and shaders and copies take
//! their sources to be upright.

use super::findings::Findings;
use crate::plan::{Access, ImageId, Plan, RenderScope, Side, StepId, Transfer, Work};
use crate::vulkan::{Accesses, Rotation, Shape};

pub(super) fn check(plan: &Plan, found: &mut Findings<'_>) {
    if !plan.images.iter().any(|image| image.rotation.turns()) {
        return;
    }
    for image in plan.images.iter().filter(|image| image.rotation.turns()) {
        if image.shape != Shape::D2 || image.mips > 1 {
            found.structure(None, Some(image.id.0), "is rotated and isn't flat, or has several mip levels");
        }
    }
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        match &step.work {
            Work::Render(scope) => {
                one_rotation(plan, id, scope, found);
                for pass in &scope.passes {
                    read_upright(plan, id, &pass.accesses, found);
                }
            }
            Work::Dispatch(pass) => read_upright(plan, id, &pass.accesses, found),
            Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => {
                same_rotation(plan, id, transfer, found);
            }
            // A fill writes one value, so rotation doesn't matter. A program that records a custom pass handles rotation
            // itself.
            Work::Fill(_) | Work::Custom(_) | Work::Export => {}
        }
    }
}

/// All attachments of a scope, and the images that they are resolved into, are turned alike.
fn one_rotation(plan: &Plan, id: StepId, scope: &RenderScope, found: &mut Findings<'_>) {
    let images = scope.attachments.iter().flat_map(|attachment| {
        let resolved = attachment.resolve.as_ref().map(|resolve| resolve.image);
        std::iter::once(attachment.image).chain(resolved)
    });
    let mut first: Option<Rotation> = None;
    for image in images {
        let rotation = plan.image(image).rotation;
        if *first.get_or_insert(rotation) != rotation {
            found.structure(Some(id), Some(image.0), "is drawn beside an image that is rotated otherwise");
        }
    }
}

/// No shader looks texels up in a turned image, but at its own position in one that it is turned with.
fn read_upright(plan: &Plan, id: StepId, accesses: &[Access], found: &mut Findings<'_>) {
    let looked_up = Accesses::SHADER_SAMPLED_READ | Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE;
    for access in accesses.iter().filter(|access| access.accesses.intersects(looked_up)) {
        if plan.image(access.image).rotation.turns() {
            found.structure(Some(id), Some(access.image.0), "is rotated, and a shader takes it to be upright");
        }
    }
}

/// Copies and blits keep the rotation.
fn same_rotation(plan: &Plan, id: StepId, transfer: &Transfer, found: &mut Findings<'_>) {
    let rotation = |side: &Side| match side {
        Side::Image { image, .. } => (plan.image(*image).rotation, Some(*image)),
        Side::Buffer { .. } => (Rotation::Identity, None),
    };
    let ((from, source), (to, target)) = (rotation(&transfer.source), rotation(&transfer.target));
    if from != to {
        let image: Option<ImageId> = target.or(source);
        found.structure(Some(id), image.map(|image| image.0), "is copied, and rotated on only one side");
    }
}
