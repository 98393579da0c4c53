//! Whether a device can do what a step does.

use crate::base::{Error, convert, named};
use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::frame::{Blend, EyeForm, Stereo};
use framewright_graph::plan::{Attachment, ImageId, Pass, Plan, RenderScope, Resource, Side, Step, Transfer, Work};
use framewright_graph::vulkan::{Aspects, Filter, Sampler, name_of};

/// A Plan that can't be executed.
pub(super) fn bad(what: String) -> Result<(), Error> {
    Err(Error::BadPlan { what })
}

/// Whether the device can execute such a step, on the queue that it names.
pub(crate) fn executable(gpu: &Gpu, plan: &Plan, step: &Step) -> Result<(), Error> {
    use vk::QueueFlags as Does;
    let needed = match &step.work {
        Work::Render(_) | Work::Resolve(_) | Work::Blit(_) => Does::GRAPHICS,
        Work::Dispatch(_) => Does::COMPUTE,
        Work::Fill(fill) => match fill.target.resource() {
            Resource::Image(image) if is_depth_stencil(plan.image(image).format.aspects()) => Does::GRAPHICS,
            Resource::Image(_) => Does::COMPUTE,
            Resource::Buffer(_) => Does::empty(),
        },
        Work::Copy(_) | Work::Custom(_) | Work::Export => Does::empty(),
    };
    let family = gpu.queues.families.family(step.queue);
    if !family.flags.contains(needed) {
        let (queue, device) = (name_of(&step.queue), &gpu.summary.name);
        let what = format!("a step needs {}, and the queue for {queue} on {device} lacks it", named(needed));
        return bad(what);
    }
    match &step.work {
        Work::Render(scope) => renderable(gpu, plan, scope),
        Work::Dispatch(pass) => filtered(gpu, plan, pass),
        Work::Blit(transfer) => blitted(gpu, plan, transfer),
        Work::Copy(_) | Work::Custom(_) | Work::Resolve(_) | Work::Fill(_) | Work::Export => Ok(()),
    }
}

/// Whether the device can render such a scope, blend and resolve its attachments, and filter what its passes sample.
fn renderable(gpu: &Gpu, plan: &Plan, scope: &RenderScope) -> Result<(), Error> {
    let limits = &gpu.limits;
    let [width, height, _] =
        EyeForm::extent(plan.eyes(scope), [scope.extent[0], scope.extent[1], 1], plan.rotation(scope));
    let fits = width <= limits.max_framebuffer_width.min(limits.max_viewport_dimensions[0])
        && height <= limits.max_framebuffer_height.min(limits.max_viewport_dimensions[1])
        && scope.layers <= limits.max_framebuffer_layers
        && scope.color().len() <= limits.max_color_attachments as usize;
    if !fits {
        let (count, layers) = (scope.color().len(), scope.layers);
        return bad(format!("{count} colour attachments of {width}×{height}, {layers} layers: too many or too large"));
    }
    let draws_so = match (plan.stereo, plan.eyes(scope)) {
        (_, None) => true,
        (Stereo::Multiview, Some(form)) => gpu.max_views >= 2 && form == EyeForm::Layers,
        // The features were looked at before.
        (Stereo::Instanced, Some(_)) => true,
        (Stereo::DoubleWide, Some(form)) => form == EyeForm::Halves,
        (Stereo::Off | Stereo::MultiPass, Some(_)) => false,
    };
    if !draws_so {
        return bad(format!("it draws for both eyes at once ({}) as {} can't", plan.stereo.name(), gpu.summary.name));
    }
    for pass in &scope.passes {
        for (attachment, _) in scope.color().iter().zip(&pass.blend).filter(|(_, blend)| **blend != Blend::Replace) {
            lacks(gpu, plan, attachment.image, vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND, "blend into")?;
        }
        filtered(gpu, plan, pass)?;
    }
    resolvable(gpu, plan, scope)
}

