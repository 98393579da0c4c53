//! Whether a Plan can be executed on a device as it is.

use crate::convert;
use crate::device::Shared;
use crate::error::Error;
use crate::prepare::descriptor;
use ash::vk;
use framewright_graph::device::MemoryNeeds;
use framewright_graph::frame::Blend;
use framewright_graph::plan::{Image, ImageId, Placement, Plan, RenderScope, Role, Work};
use framewright_graph::verify::{Rule, Violation, verify};
use framewright_graph::vocabulary::{Filter, Usage};

/// Which of the Plan's own mistakes are refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Refuse {
    /// All.
    Violations,
    /// Those of form; hazards pass.
    Malformed,
}

/// Checks `plan` for itself and against the device; with `poison`, also that its images can be poisoned.
pub(crate) fn check(shared: &Shared, plan: &Plan, refuse: Refuse, poison: bool) -> Result<(), Error> {
    let refused = |it: &Violation| refuse == Refuse::Violations || matches!(it.rule, Rule::Structure { .. });
    let violations: Vec<_> = verify(plan).into_iter().filter(refused).collect();
    if !violations.is_empty() {
        return Err(Error::Violations { violations });
    }
    for image in &plan.images {
        supported(shared, image)?;
        match &image.role {
            Role::Transient(place) => {
                memory(shared, plan, image, place)?;
                if poison && !image.usage.contains(Usage::TRANSFER_DST) {
                    return bad(format!("`{}` can't be poisoned: compile the Plan with poison", image.name));
                }
            }
            Role::Output { .. } if image.samples > 1 => {
                return bad(format!("the output `{}` has {} samples and can't be read", image.name, image.samples));
            }
            Role::Output { .. } => {}
        }
    }
    for step in &plan.steps {
        if let Work::Render(scope) = &step.work {
            renderable(shared, plan, scope)?;
        }
    }
    let dispatched = plan.steps.iter().find_map(|step| match &step.work {
        Work::Dispatch(pass) => Some(&pass.name),
        _ => None,
    });
    match dispatched {
        Some(name) => bad(format!("pass `{name}` dispatches, and this version executes draws only")),
        None => Ok(()),
    }
}

fn bad(what: String) -> Result<(), Error> {
    Err(Error::BadPlan { what })
}

/// Whether the device can make such an image.
fn supported(shared: &Shared, image: &Image) -> Result<(), Error> {
    let descriptor = descriptor(image);
    if shared.can_make(&descriptor) {
        Ok(())
    } else {
        bad(format!("{} has no images like `{}`: {descriptor:?}", shared.summary.name, image.name))
    }
}

/// Whether the device can render such a scope, blend and resolve its attachments, and filter what its passes sample.
fn renderable(shared: &Shared, plan: &Plan, scope: &RenderScope) -> Result<(), Error> {
    let limits = &shared.limits;
    let [width, height] = scope.extent;
    let fits = width <= limits.max_framebuffer_width.min(limits.max_viewport_dimensions[0])
        && height <= limits.max_framebuffer_height.min(limits.max_viewport_dimensions[1])
        && scope.layers <= limits.max_framebuffer_layers
        && scope.color.len() <= limits.max_color_attachments as usize;
    if !fits {
        let (count, layers) = (scope.color.len(), scope.layers);
        return bad(format!("{count} colour attachments of {width}×{height}, {layers} layers: too many or too large"));
    }
    let lacks = |image: ImageId, feature: vk::FormatFeatureFlags, what: &str| {
        let image = plan.image(image);
        if shared.format_features(image.format).contains(feature) {
            return Ok(());
        }
        bad(format!("{} can't {what} `{}` ({})", shared.summary.name, image.name, image.format))
    };
    for pass in &scope.passes {
        for (attachment, _) in scope.color.iter().zip(&pass.blend).filter(|(_, blend)| **blend != Blend::Replace) {
            lacks(attachment.image, vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND, "blend into")?;
        }
        for bound in pass.bindings.iter().filter(|bound| bound.filter == Some(Filter::Linear)) {
            lacks(bound.image, vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR, "filter")?;
        }
    }
    match scope.depth.as_ref().and_then(|depth| depth.resolve.as_ref()) {
        Some(resolve) if !shared.depth_resolve_modes().contains(convert::resolve(resolve.mode)) => {
            let target = &plan.image(resolve.image).name;
            bad(format!("{} can't resolve depth into `{target}` by {:?}", shared.summary.name, resolve.mode))
        }
        _ => Ok(()),
    }
}

/// Whether the image takes here what the Plan gives it: exactly that, or where the Plan only estimated, not more.
fn memory(shared: &Shared, plan: &Plan, image: &Image, place: &Placement) -> Result<(), Error> {
    let actual = shared.memory_needs(&descriptor(image));
    let planned = MemoryNeeds { bytes: place.bytes, alignment: place.alignment, type_bits: place.type_bits };
    let heap_types = plan.heaps[place.heap as usize].type_bits;
    let enough = actual.bytes <= planned.bytes
        && place.offset.is_multiple_of(actual.alignment.max(1))
        && plan.heaps[place.heap as usize].alignment >= actual.alignment
        && heap_types & !actual.type_bits == 0;
    if actual == planned || (!plan.device.exact_memory && enough) {
        return Ok(());
    }
    Err(Error::OtherMemoryNeeds {
        image: image.name.to_string(),
        device: shared.summary.name.clone(),
        planned_for: plan.device.name.clone(),
        actual,
        planned,
    })
}
