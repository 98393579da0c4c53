//! How a Plan has a pass's shader compiled, and what its pipeline must fit.

use crate::base::{Error, convert};
use crate::gpu::ScopeFormats;
use crate::pipeline::or_unused;
use ash::vk;
use framewright_graph::frame::Stereo;
use framewright_graph::plan::{self, Attachment, Plan, RenderScope};
use framewright_graph::shader::{MOST_PARTS, Variant};

/// How the Plan has the shader of a pass compiled, which is part of a rendering scope or, with `None`, a dispatch.
pub(super) fn variant(plan: &Plan, pass: &plan::Pass, scope: Option<&RenderScope>) -> Result<Variant, Error> {
    let variant = plan.variant(pass, scope);
    let parts = variant.parts.len();
    if parts > MOST_PARTS {
        let what = format!("it samples {parts} images in part, and can at most {MOST_PARTS}");
        return Err(Error::Mismatch { pass: pass.name.to_string(), what });
    }
    Ok(variant)
}

/// The views that a scope draws at once, a bit for each; 0 where it draws none but its own.
pub(crate) fn view_mask(plan: &Plan, scope: &RenderScope) -> u32 {
    if plan.stereo == Stereo::Multiview && plan.eyes(scope).is_some() { 0b11 } else { 0 }
}

/// What the pipelines of a scope must fit, apart from how its passes see the attachments.
pub(super) fn scope_formats(plan: &Plan, scope: &RenderScope) -> ScopeFormats {
    let format = |attachment: &Attachment| convert::format(plan.image(attachment.image).format);
    let or_none = |attachment: Option<&Attachment>| attachment.map_or(vk::Format::UNDEFINED, format);
    ScopeFormats {
        color: or_unused(scope.color().iter().map(format)),
        depth: or_none(scope.depth()),
        stencil: or_none(scope.stencil()),
        samples: convert::samples(scope.samples),
        view_mask: view_mask(plan, scope),
        local: None,
    }
}
