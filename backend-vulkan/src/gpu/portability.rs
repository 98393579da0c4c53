//! Devices that are Vulkan on top of another interface and lack parts of it, as MoltenVK on Metal.
//!
//! The loader lists them only for instances with the flag `ENUMERATE_PORTABILITY_KHR`. A program that opens one must switch on
//! `VK_KHR_portability_subset`, with those of its features that are used.

use super::minimum::has_extensions;
use ash::{khr, vk};
use std::ffi::CStr;

/// The flags of an instance with these extensions: all devices are listed, where the loader can tell them apart.
pub(super) fn instance_flags(extensions: &[&CStr]) -> vk::InstanceCreateFlags {
    match extensions.contains(&khr::portability_enumeration::NAME) {
        true => vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR,
        false => vk::InstanceCreateFlags::empty(),
    }
}

/// What `physical` has of the parts of Vulkan that such a device may lack; `None`: it lacks none of them.
pub(super) fn subset(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
) -> Option<vk::PhysicalDevicePortabilitySubsetFeaturesKHR<'static>> {
    if !has_extensions(instance, physical, [khr::portability_subset::NAME])[0] {
        return None;
    }
    let mut subset = vk::PhysicalDevicePortabilitySubsetFeaturesKHR::default();
    let mut all = vk::PhysicalDeviceFeatures2::default().push_next(&mut subset);
    // SAFETY: `physical` belongs to `instance`, and the chained structure outlives the call.
    unsafe { instance.get_physical_device_features2(physical, &mut all) };
    subset.p_next = std::ptr::null_mut();
    Some(subset)
}
