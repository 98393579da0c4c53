//! Whether images that hold both eyes' parts are used for both eyes at once, or by shaders that say which eye's part they read.

use super::findings::Findings;
use super::layers_of_eyes;
use crate::frame::{Draw, EyeForm, Stereo};
use crate::plan::{Access, ImageId, Plan, RenderScope, Side, StepId, Transfer, Work};
use crate::vulkan::{Accesses, Shape};

pub(super) fn check(plan: &Plan, found: &mut Findings<'_>) {
    claims(plan, found);
    if !plan.images.iter().any(|image| image.eyes.is_some()) {
        return;
    }
    for image in plan.images.iter().filter(|image| image.eyes.is_some()) {
        let forms: &[EyeForm] = match plan.stereo {
            Stereo::Off | Stereo::MultiPass => &[],
            Stereo::DoubleWide => &[EyeForm::Halves],
            Stereo::Instanced => &[EyeForm::Layers, EyeForm::Halves],
            Stereo::Multiview => &[EyeForm::Layers],
        };
        if !image.eyes.is_some_and(|form| forms.contains(&form)) {
            let how = plan.stereo.name();
            found.structure(None, Some(image.id.0), format!("holds both eyes' parts as `{how}` doesn't draw them"));
        }
        if image.shape != Shape::D2 || image.layers > 1 {
            found.structure(
                None,
                Some(image.id.0),
                "holds both eyes' parts, which aren't flat or have layers of their own",
            );
        }
        if image.eyes == Some(EyeForm::Halves) && image.mips > 1 {
            found.structure(None, Some(image.id.0), "holds both eyes' parts side by side, and has mip levels");
        }
    }
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        match &step.work {
            Work::Render(scope) => {
                all_or_none(plan, id, scope, found);
                let both = plan.eyes(scope).is_some();
                for pass in &scope.passes {
                    of_an_eye(plan, id, &pass.accesses, both, found);
                    let target = scope.attachments.first().map(|it| it.image.0);
                    if both && pass.draw.is_some_and(Draw::is_custom) && !pass.both_eyes {
                        let name = &pass.name;
                        let what = format!("holds both eyes' parts, and the program records `{name}` for one eye");
                        found.structure(Some(id), target, what);
                    }
                    if both && plan.stereo.is_by_instance() && pass.draw.is_some_and(Draw::is_indirect) {
                        let name = &pass.name;
                        let what =
                            format!("holds both eyes' parts, and `{name}` draws the instances that a buffer says");
                        found.structure(Some(id), target, what);
                    }
                }
            }
            Work::Custom(pass) if pass.both_eyes => named_eyes(plan, id, &pass.accesses, found),
            Work::Dispatch(pass) => {
                let (layers, others): (Vec<&Access>, Vec<&Access>) =
                    pass.accesses.iter().partition(|access| layers_of_eyes::stored(plan, access));
                of_an_eye(plan, id, others, false, found);
                let view = pass.view.and_then(|view| plan.views.get(view.0 as usize)?.eye).map(|of| of.eye);
                for access in layers.into_iter().filter(|access| view.is_some() && access.eye != view) {
                    found.structure(Some(id), Some(access.image.0), "is stored into in the layer of the other eye");
                }
            }
            Work::Custom(pass) => of_an_eye(plan, id, &pass.accesses, false, found),
            Work::Copy(transfer) | Work::Resolve(transfer) => same_on_both_sides(plan, id, transfer, found),
            Work::Blit(transfer) => {
                for side in [&transfer.source, &transfer.target] {
                    if let Side::Image { image, .. } = side
                        && plan.image(*image).eyes.is_some()
                    {
                        found.structure(Some(id), Some(image.0), "holds both eyes' parts and is scaled by a blit");
                    }
                }
            }
            Work::Fill(_) | Work::Export => {}
        }
    }
    layers_of_eyes::check(plan, found);
}

