//! Whether a Plan can be executed on a device as it is.

use crate::convert;
use crate::device::Shared;
use crate::error::Error;
use crate::image::create_info;
use crate::prepare::descriptor;
use framewright_graph::device::MemoryNeeds;
use framewright_graph::plan::{Image, Placement, Plan, Role, Work};
use framewright_graph::verify::{Rule, Violation, verify};
use framewright_graph::vocabulary::Usage;

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
    let info = create_info(&descriptor);
    // SAFETY: the physical device belongs to the instance.
    let limits = unsafe {
        shared.instance.raw.get_physical_device_image_format_properties(
            shared.physical,
            info.format,
            info.image_type,
            info.tiling,
            info.usage,
            info.flags,
        )
    };
    let fits = limits.is_ok_and(|limits| {
        let most = [limits.max_extent.width, limits.max_extent.height, limits.max_extent.depth];
        image.extent.iter().zip(most).all(|(extent, most)| (1..=most).contains(extent))
            && (1..=limits.max_mip_levels).contains(&image.mips)
            && (1..=limits.max_array_layers).contains(&image.layers)
            && image.samples.is_power_of_two()
            && limits.sample_counts.contains(convert::samples(image.samples))
    });
    if fits {
        Ok(())
    } else {
        bad(format!("{} has no images like `{}`: {descriptor:?}", shared.summary.name, image.name))
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
