//! The features that a device must have, and those that are used where it has them.

use ash::vk;

/// Feature structures in the order in which they are chained.
#[derive(Default)]
pub(crate) struct Features {
    core: vk::PhysicalDeviceFeatures,
    v1_1: vk::PhysicalDeviceVulkan11Features<'static>,
    v1_2: vk::PhysicalDeviceVulkan12Features<'static>,
    v1_3: vk::PhysicalDeviceVulkan13Features<'static>,
    local_read: vk::PhysicalDeviceDynamicRenderingLocalReadFeaturesKHR<'static>,
}

/// The features that a device must have beside [`crate::MINIMUM_VERSION`], by Vulkan's names.
pub fn minimum_features() -> impl Iterator<Item = &'static str> {
    MINIMUM_FEATURES.iter().map(|(name, _)| *name)
}

/// Reaches one feature's flag.
type Flag = fn(&mut Features) -> &mut vk::Bool32;

/// The minimum device, feature by feature: Vulkan's name, the flag. All of these are switched on.
const MINIMUM_FEATURES: [(&str, Flag); 12] = [
    // Rendering scopes without render pass objects.
    ("dynamicRendering", |it| &mut it.v1_3.dynamic_rendering),
    // Barriers as the Plan writes them.
    ("synchronization2", |it| &mut it.v1_3.synchronization2),
    // Memory needs of images and buffers that don't exist yet.
    ("maintenance4", |it| &mut it.v1_3.maintenance4),
    // `discard` in SPIR-V 1.6.
    ("shaderDemoteToHelperInvocation", |it| &mut it.v1_3.shader_demote_to_helper_invocation),
    ("shaderTerminateInvocation", |it| &mut it.v1_3.shader_terminate_invocation),
    // Waits between queues, and of the host for frames.
    ("timelineSemaphore", |it| &mut it.v1_2.timeline_semaphore),
    // Timestamps of queues that can't reset them.
    ("hostQueryReset", |it| &mut it.v1_2.host_query_reset),
    // Depth and stencil are tracked apart.
    ("separateDepthStencilLayouts", |it| &mut it.v1_2.separate_depth_stencil_layouts),
    // Indices of a model file can't reach beyond their vertex buffer.
    ("robustBufferAccess", |it| &mut it.core.robust_buffer_access),
    // Another blend for each attachment.
    ("independentBlend", |it| &mut it.core.independent_blend),
    // Storage images that fragment shaders write.
    ("fragmentStoresAndAtomics", |it| &mut it.core.fragment_stores_and_atomics),
    // Fragment shaders that run once a sample.
    ("sampleRateShading", |it| &mut it.core.sample_rate_shading),
];

impl Features {
    /// The features of `physical`. `local_read`: whether its extension is there.
    pub(crate) fn of(instance: &ash::Instance, physical: vk::PhysicalDevice, local_read: bool) -> Features {
        let mut v1_1 = vk::PhysicalDeviceVulkan11Features::default();
        let mut v1_2 = vk::PhysicalDeviceVulkan12Features::default();
        let mut v1_3 = vk::PhysicalDeviceVulkan13Features::default();
        let mut local = vk::PhysicalDeviceDynamicRenderingLocalReadFeaturesKHR::default();
        let mut all = vk::PhysicalDeviceFeatures2::default();
        all = all.push_next(&mut v1_1).push_next(&mut v1_2).push_next(&mut v1_3);
        if local_read {
            all = all.push_next(&mut local);
        }
        // SAFETY: `physical` belongs to `instance`, and the chained structures outlive the call.
        unsafe { instance.get_physical_device_features2(physical, &mut all) };
        let core = all.features;
        v1_1.p_next = std::ptr::null_mut();
        v1_2.p_next = std::ptr::null_mut();
        v1_3.p_next = std::ptr::null_mut();
        local.p_next = std::ptr::null_mut();
        Features { core, v1_1, v1_2, v1_3, local_read: local }
    }

    /// The features that are switched on: the minimum, and beyond it cube arrays, what draws for two eyes at once, counts of
    /// what is drawn, and local reads where the device has them.
    pub(crate) fn used(has: &Features, local_read: bool) -> Features {
        let mut features = Features::default();
        for (_, flag) in MINIMUM_FEATURES {
            *flag(&mut features) = vk::TRUE;
        }
        features.local_read.dynamic_rendering_local_read = local_read.into();
        features.core.image_cube_array = has.core.image_cube_array;
        features.core.shader_clip_distance = has.core.shader_clip_distance;
        features.core.pipeline_statistics_query = has.core.pipeline_statistics_query;
        features.v1_1.multiview = has.v1_1.multiview;
        features.v1_2.shader_output_layer = has.v1_2.shader_output_layer;
        features
    }

    /// Features of the minimum that the device lacks, by Vulkan's names.
    pub(crate) fn missing(&mut self) -> Vec<&'static str> {
        MINIMUM_FEATURES.iter().filter(|(_, flag)| *flag(self) == vk::FALSE).map(|(name, _)| *name).collect()
    }

    /// Whether fragment shaders can read what their rendering scope drew.
    pub(crate) fn local_read(&self) -> bool {
        self.local_read.dynamic_rendering_local_read == vk::TRUE
    }

    /// Whether rendering scopes can draw several views at once.
    pub(crate) fn multiview(&self) -> bool {
        self.v1_1.multiview == vk::TRUE
    }

    /// Whether vertex shaders can choose the layer that they draw into.
    pub(crate) fn vertex_layer(&self) -> bool {
        self.v1_2.shader_output_layer == vk::TRUE
    }

    /// Whether shaders have clip distances.
    pub(crate) fn clip_distances(&self) -> bool {
        self.core.shader_clip_distance == vk::TRUE
    }

    /// Whether shaders can see several cubes at once.
    pub(crate) fn cube_arrays(&self) -> bool {
        self.core.image_cube_array == vk::TRUE
    }

    /// Whether the device counts what its pipelines do.
    pub(crate) fn pipeline_statistics(&self) -> bool {
        self.core.pipeline_statistics_query == vk::TRUE
    }

    /// Switches these features on in a device's creation.
    pub(crate) fn chain<'i>(&'i mut self, info: vk::DeviceCreateInfo<'i>) -> vk::DeviceCreateInfo<'i> {
        let info = info.enabled_features(&self.core);
        let info = info.push_next(&mut self.v1_1).push_next(&mut self.v1_2).push_next(&mut self.v1_3);
        if self.local_read.dynamic_rendering_local_read == vk::TRUE {
            info.push_next(&mut self.local_read)
        } else {
            info
        }
    }
}
