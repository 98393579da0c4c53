//! A Vulkan device of wgpu's, which Framewright draws on too.

use framewright::vulkan::AdoptedDevice;
use framewright::vulkan::ash::{self, vk};
use std::error::Error;
use wgpu::hal::api::Vulkan;

/// The device, as both know it. What is made from it is dropped before.
pub(crate) struct Gpu {
    /// Framewright's view of it: dropped before wgpu destroys it.
    pub(crate) framewright: framewright::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) device: wgpu::Device,
}

impl Gpu {
    /// Has wgpu make an instance and a device, which has what both need, and hands it to Framewright.
    pub(crate) fn open() -> Result<Gpu, Box<dyn Error>> {
        let mut of_instance = wgpu::InstanceDescriptor::new_without_display_handle();
        of_instance.backends = wgpu::Backends::VULKAN;
        let adapter = wgpu::Instance::new(of_instance).request_adapter(&wgpu::RequestAdapterOptions::default());
        let adapter = pollster::block_on(adapter)?;
        let (wanted, limits) = (wgpu::Features::empty(), adapter.limits());

        // What Framewright needs beside what wgpu switches on: `framewright::vulkan::minimum_features` lists all.
        let mut rendering = vk::PhysicalDeviceDynamicRenderingFeatures::default().dynamic_rendering(true);
        let mut synchronization = vk::PhysicalDeviceSynchronization2Features::default().synchronization2(true);
        let mut depth =
            vk::PhysicalDeviceSeparateDepthStencilLayoutsFeatures::default().separate_depth_stencil_layouts(true);
        let mut queries = vk::PhysicalDeviceHostQueryResetFeatures::default().host_query_reset(true);
        let mut demote = vk::PhysicalDeviceShaderDemoteToHelperInvocationFeatures::default()
            .shader_demote_to_helper_invocation(true);
        let mut terminate =
            vk::PhysicalDeviceShaderTerminateInvocationFeatures::default().shader_terminate_invocation(true);

        // SAFETY: the device is created from the adapter's own physical device, with all that wgpu demands, and wgpu destroys it. What
        // Framewright is told is what it was created with.
        unsafe {
            let hal = adapter.as_hal::<Vulkan>().ok_or("wgpu has no Vulkan adapter")?;
            let (instance, physical) = (hal.shared_instance(), hal.raw_physical_device());
            let extensions = hal.required_device_extensions(wanted);
            let mut features = hal.physical_device_features(&extensions, wanted);
            let core = features.get_core();
            // wgpu takes the queue 0 of the family 0.
            let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(0).queue_priorities(&[1.0])];
            let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
            let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&names);
            let info = info.push_next(&mut rendering).push_next(&mut synchronization).push_next(&mut depth);
            let info = info.push_next(&mut queries).push_next(&mut demote).push_next(&mut terminate);
            let info = features.add_to_device_create(info);
            switch_maintenance4_on(info.p_next.cast_mut().cast());
            let raw = instance.raw_instance().create_device(physical, &info, None)?;
            let switched_on =
                vk::PhysicalDeviceFeatures2 { p_next: info.p_next.cast_mut(), features: core, ..Default::default() };
            let adopted = AdoptedDevice {
                instance: instance.raw_instance(),
                instance_extensions: instance.extensions(),
                physical,
                device: &raw,
                device_extensions: &extensions,
                features: &switched_on,
                queues: &[(0, raw.get_device_queue(0, 0))],
                allocator: None,
            };
            let framewright = framewright::Device::adopt(&adopted, None)?;
            let hints = wgpu::MemoryHints::default();
            let open = hal.device_from_raw(raw.clone(), None, &extensions, wanted, &limits, &hints, 0, 0)?;
            drop(hal);
            let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
            let (device, queue) = adapter.create_device_from_hal::<Vulkan>(open, &descriptor)?;
            Ok(Gpu { framewright, queue, device })
        }
    }

    /// A timeline semaphore, to be destroyed by `raw().destroy_semaphore`.
    pub(crate) fn timeline(&self) -> Result<vk::Semaphore, vk::Result> {
        let mut ty = vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
        // SAFETY: the device lives.
        unsafe { self.raw().create_semaphore(&vk::SemaphoreCreateInfo::default().push_next(&mut ty), None) }
    }

    pub(crate) fn raw(&self) -> &ash::Device {
        self.framewright.raw()
    }
}

/// Switches `maintenance4` on in a chain of features: wgpu has its structure in there, and needs it for mesh shaders alone.
///
/// # Safety
/// The chain is valid, and nobody else uses it meanwhile.
unsafe fn switch_maintenance4_on(mut next: *mut vk::BaseOutStructure<'_>) {
    // SAFETY: the caller's word.
    while let Some(structure) = unsafe { next.as_mut() } {
        if structure.s_type == vk::StructureType::PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES {
            // SAFETY: it is of the type that it says.
            unsafe { (*next.cast::<vk::PhysicalDeviceMaintenance4Features<'_>>()).maintenance4 = vk::TRUE };
        }
        next = structure.p_next;
    }
}