/// Whether the device can filter what a pass samples so.
fn filtered(gpu: &Gpu, plan: &Plan, pass: &Pass) -> Result<(), Error> {
    let linear = pass.accesses.iter().filter(|access| {
        let binding = access.binding.as_ref();
        binding.and_then(|it| it.kind.sampler()).is_some_and(Sampler::is_linear)
    });
    for access in linear {
        lacks(gpu, plan, access.image, vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR, "filter")?;
    }
    sampled(gpu, plan, pass)
}

/// Whether the device has the samplers of a pass.
fn sampled(gpu: &Gpu, plan: &Plan, pass: &Pass) -> Result<(), Error> {
    for access in &pass.accesses {
        let Some(sampler) = access.binding.as_ref().and_then(|it| it.kind.sampler()) else { continue };
        if *sampler == Sampler::new(sampler.filter) {
            continue;
        }
        let name = &plan.image(access.image).name;
        if let Some(what) = gpu.shader_limits().exceeded_by(sampler) {
            return bad(format!("`{name}`: {what}"));
        }
        if sampler.reduces() {
            lacks(gpu, plan, access.image, vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_MINMAX, "find the least of")?;
        }
    }
    Ok(())
}

/// Refuses a format without a feature.
fn lacks(gpu: &Gpu, plan: &Plan, image: ImageId, feature: vk::FormatFeatureFlags, what: &str) -> Result<(), Error> {
    let image = plan.image(image);
    if gpu.format_features(image.format).contains(feature) {
        return Ok(());
    }
    bad(format!("{} can't {what} `{}` ({})", gpu.summary.name, image.name, image.format))
}

/// Whether the device resolves depth and stencil so.
fn resolvable(gpu: &Gpu, plan: &Plan, scope: &RenderScope) -> Result<(), Error> {
    let modes = gpu.depth_stencil_resolve();
    let planes = [
        (scope.depth(), modes.supported_depth_resolve_modes, "depth"),
        (scope.stencil(), modes.supported_stencil_resolve_modes, "stencil"),
    ];
    for (attachment, supported, plane) in planes {
        let Some(resolve) = attachment.and_then(|it| it.resolve.as_ref()) else { continue };
        if !supported.contains(convert::resolve(resolve.mode)) {
            let target = &plan.image(resolve.image).name;
            let mode = name_of(&resolve.mode);
            return bad(format!("{} can't resolve {plane} into `{target}` by {mode}", gpu.summary.name));
        }
    }
    let mode = |attachment: Option<&Attachment>| attachment.and_then(|it| it.resolve.as_ref()).map(|it| it.mode);
    let together = scope.depth().is_some() && scope.stencil().is_some();
    let (depth, stencil) = (mode(scope.depth()), mode(scope.stencil()));
    let independent =
        if depth.is_none() || stencil.is_none() { modes.independent_resolve_none } else { modes.independent_resolve };
    if together && depth != stencil && independent == vk::FALSE {
        return bad(format!("{} resolves depth and stencil only together", gpu.summary.name));
    }
    Ok(())
}

/// Whether the device can scale between the formats.
fn blitted(gpu: &Gpu, plan: &Plan, transfer: &Transfer) -> Result<(), Error> {
    let (Side::Image { image: source, .. }, Side::Image { image: target, .. }) = (&transfer.source, &transfer.target)
    else {
        return bad("a blit names a buffer".to_owned());
    };
    lacks(gpu, plan, *source, vk::FormatFeatureFlags::BLIT_SRC, "blit from")?;
    lacks(gpu, plan, *target, vk::FormatFeatureFlags::BLIT_DST, "blit to")?;
    if transfer.filter == Some(Filter::Linear) {
        lacks(gpu, plan, *source, vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR, "filter")?;
    }
    Ok(())
}

/// Whether `aspects` hold a depth or stencil plane.
fn is_depth_stencil(aspects: Aspects) -> bool {
    aspects.intersects(Aspects::DEPTH | Aspects::STENCIL)
}
