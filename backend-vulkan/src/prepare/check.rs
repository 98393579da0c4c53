//! Whether a Plan can be executed on a device as it is.

use super::check_steps::{bad, executable};
use super::descriptions::{buffer_descriptor, cycle, descriptor};
use super::textures::file_of;
use crate::base::{Error, by};
use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::base::amount;
use framewright_graph::device::{ImageDescriptor, Limit, MemoryNeeds};
use framewright_graph::plan::{Buffer, Image, Placement, Plan, Resource, Role, UsedFeature};
use framewright_graph::verify::{Rule, Violation, verify};
use framewright_graph::vulkan::{BufferUsage, OutsideOwner, Usage, name_of};

/// The Plan's own mistakes that are refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Refusals {
    /// All mistakes.
    Violations,
    /// Mistakes of form; hazards pass.
    Malformed,
}

/// Checks `plan` for itself.
pub(crate) fn check_alone(plan: &Plan, refuse: Refusals) -> Result<(), Error> {
    let refused = |it: &Violation| refuse == Refusals::Violations || matches!(it.rule, Rule::Structure { .. });
    let violations: Vec<_> = verify(plan).into_iter().filter(refused).collect();
    if violations.is_empty() { Ok(()) } else { Err(Error::Violations { violations }) }
}

/// Checks `plan` for itself and against the device; with `poison`, also that its images and buffers can be poisoned.
pub(crate) fn check(gpu: &Gpu, plan: &Plan, refuse: Refusals, poison: bool) -> Result<(), Error> {
    check_alone(plan, refuse)?;
    features(gpu, plan)?;
    for image in &plan.images {
        checked_image(gpu, plan, image, poison)?;
    }
    for buffer in &plan.buffers {
        checked_buffer(gpu, plan, buffer, poison)?;
    }
    for (index, heap) in plan.heaps.iter().enumerate() {
        if heap.lazily_allocated && heap.type_bits & gpu.lazy_types() == 0 {
            return bad(format!("heap {index} is lazily allocated, and {} has no such memory", gpu.summary.name));
        }
    }
    let images = plan.images.iter().map(|image| (&image.name, &image.role));
    for (name, role) in images.chain(plan.buffers.iter().map(|buffer| (&buffer.name, &buffer.role))) {
        if let Some(owner) = role.owner()
            && let Some(what) = refused_owner(gpu, name, owner)
        {
            return bad(what);
        }
    }
    all_memory(gpu, plan)?;
    plan.steps.iter().try_for_each(|step| executable(gpu, plan, step))
}

fn checked_image(gpu: &Gpu, plan: &Plan, image: &Image, poison: bool) -> Result<(), Error> {
    let (name, descriptor) = (&image.name, descriptor(image));
    if !gpu.can_make(&descriptor) {
        let ImageDescriptor { format, shape, extent, mips, layers, samples, usage, .. } = descriptor;
        return bad(format!(
            "{} has no images like `{name}`: {format}, {} texels ({}), {mips} mip levels, {layers} layers, {samples} samples, \
             used as {}",
            gpu.summary.name,
            by(extent),
            name_of(&shape),
            name_of(&usage)
        ));
    }
    match &image.role {
        Role::Transient(place) => {
            memory(gpu, plan, name, place, gpu.memory_needs(&descriptor))?;
            if poison && !image.usage.contains(Usage::TRANSFER_DST) {
                return bad(format!("`{name}` can't be poisoned: compile the Plan with poison"));
            }
            Ok(())
        }
        Role::Persistent { .. } => {
            let smaller = vk::FormatFeatureFlags::BLIT_SRC
                | vk::FormatFeatureFlags::BLIT_DST
                | vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
            if file_of(image).is_some_and(|file| !file.stored)
                && image.mips > 1
                && !gpu.format_features(image.format).contains(smaller)
            {
                return bad(format!("{} can't make the mip levels of `{name}`: {}", gpu.summary.name, image.format));
            }
            let plain = |image: &Image| ImageDescriptor { usage: Usage::empty(), ..self::descriptor(image) };
            let others = cycle(image.id.0, |id| &plan.images[id as usize].role).map(|id| &plan.images[id as usize]);
            match others.into_iter().find(|other| plain(other) != plain(image)) {
                Some(other) => bad(format!("`{name}` and `{}` change places and differ", other.name)),
                None => Ok(()),
            }
        }
        Role::External { .. }
            if image.samples > 1 && plan.outputs.iter().any(|it| it.resource == Resource::Image(image.id)) =>
        {
            bad(format!("the output `{name}` has {} samples and can't be read", image.samples))
        }
        Role::External { .. } => Ok(()),
    }
}

