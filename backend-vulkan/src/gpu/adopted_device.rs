//! Devices that the program made itself.

use super::device::Device;
use super::features::Features;
use super::handle::{CreatedDevice, Gpu};
use super::instance::Instance;
use super::minimum::missing_of;
use super::queues::QueueFamilies;
use super::summary::summary;
use crate::base::Error;
use crate::process::Helper;
use ash::{ext, khr, vk};
use framewright_graph::device::EVERY_PLAN_USES;
use gpu_allocator::vulkan::Allocator;
use std::ffi::CStr;
use std::sync::{Arc, Mutex};

/// A device that the program made itself, and what it was made with: for [`Device::adopt`].
///
/// Its instance must have Vulkan 1.3 as its `apiVersion`. The features that every Plan uses must be switched on
/// ([`EVERY_PLAN_USES`]); of the others those that its Plans use ([`Plan::features`](framewright_graph::plan::Plan::features)). An
/// executor of a Plan that uses another one is refused, by name. [`DeviceFeatures`](crate::DeviceFeatures) has them as a chain.
pub struct AdoptedDevice<'p> {
    /// The instance.
    pub instance: &'p ash::Instance,
    /// The extensions that the instance was created with. `VK_EXT_debug_utils` gives names and labels to debuggers; `VK_KHR_surface` is
    /// needed to present.
    pub instance_extensions: &'p [&'p CStr],
    /// The physical device.
    pub physical: vk::PhysicalDevice,
    /// The device.
    pub device: &'p ash::Device,
    /// The extensions that the device was created with. `VK_KHR_dynamic_rendering_local_read`,
    /// `VK_KHR_fragment_shader_barycentric`, `VK_EXT_vertex_attribute_divisor` or `VK_KHR_vertex_attribute_divisor`, `VK_KHR_swapchain`,
    /// `VK_EXT_queue_family_foreign`, `VK_KHR_acceleration_structure`, `VK_KHR_ray_query`, `VK_KHR_ray_tracing_pipeline`,
    /// `VK_KHR_ray_tracing_maintenance1`, `VK_KHR_fragment_shading_rate` and `VK_EXT_mesh_shader` are used.
    pub device_extensions: &'p [&'p CStr],
    /// The features that the device was created with, as they were chained to its creation. `VkPhysicalDeviceVulkan14Features` isn't read:
    /// of what it holds, local reads and `vertexAttributeInstanceRateDivisor` are used where the structures and extensions of their own are on.
    pub features: &'p vk::PhysicalDeviceFeatures2<'p>,
    /// Queues that may be used, with their families: one for graphics and compute; if there are, one for compute alone and one for
    /// transfers alone.
    pub queues: &'p [(u32, vk::Queue)],
    /// The program's allocator of the device's memory, which then serves everything that is made from the adopted device; `None`: the
    /// adopted device gets an allocator of its own. It is locked only while memory is allocated, given back or counted.
    pub allocator: Option<Arc<Mutex<Allocator>>>,
}

impl Device {
    /// Uses a device that the program made itself, and destroys itself. When the last clone and the last thing made from the device are
    /// gone, all memory is back in the program's allocator, if there is one; after [`Error::Timeout`] and the like nothing is given back, and
    /// the allocator is kept for good. The helper process tests the device, as with [`DeviceOptions`](crate::DeviceOptions).
    ///
    /// # Errors
    /// [`Error::Lacking`] if the physical device lacks what every Plan uses, and [`Error::NotEnabled`] with all of that which the device
    /// was created without.
    ///
    /// # Safety
    /// - The instance, the device and the queues live until everything made from the adopted device is gone, and belong together.
    /// - Extensions and features are those that they were created with; each structure in the chain of features is valid.
    /// - An allocator is one of this device, made without `buffer_device_address` unless the feature `bufferDeviceAddress` is switched on; made
    ///   with it where custom passes declare builds of acceleration structures, since their buffers have addresses.
    /// - Without `robustBufferAccess`, no index of a draw, an indirect draw or a shader reaches beyond its buffer.
    /// - While this crate draws, uploads or reads back, no other thread submits to these queues.
    pub unsafe fn adopt(program: &AdoptedDevice<'_>, helper: Option<Helper>) -> Result<Device, Error> {
        let on = |extensions: &[&CStr], name: &CStr| extensions.contains(&name);
        let instance = Instance::adopted(program.instance.clone(), program.instance_extensions);
        let summary = summary(&instance, 0, program.physical);
        let every_plan = |name: &str| EVERY_PLAN_USES.contains(&name);
        let lacks = missing_of(&instance.raw, program.physical, every_plan);
        if !lacks.is_empty() {
            return Err(Error::Lacking { device: summary.name, missing: lacks });
        }
        // SAFETY: the program's word: each structure in the chain is valid.
        let has = unsafe { Features::enabled(&instance.raw, program.physical, program.features) };
        let missing = has.missing().into_iter().filter(|name| every_plan(name));
        let mut without: Vec<String> = missing.map(|name| format!("the feature {name}")).collect();
        let given: Vec<u32> = program.queues.iter().map(|(family, _)| *family).collect();
        let families = QueueFamilies::among(&instance.raw, program.physical, &given);
        match &families {
            Some(families) if families.graphics.timestamp_bits > 0 => {}
            Some(_) => without.push("timestamps on its graphics queue".to_owned()),
            None => without.push("a queue for graphics and compute".to_owned()),
        }
        let (Some(families), true) = (families, without.is_empty()) else {
            return Err(Error::NotEnabled { device: summary.name, missing: without });
        };
        let presents = instance.surfaces && on(program.device_extensions, khr::swapchain::NAME);
        let made = CreatedDevice {
            raw: program.device.clone(),
            features: Features::used(has, |name| on(program.device_extensions, name)),
            presents,
            takes_foreign: on(program.device_extensions, ext::queue_family_foreign::NAME),
            queues: program.queues.to_vec(),
            families,
            is_adopted: true,
            allocator: program.allocator.clone(),
        };
        let cache = helper.as_ref().and_then(Helper::cache);
        let gpu = Gpu::of(instance, program.physical, summary, made, cache)?;
        Ok(Device { gpu: Arc::new(gpu), helper, tested: Arc::default() })
    }
}
