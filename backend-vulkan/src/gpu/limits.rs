//! The device's limits for shaders and buffers.

use super::Gpu;
use ash::vk;
use framewright_graph::device::Limits;
use framewright_graph::vulkan::VertexFormat;

impl Gpu {
    /// The limits for what shaders use, as profiles tell them.
    pub(crate) fn shader_limits(&self) -> Limits {
        limits_of(&self.limits, self.max_buffer_size())
    }

    /// Whether the device reads vertices of a format.
    pub(crate) fn reads_vertices(&self, format: VertexFormat) -> bool {
        let format = vk::Format::from_raw(format.vulkan());
        // SAFETY: the physical device belongs to the instance.
        let features = unsafe { self.instance.raw.get_physical_device_format_properties(self.physical, format) };
        features.buffer_features.contains(vk::FormatFeatureFlags::VERTEX_BUFFER)
    }

    /// Bytes of the largest buffer.
    pub(crate) fn max_buffer_size(&self) -> u64 {
        let mut v1_3 = vk::PhysicalDeviceVulkan13Properties::default();
        let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut v1_3);
        // SAFETY: the physical device belongs to the instance, and the chained structure outlives the call.
        unsafe { self.instance.raw.get_physical_device_properties2(self.physical, &mut all) };
        v1_3.max_buffer_size
    }
}

/// The whole part of a limit.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "limits are no less than 0")]
fn whole(limit: f32) -> u64 {
    limit as u64
}

fn limits_of(limits: &vk::PhysicalDeviceLimits, buffer_bytes: u64) -> Limits {
    let [workgroup_x, workgroup_y, workgroup_z] = limits.max_compute_work_group_size.map(u64::from);
    Limits {
        workgroup_x,
        workgroup_y,
        workgroup_z,
        workgroup_invocations: limits.max_compute_work_group_invocations.into(),
        shared_bytes: limits.max_compute_shared_memory_size.into(),
        buffer_bytes,
        uniform_bytes: limits.max_uniform_buffer_range.into(),
        storage_bytes: limits.max_storage_buffer_range.into(),
        stage_samplers: limits.max_per_stage_descriptor_samplers.into(),
        stage_sampled_images: limits.max_per_stage_descriptor_sampled_images.into(),
        stage_storage_images: limits.max_per_stage_descriptor_storage_images.into(),
        stage_uniform_blocks: limits.max_per_stage_descriptor_uniform_buffers.into(),
        stage_storage_blocks: limits.max_per_stage_descriptor_storage_buffers.into(),
        stage_input_attachments: limits.max_per_stage_descriptor_input_attachments.into(),
        stage_resources: limits.max_per_stage_resources.into(),
        set_samplers: limits.max_descriptor_set_samplers.into(),
        set_sampled_images: limits.max_descriptor_set_sampled_images.into(),
        set_storage_images: limits.max_descriptor_set_storage_images.into(),
        set_uniform_blocks: limits.max_descriptor_set_uniform_buffers.into(),
        set_storage_blocks: limits.max_descriptor_set_storage_buffers.into(),
        set_input_attachments: limits.max_descriptor_set_input_attachments.into(),
        fragment_resources: limits.max_fragment_combined_output_resources.into(),
        vertex_buffers: limits.max_vertex_input_bindings.into(),
        vertex_attributes: limits.max_vertex_input_attributes.into(),
        vertex_offset: limits.max_vertex_input_attribute_offset.into(),
        vertex_stride: limits.max_vertex_input_binding_stride.into(),
        indirect_draws: limits.max_draw_indirect_count.into(),
        push_constant_bytes: limits.max_push_constants_size.into(),
        line_width: whole(limits.line_width_range[1]),
        anisotropy: whole(limits.max_sampler_anisotropy),
        lod_bias: whole(limits.max_sampler_lod_bias),
    }
}