fn checked_buffer(gpu: &Gpu, plan: &Plan, buffer: &Buffer, poison: bool) -> Result<(), Error> {
    let (name, descriptor) = (&buffer.name, buffer_descriptor(buffer));
    let limits = gpu.shader_limits();
    // Usage says less: what a custom pass reads may be used in any way.
    let accesses = plan.steps.iter().flat_map(|step| step.work.passes()).flat_map(|pass| &pass.buffers);
    let bound = accesses.filter(|access| access.buffer == buffer.id).filter_map(|access| Some(access.role?.limit()?.0));
    let exceeds = |limit: &Limit| buffer.bytes > limits.of(*limit);
    let is_small = ![Limit::UniformBytes, Limit::StorageBytes, Limit::BufferBytes].iter().any(exceeds);
    let exceeded = if is_small { None } else { [Limit::BufferBytes].into_iter().chain(bound).find(exceeds) };
    if let Some(limit) = exceeded {
        let (device, most) = (&gpu.summary.name, limits.of(limit));
        return bad(format!("`{name}` has {} bytes; {device} allows {most} ({})", buffer.bytes, limit.name()));
    }
    if !gpu.can_make_buffer(&descriptor) {
        let (device, bytes, usage) = (&gpu.summary.name, buffer.bytes, name_of(&buffer.usage));
        return bad(format!("{device} has no buffers like `{name}`: {bytes} bytes, used as {usage}"));
    }
    match &buffer.role {
        Role::Transient(place) => {
            memory(gpu, plan, name, place, gpu.buffer_memory_needs(&descriptor))?;
            if poison && !buffer.usage.contains(BufferUsage::TRANSFER_DST) {
                return bad(format!("`{name}` can't be poisoned: compile the Plan with poison"));
            }
            Ok(())
        }
        Role::Persistent { .. } | Role::External { .. } => Ok(()),
    }
}

/// Whether the device has the memory that the Plan takes altogether. The allocator says so of each piece alone, but software
/// drivers promise all of the machine's memory for each piece.
fn all_memory(gpu: &Gpu, plan: &Plan) -> Result<(), Error> {
    let placed = |role: &Role| role.placement().map(|place| place.bytes);
    let of_image = |image: &Image| {
        let bytes = placed(&image.role).unwrap_or_else(|| gpu.memory_needs(&descriptor(image)).bytes);
        (image.name.to_string(), bytes)
    };
    let of_buffer = |buffer: &Buffer| (buffer.name.to_string(), placed(&buffer.role).unwrap_or(buffer.bytes));
    let parts: Vec<(String, u64)> =
        plan.images.iter().map(of_image).chain(plan.buffers.iter().map(of_buffer)).collect();
    // Those that are placed share heaps; all others have memory of their own.
    let images = plan.images.iter().map(|image| &image.role);
    let roles = images.chain(plan.buffers.iter().map(|buffer| &buffer.role));
    let kept = roles.zip(&parts).filter(|(role, _)| placed(role).is_none()).map(|(_, (_, bytes))| *bytes);
    let bytes = plan.heaps.iter().map(|heap| heap.bytes).chain(kept).fold(0, u64::saturating_add);
    let all = gpu.all_heaps();
    if bytes <= all {
        return Ok(());
    }
    let reason = format!("the device has {}", amount::bytes(all));
    Err(Error::OutOfMemory { what: "the Plan".to_owned(), bytes, parts, reason })
}

/// Whether the device has the features that the Plan uses. Those of its shaders are looked at where these are compiled.
fn features(gpu: &Gpu, plan: &Plan) -> Result<(), Error> {
    let has = |it: &UsedFeature| match it.name {
        UsedFeature::SWAPCHAIN => gpu.presents,
        name => gpu.features.has(name),
    };
    let missing: Vec<_> = plan.own_features().into_iter().filter(|it| !has(it)).collect();
    match missing.is_empty() {
        true => Ok(()),
        false => {
            let (device, adopted) = (gpu.summary.name.clone(), gpu.is_adopted);
            Err(Error::WithoutFeatures { device, missing, adopted })
        }
    }
}

/// Whether the image or buffer takes here what the Plan gives it: exactly that, or where the Plan only estimated, not more.
fn memory(gpu: &Gpu, plan: &Plan, name: &str, place: &Placement, actual: MemoryNeeds) -> Result<(), Error> {
    let planned = MemoryNeeds { bytes: place.bytes, alignment: place.alignment, type_bits: place.type_bits };
    let heap = &plan.heaps[place.heap as usize];
    let enough = actual.bytes <= planned.bytes
        && place.offset.is_multiple_of(actual.alignment.max(1))
        && heap.alignment >= actual.alignment
        && heap.type_bits & !actual.type_bits == 0;
    if actual == planned || (!plan.device.exact_memory && enough) {
        return Ok(());
    }
    Err(Error::OtherMemoryNeeds {
        resource: name.to_owned(),
        device: gpu.summary.name.clone(),
        planned_for: plan.device.name.clone(),
        actual,
        planned,
    })
}

/// Why the device takes nothing from an owner.
pub(crate) fn refused_owner(gpu: &Gpu, name: &str, owner: OutsideOwner) -> Option<String> {
    let lacks = owner == OutsideOwner::Foreign && !gpu.takes_foreign;
    lacks.then(|| {
        format!(
            "`{name}` can't have a foreign owner: {} {} VK_EXT_queue_family_foreign",
            gpu.summary.name,
            if gpu.is_adopted { "was created without" } else { "lacks" }
        )
    })
}
