//! The minimum that a physical device must offer, and what is used beyond it.

use super::features::Features;
use super::queues::QueueFamilies;
use super::words::version;
use ash::vk;
use std::ffi::CStr;

/// The Vulkan version that devices and the loader must have.
pub const MINIMUM_VERSION: u32 = vk::API_VERSION_1_3;

/// Whether `physical` has the device extensions of these names.
pub(crate) fn has_extensions<const N: usize>(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    names: [&CStr; N],
) -> [bool; N] {
    // SAFETY: `physical` belongs to `instance`.
    let extensions = unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
    names.map(|name| extensions.iter().any(|it| it.extension_name_as_c_str() == Ok(name)))
}

/// What `physical` lacks if its version of Vulkan is too old. The features of 1.3 can't be asked for then.
pub(super) fn too_old(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<String> {
    // SAFETY: `physical` belongs to `instance`.
    let properties = unsafe { instance.get_physical_device_properties(physical) };
    let has = properties.api_version;
    (has < MINIMUM_VERSION).then(|| format!("Vulkan {} (it has {})", version(MINIMUM_VERSION), version(has)))
}

/// All that `physical` lacks of the minimum, by Vulkan's names.
pub(crate) fn missing(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Vec<String> {
    missing_of(instance, physical, |_| true)
}

/// The same, of the features that are `wanted` alone.
pub(crate) fn missing_of(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    wanted: impl Fn(&str) -> bool,
) -> Vec<String> {
    if let Some(version) = too_old(instance, physical) {
        return vec![version];
    }
    let features = Features::of(instance, physical).missing().into_iter().filter(|name| wanted(name));
    let mut missing: Vec<String> = features.map(|name| format!("the feature {name}")).collect();
    match QueueFamilies::of(instance, physical) {
        None => missing.push("a queue for graphics and compute".to_owned()),
        Some(families) if families.graphics.timestamp_bits == 0 => {
            missing.push("timestamps on its graphics queue".to_owned());
        }
        Some(_) => {}
    }
    missing
}

/// The number of views that a rendering scope of `physical`, which has these features, can draw at once, as the device claims.
pub(crate) fn max_views(instance: &ash::Instance, physical: vk::PhysicalDevice, features: &Features) -> u32 {
    let mut views = vk::PhysicalDeviceVulkan11Properties::default();
    let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut views);
    // SAFETY: `physical` belongs to `instance`, and the chained structure outlives the call.
    unsafe { instance.get_physical_device_properties2(physical, &mut all) };
    if features.multiview() { views.max_multiview_view_count } else { 1 }
}
