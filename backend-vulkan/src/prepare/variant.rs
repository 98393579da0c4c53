//! How a Plan has a pass's shader compiled, and what its pipeline must fit.

use crate::base::{Error, convert};
use crate::gpu::ScopeFormats;
use crate::pipeline::or_unused;
use ash::vk;
use framewright_graph::frame::{EyeForm, Stereo};
use framewright_graph::plan::{self, Attachment, BindingKind, Plan, RenderScope};
use framewright_graph::shader::{EyeSource, MOST_PARTS, Variant};

/// How the Plan has the shader of a pass compiled, which draws into images that hold both eyes' parts so.
pub(super) fn variant(plan: &Plan, pass: &plan::Pass, form: Option<EyeForm>) -> Result<Variant, Error> {
    let parts: Vec<_> = plan.parts(pass).map(|(name, _)| name.clone()).collect();
    if parts.len() > MOST_PARTS {
        let what = format!("it samples {} images in part, and can at most {MOST_PARTS}", parts.len());
        return Err(Error::Mismatch { pass: pass.name.to_string(), what });
    }

    let of_view = pass.view.and_then(|view| plan.views.get(view.0 as usize)?.eye);
    let eye = match (plan.stereo, form) {
        (Stereo::Multiview, Some(_)) => Some(EyeSource::ViewIndex),
        (Stereo::DoubleWide, Some(_)) => Some(EyeSource::InstanceBit),
        (_, Some(_)) => Some(EyeSource::InstanceParity),
        (_, None) => of_view.map(|of| EyeSource::One(of.eye)),
    };
    let eyes = pass.accesses.iter().filter_map(|access| {
        let binding = access.binding.as_ref().filter(|it| matches!(it.kind, BindingKind::Sampled(_)))?;
        Some((binding.name.clone(), plan.image(access.image).eyes?, access.eye))
    });
    let eyes = eyes.collect();
    let components = pass.accesses.iter().filter_map(|access| {
        Some((access.binding.as_ref()?.name.clone(), plan.image(access.image).format.components()))
    });
    let components = components.collect();
    let bindings = pass.accesses.iter().filter_map(|access| access.binding.as_ref());
    let sampled = bindings.clone().filter(|binding| binding.kind != BindingKind::Storage);
    let mut sampled: Vec<_> = sampled.map(|binding| binding.name.clone()).collect();
    Variant::name_arrays(&mut sampled);
    let local = bindings.clone().filter(|binding| binding.kind == BindingKind::InputAttachment);
    Ok(Variant {
        textures: bindings.filter_map(|it| Some((it.name.clone(), it.texture?))).collect(),
        sampled,
        components,
        parts,
        eye,
        form,
        eyes,
        local: local.map(|binding| binding.name.clone()).collect(),
        depth_only: pass.redraws.is_some(),
        alpha_to_coverage: pass.alpha_to_coverage,
    })
}

/// The views that a scope draws at once, a bit for each; 0 where it draws none but its own.
pub(crate) fn view_mask(plan: &Plan, scope: &RenderScope) -> u32 {
    if plan.stereo == Stereo::Multiview && plan.eyes(scope).is_some() { 0b11 } else { 0 }
}

/// What the pipelines of a scope must fit.
pub(crate) fn scope_formats(plan: &Plan, scope: &RenderScope) -> ScopeFormats {
    let format = |attachment: &Attachment| convert::format(plan.image(attachment.image).format);
    let or_none = |attachment: &Option<Attachment>| attachment.as_ref().map_or(vk::Format::UNDEFINED, format);
    ScopeFormats {
        color: or_unused(scope.color.iter().map(format)),
        depth: or_none(&scope.depth),
        stencil: or_none(&scope.stencil),
        samples: convert::samples(scope.samples),
        view_mask: view_mask(plan, scope),
    }
}
