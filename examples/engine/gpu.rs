//! The engine's own Vulkan: an instance, a device, and its queues.

use framewright::Device;
use framewright::vulkan::ash::{self, vk};
use framewright::vulkan::{AdoptedDevice, DeviceFeatures, MINIMUM_VERSION};
use std::error::Error;

/// The engine's device. What is made from it must be gone before it is dropped.
pub(crate) struct Gpu {
    _entry: ash::Entry,
    instance: ash::Instance,
    pub(crate) physical: vk::PhysicalDevice,
    pub(crate) raw: ash::Device,
    /// One of each family that does graphics or compute; the first does both.
    queues: Vec<(u32, vk::Queue)>,
}

impl Gpu {
    /// Makes the device with all that Framewright can use, and lends it out.
    pub(crate) fn open() -> Result<(Gpu, Device), Box<dyn Error>> {
        // SAFETY: the system's loader is trusted.
        let entry = unsafe { ash::Entry::load()? };
        let application = vk::ApplicationInfo::default().api_version(MINIMUM_VERSION);
        let info = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: what the structure points to outlives the call.
        let instance = unsafe { entry.create_instance(&info, None)? };
        // SAFETY: the instance lives.
        let physical = unsafe { instance.enumerate_physical_devices()? }.into_iter().next().ok_or("no device")?;
        let families = families(&instance, physical)?;
        // SAFETY: the physical device belongs to the instance, which is one of Vulkan 1.3.
        let mut needed = unsafe { DeviceFeatures::of(&instance, physical)? };
        let extensions = needed.extensions().to_vec();
        let mut features = needed.chain();
        let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
        let one =
            |family: &u32| vk::DeviceQueueCreateInfo::default().queue_family_index(*family).queue_priorities(&[1.0]);
        let wanted: Vec<_> = families.iter().map(one).collect();
        let info = vk::DeviceCreateInfo::default().queue_create_infos(&wanted).enabled_extension_names(&names);
        let info = info.push_next(&mut features);
        // SAFETY: the physical device has the families, the features and the extensions.
        let raw = unsafe { instance.create_device(physical, &info, None)? };
        // SAFETY: the device was created with a queue of each family.
        let queue = |family: u32| (family, unsafe { raw.get_device_queue(family, 0) });
        let queues: Vec<_> = families.into_iter().map(queue).collect();
        let program = AdoptedDevice {
            instance: &instance,
            instance_extensions: &[],
            physical,
            device: &raw,
            device_extensions: &extensions,
            features: &features,
            queues: &queues,
            allocator: None,
        };
        // SAFETY: all of it belongs together, and is destroyed after everything that was made from the adopted device.
        let device = unsafe { Device::adopt(&program, None)? };
        Ok((Gpu { _entry: entry, instance, physical, raw, queues }, device))
    }

    /// The queue for graphics, with its family.
    pub(crate) fn graphics(&self) -> (u32, vk::Queue) {
        self.queues[0]
    }

    /// Memory for an image or buffer of the engine's own.
    pub(crate) fn allocate(
        &self,
        needs: vk::MemoryRequirements,
        wanted: vk::MemoryPropertyFlags,
    ) -> Result<vk::DeviceMemory, Box<dyn Error>> {
        // SAFETY: the physical device belongs to the instance.
        let memory = unsafe { self.instance.get_physical_device_memory_properties(self.physical) };
        let fits = |ty: &u32| {
            needs.memory_type_bits & 1 << ty != 0 && memory.memory_types[*ty as usize].property_flags.contains(wanted)
        };
        let ty = (0..memory.memory_type_count).find(fits).ok_or("no memory of this type")?;
        let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(ty);
        // SAFETY: the device lives and has the type.
        Ok(unsafe { self.raw.allocate_memory(&info, None)? })
    }
}

/// The family that does graphics and compute, and one for compute alone where there is one.
fn families(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Result<Vec<u32>, Box<dyn Error>> {
    // SAFETY: the physical device belongs to the instance.
    let all = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    let with = |wanted, unwanted| {
        (0..)
            .zip(&all)
            .find(|(_, family)| family.queue_flags.contains(wanted) && !family.queue_flags.intersects(unwanted))
    };
    let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    let (first, _) = with(both, vk::QueueFlags::empty()).ok_or("no queue does graphics and compute")?;
    let compute = with(vk::QueueFlags::COMPUTE, vk::QueueFlags::GRAPHICS).map(|(family, _)| family);
    Ok([Some(first), compute].into_iter().flatten().collect())
}

impl Drop for Gpu {
    fn drop(&mut self) {
        // SAFETY: nothing made from the device or the instance is left.
        unsafe {
            self.raw.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}