/// What says that a program records it for both eyes at once is recorded by one, in a scope of both if it draws.
fn claims(plan: &Plan, found: &mut Findings<'_>) {
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        let scope = step.work.scope();
        for pass in step.work.passes().iter().filter(|pass| pass.both_eyes) {
            let custom = step.work.is_custom() || pass.draw.is_some_and(Draw::is_custom);
            let name = &pass.name;
            if !custom {
                found.structure(Some(id), None, format!("`{name}` is recorded for both eyes, and by no program"));
            } else if let Some(scope) = scope
                && plan.eyes(scope).is_none()
            {
                let what =
                    format!("`{name}` is recorded for both eyes, and draws into nothing that holds both eyes' parts");
                found.structure(Some(id), None, what);
            } else if scope.is_none() && !of_both(plan, &pass.accesses) {
                let what =
                    format!("`{name}` is recorded for both eyes, and touches nothing that holds both eyes' parts");
                found.structure(Some(id), None, what);
            }
        }
    }
}

/// Whether accesses reach both eyes' parts of an image.
fn of_both(plan: &Plan, accesses: &[Access]) -> bool {
    accesses.iter().any(|access| access.eye.is_none() && plan.image(access.image).eyes.is_some())
}

/// All attachments of a scope, and the images that they are resolved into, hold both eyes' parts alike, or none does.
fn all_or_none(plan: &Plan, id: StepId, scope: &RenderScope, found: &mut Findings<'_>) {
    let images = scope.attachments.iter().flat_map(|attachment| {
        let resolved = attachment.resolve.as_ref().map(|resolve| resolve.image);
        std::iter::once(attachment.image).chain(resolved)
    });
    let mut first = None;
    for image in images {
        let eyes = plan.image(image).eyes;
        if *first.get_or_insert(eyes) != eyes {
            found.structure(Some(id), Some(image.0), "is drawn beside an image that holds both eyes' parts otherwise");
        }
    }
}

/// Shaders look up the part of an eye: their own if they draw for both, else one that is named.
fn of_an_eye<'p>(
    plan: &Plan,
    id: StepId,
    accesses: impl IntoIterator<Item = &'p Access> + Clone,
    both: bool,
    found: &mut Findings<'_>,
) {
    let stored = Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE;
    let moved = Accesses::TRANSFER_READ | Accesses::TRANSFER_WRITE;
    for access in accesses.clone().into_iter().filter(|access| plan.image(access.image).eyes.is_some()) {
        let image: ImageId = access.image;
        if access.accesses.intersects(stored | moved) {
            found.structure(Some(id), Some(image.0), "holds both eyes' parts, and a pass accesses it as one");
        } else if !both && access.eye.is_none() {
            found.structure(Some(id), Some(image.0), "holds both eyes' parts, and a pass doesn't say whose it reads");
        }
    }
    named_eyes(plan, id, accesses, found);
}

/// An eye is named of what holds both eyes' parts alone.
fn named_eyes<'p>(plan: &Plan, id: StepId, accesses: impl IntoIterator<Item = &'p Access>, found: &mut Findings<'_>) {
    for access in accesses.into_iter().filter(|access| access.eye.is_some()) {
        let image = Some(access.image.0);
        if plan.image(access.image).eyes.is_none() {
            found.structure(Some(id), image, "is no eye's, and a pass reads one eye's part of it");
        } else if access.accesses.intersects(Accesses::INPUT_ATTACHMENT_READ) {
            found.structure(
                Some(id),
                image,
                "is read at each fragment's own position, and one eye's part of it is meant",
            );
        }
    }
}

/// Copies and blits move both eyes' parts.
fn same_on_both_sides(plan: &Plan, id: StepId, transfer: &Transfer, found: &mut Findings<'_>) {
    let eyes = |side: &Side| match side {
        Side::Image { image, .. } => (plan.image(*image).eyes, Some(*image)),
        Side::Buffer { .. } => (None, None),
    };
    let ((from, source), (to, target)) = (eyes(&transfer.source), eyes(&transfer.target));
    if from != to {
        let image: Option<ImageId> = target.or(source);
        found.structure(Some(id), image.map(|image| image.0), "is copied, and holds both eyes' parts on only one side");
    }
}
