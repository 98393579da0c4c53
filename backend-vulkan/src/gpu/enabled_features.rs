//! The features that a program switched on when it made its device.

use super::features::{Features, Subgroups};
use ash::vk;
use std::marker::PhantomData;

impl Features {
    /// The features in the chain that a device of `physical` was created with. A feature of Vulkan 1.0 to 1.3 may stand in the structure of
    /// its version, or in that of the extension that it comes from.
    ///
    /// # Safety
    /// `physical` belongs to `instance`, and each structure in the chain is valid, and of the type that it says.
    pub(super) unsafe fn enabled(
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        chain: &vk::PhysicalDeviceFeatures2<'_>,
    ) -> Features {
        let subgroups = Subgroups::of(instance, physical);
        let mut on = Features { core: chain.features, subgroups, ..Features::default() };
        let mut next = chain.p_next.cast::<vk::BaseInStructure<'_>>().cast_const();
        // SAFETY: the caller's word: it is null or a valid structure.
        while let Some(structure) = unsafe { next.as_ref() } {
            use vk::StructureType as Is;
            macro_rules! read {
                ($structure:ident) => {
                    // SAFETY: the caller's word: the structure is of the type that it says.
                    unsafe { &*next.cast::<vk::$structure<'_>>() }
                };
            }
            macro_rules! whole {
                ($structure:ident) => {
                    vk::$structure { p_next: std::ptr::null_mut(), _marker: PhantomData, ..*read!($structure) }
                };
            }
            match structure.s_type {
                Is::PHYSICAL_DEVICE_VULKAN_1_1_FEATURES => on.v1_1 = whole!(PhysicalDeviceVulkan11Features),
                Is::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES => on.v1_2 = whole!(PhysicalDeviceVulkan12Features),
                Is::PHYSICAL_DEVICE_VULKAN_1_3_FEATURES => on.v1_3 = whole!(PhysicalDeviceVulkan13Features),
                Is::PHYSICAL_DEVICE_MULTIVIEW_FEATURES => {
                    on.v1_1.multiview = read!(PhysicalDeviceMultiviewFeatures).multiview;
                }
                Is::PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_FEATURES => {
                    indexing(&mut on.v1_2, read!(PhysicalDeviceDescriptorIndexingFeatures));
                }
                Is::PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES => {
                    on.v1_2.scalar_block_layout = read!(PhysicalDeviceScalarBlockLayoutFeatures).scalar_block_layout;
                }
                Is::PHYSICAL_DEVICE_UNIFORM_BUFFER_STANDARD_LAYOUT_FEATURES => {
                    let it = read!(PhysicalDeviceUniformBufferStandardLayoutFeatures);
                    on.v1_2.uniform_buffer_standard_layout = it.uniform_buffer_standard_layout;
                }
                Is::PHYSICAL_DEVICE_ZERO_INITIALIZE_WORKGROUP_MEMORY_FEATURES => {
                    let it = read!(PhysicalDeviceZeroInitializeWorkgroupMemoryFeatures);
                    on.v1_3.shader_zero_initialize_workgroup_memory = it.shader_zero_initialize_workgroup_memory;
                }
                Is::PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES => {
                    let it = read!(PhysicalDevice16BitStorageFeatures);
                    on.v1_1.storage_buffer16_bit_access = it.storage_buffer16_bit_access;
                    on.v1_1.uniform_and_storage_buffer16_bit_access = it.uniform_and_storage_buffer16_bit_access;
                }
                Is::PHYSICAL_DEVICE_8BIT_STORAGE_FEATURES => {
                    let it = read!(PhysicalDevice8BitStorageFeatures);
                    on.v1_2.storage_buffer8_bit_access = it.storage_buffer8_bit_access;
                    on.v1_2.uniform_and_storage_buffer8_bit_access = it.uniform_and_storage_buffer8_bit_access;
                }
                Is::PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES => {
                    let it = read!(PhysicalDeviceShaderFloat16Int8Features);
                    on.v1_2.shader_float16 = it.shader_float16;
                    on.v1_2.shader_int8 = it.shader_int8;
                }
                Is::PHYSICAL_DEVICE_SHADER_ATOMIC_INT64_FEATURES => {
                    let it = read!(PhysicalDeviceShaderAtomicInt64Features);
                    on.v1_2.shader_buffer_int64_atomics = it.shader_buffer_int64_atomics;
                    on.v1_2.shader_shared_int64_atomics = it.shader_shared_int64_atomics;
                }
                Is::PHYSICAL_DEVICE_SHADER_DRAW_PARAMETERS_FEATURES => {
                    let it = read!(PhysicalDeviceShaderDrawParametersFeatures);
                    on.v1_1.shader_draw_parameters = it.shader_draw_parameters;
                }
                Is::PHYSICAL_DEVICE_SHADER_SUBGROUP_EXTENDED_TYPES_FEATURES => {
                    let it = read!(PhysicalDeviceShaderSubgroupExtendedTypesFeatures);
                    on.v1_2.shader_subgroup_extended_types = it.shader_subgroup_extended_types;
                }
                Is::PHYSICAL_DEVICE_SHADER_INTEGER_DOT_PRODUCT_FEATURES => {
                    let it = read!(PhysicalDeviceShaderIntegerDotProductFeatures);
                    on.v1_3.shader_integer_dot_product = it.shader_integer_dot_product;
                }
                Is::PHYSICAL_DEVICE_VULKAN_MEMORY_MODEL_FEATURES => {
                    let it = read!(PhysicalDeviceVulkanMemoryModelFeatures);
                    on.v1_2.vulkan_memory_model = it.vulkan_memory_model;
                    on.v1_2.vulkan_memory_model_device_scope = it.vulkan_memory_model_device_scope;
                }
                Is::PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES => {
                    on.v1_2.timeline_semaphore = read!(PhysicalDeviceTimelineSemaphoreFeatures).timeline_semaphore;
                }
                Is::PHYSICAL_DEVICE_HOST_QUERY_RESET_FEATURES => {
                    on.v1_2.host_query_reset = read!(PhysicalDeviceHostQueryResetFeatures).host_query_reset;
                }
                Is::PHYSICAL_DEVICE_SEPARATE_DEPTH_STENCIL_LAYOUTS_FEATURES => {
                    let it = read!(PhysicalDeviceSeparateDepthStencilLayoutsFeatures);
                    on.v1_2.separate_depth_stencil_layouts = it.separate_depth_stencil_layouts;
                }
                Is::PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES => {
                    on.v1_3.dynamic_rendering = read!(PhysicalDeviceDynamicRenderingFeatures).dynamic_rendering;
                }
                Is::PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES => {
                    on.v1_3.synchronization2 = read!(PhysicalDeviceSynchronization2Features).synchronization2;
                }
                Is::PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES => {
                    on.v1_3.maintenance4 = read!(PhysicalDeviceMaintenance4Features).maintenance4;
                }
                Is::PHYSICAL_DEVICE_SHADER_DEMOTE_TO_HELPER_INVOCATION_FEATURES => {
                    let it = read!(PhysicalDeviceShaderDemoteToHelperInvocationFeatures);
                    on.v1_3.shader_demote_to_helper_invocation = it.shader_demote_to_helper_invocation;
                }
                Is::PHYSICAL_DEVICE_SHADER_TERMINATE_INVOCATION_FEATURES => {
                    let it = read!(PhysicalDeviceShaderTerminateInvocationFeatures);
                    on.v1_3.shader_terminate_invocation = it.shader_terminate_invocation;
                }
                Is::PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES => {
                    let it = read!(PhysicalDeviceBufferDeviceAddressFeatures);
                    on.v1_2.buffer_device_address = it.buffer_device_address;
                }
                // SAFETY: the caller's word: the structure is of the type that it says.
                _ => unsafe { on.of_extensions.take(structure) },
            }
            next = structure.p_next;
        }
        on
    }
}

/// Takes over the features of descriptor indexing.
fn indexing(to: &mut vk::PhysicalDeviceVulkan12Features<'_>, it: &vk::PhysicalDeviceDescriptorIndexingFeatures<'_>) {
    to.shader_sampled_image_array_non_uniform_indexing = it.shader_sampled_image_array_non_uniform_indexing;
    to.shader_storage_image_array_non_uniform_indexing = it.shader_storage_image_array_non_uniform_indexing;
    to.shader_uniform_texel_buffer_array_dynamic_indexing = it.shader_uniform_texel_buffer_array_dynamic_indexing;
    to.shader_storage_texel_buffer_array_dynamic_indexing = it.shader_storage_texel_buffer_array_dynamic_indexing;
    to.shader_uniform_buffer_array_non_uniform_indexing = it.shader_uniform_buffer_array_non_uniform_indexing;
    to.shader_storage_buffer_array_non_uniform_indexing = it.shader_storage_buffer_array_non_uniform_indexing;
    to.shader_uniform_texel_buffer_array_non_uniform_indexing =
        it.shader_uniform_texel_buffer_array_non_uniform_indexing;
    to.shader_storage_texel_buffer_array_non_uniform_indexing =
        it.shader_storage_texel_buffer_array_non_uniform_indexing;
    to.descriptor_binding_uniform_buffer_update_after_bind = it.descriptor_binding_uniform_buffer_update_after_bind;
    to.descriptor_binding_sampled_image_update_after_bind = it.descriptor_binding_sampled_image_update_after_bind;
    to.descriptor_binding_storage_image_update_after_bind = it.descriptor_binding_storage_image_update_after_bind;
    to.descriptor_binding_storage_buffer_update_after_bind = it.descriptor_binding_storage_buffer_update_after_bind;
    to.descriptor_binding_uniform_texel_buffer_update_after_bind =
        it.descriptor_binding_uniform_texel_buffer_update_after_bind;
    to.descriptor_binding_storage_texel_buffer_update_after_bind =
        it.descriptor_binding_storage_texel_buffer_update_after_bind;
    to.descriptor_binding_update_unused_while_pending = it.descriptor_binding_update_unused_while_pending;
    to.descriptor_binding_partially_bound = it.descriptor_binding_partially_bound;
    to.descriptor_binding_variable_descriptor_count = it.descriptor_binding_variable_descriptor_count;
    to.runtime_descriptor_array = it.runtime_descriptor_array;
}
