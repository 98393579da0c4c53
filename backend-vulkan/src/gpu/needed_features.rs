//! The features that pipelines can need.

use super::features::OptionalFeature;

/// Features that are used where a device has them, and that pipelines can need by their shaders and draws: profiles tell of these.
pub(super) const NEEDED_FEATURES: [OptionalFeature; 72] = [
    ("imageCubeArray", "shaders that see several cubes at once", |it| &mut it.core.image_cube_array),
    (
        "shaderSampledImageArrayDynamicIndexing",
        "elements of arrays of sampled images, by a number that changes",
        |it| &mut it.core.shader_sampled_image_array_dynamic_indexing,
    ),
    (
        "shaderStorageImageArrayDynamicIndexing",
        "elements of arrays of storage images, by a number that changes",
        |it| &mut it.core.shader_storage_image_array_dynamic_indexing,
    ),
    (
        "shaderSampledImageArrayNonUniformIndexing",
        "elements of arrays of sampled images, by a number that differs within a draw",
        |it| &mut it.v1_2.shader_sampled_image_array_non_uniform_indexing,
    ),
    (
        "shaderStorageImageArrayNonUniformIndexing",
        "elements of arrays of storage images, by a number that differs within a draw",
        |it| &mut it.v1_2.shader_storage_image_array_non_uniform_indexing,
    ),
    (
        "shaderUniformBufferArrayDynamicIndexing",
        "elements of arrays of uniform blocks, by a number that changes",
        |it| &mut it.core.shader_uniform_buffer_array_dynamic_indexing,
    ),
    (
        "shaderStorageBufferArrayDynamicIndexing",
        "elements of arrays of storage blocks, by a number that changes",
        |it| &mut it.core.shader_storage_buffer_array_dynamic_indexing,
    ),
    (
        "shaderUniformTexelBufferArrayDynamicIndexing",
        "elements of arrays of uniform texel buffers, by a number that changes",
        |it| &mut it.v1_2.shader_uniform_texel_buffer_array_dynamic_indexing,
    ),
    (
        "shaderStorageTexelBufferArrayDynamicIndexing",
        "elements of arrays of storage texel buffers, by a number that changes",
        |it| &mut it.v1_2.shader_storage_texel_buffer_array_dynamic_indexing,
    ),
    (
        "shaderUniformBufferArrayNonUniformIndexing",
        "elements of arrays of uniform blocks, by a number that differs within a draw",
        |it| &mut it.v1_2.shader_uniform_buffer_array_non_uniform_indexing,
    ),
    (
        "shaderStorageBufferArrayNonUniformIndexing",
        "elements of arrays of storage blocks, by a number that differs within a draw",
        |it| &mut it.v1_2.shader_storage_buffer_array_non_uniform_indexing,
    ),
    (
        "shaderUniformTexelBufferArrayNonUniformIndexing",
        "elements of arrays of uniform texel buffers, by a number that differs within a draw",
        |it| &mut it.v1_2.shader_uniform_texel_buffer_array_non_uniform_indexing,
    ),
    (
        "shaderStorageTexelBufferArrayNonUniformIndexing",
        "elements of arrays of storage texel buffers, by a number that differs within a draw",
        |it| &mut it.v1_2.shader_storage_texel_buffer_array_non_uniform_indexing,
    ),
    ("runtimeDescriptorArray", "arrays of the program's whose length a shader doesn't write", |it| {
        &mut it.v1_2.runtime_descriptor_array
    }),
    (
        "descriptorBindingUniformBufferUpdateAfterBind",
        "uniform blocks that are written after their set was bound",
        |it| &mut it.v1_2.descriptor_binding_uniform_buffer_update_after_bind,
    ),
    (
        "descriptorBindingSampledImageUpdateAfterBind",
        "sampled images that are written after their set was bound",
        |it| &mut it.v1_2.descriptor_binding_sampled_image_update_after_bind,
    ),
    (
        "descriptorBindingStorageImageUpdateAfterBind",
        "storage images that are written after their set was bound",
        |it| &mut it.v1_2.descriptor_binding_storage_image_update_after_bind,
    ),
    (
        "descriptorBindingStorageBufferUpdateAfterBind",
        "storage blocks that are written after their set was bound",
        |it| &mut it.v1_2.descriptor_binding_storage_buffer_update_after_bind,
    ),
    (
        "descriptorBindingUniformTexelBufferUpdateAfterBind",
        "uniform texel buffers that are written after their set was bound",
        |it| &mut it.v1_2.descriptor_binding_uniform_texel_buffer_update_after_bind,
    ),
    (
        "descriptorBindingStorageTexelBufferUpdateAfterBind",
        "storage texel buffers that are written after their set was bound",
        |it| &mut it.v1_2.descriptor_binding_storage_texel_buffer_update_after_bind,
    ),
    ("descriptorBindingUpdateUnusedWhilePending", "descriptors that are written while frames are on their way", |it| {
        &mut it.v1_2.descriptor_binding_update_unused_while_pending
    }),
    ("descriptorBindingPartiallyBound", "sets of the program's that are filled in part", |it| {
        &mut it.v1_2.descriptor_binding_partially_bound
    }),
    ("descriptorBindingVariableDescriptorCount", "sets of the program's that say how long their last array is", |it| {
        &mut it.v1_2.descriptor_binding_variable_descriptor_count
    }),
    ("drawIndirectFirstInstance", "draws whose counts, in a buffer, have a first instance that isn't 0", |it| {
        &mut it.core.draw_indirect_first_instance
    }),
    ("multiDrawIndirect", "several draws whose counts a buffer holds", |it| &mut it.core.multi_draw_indirect),
    ("drawIndirectCount", "a number of draws that a buffer holds", |it| &mut it.v1_2.draw_indirect_count),
    ("depthBiasClamp", "a bound of the depth bias", |it| &mut it.core.depth_bias_clamp),
    ("depthClamp", "depth that is clamped to the near and far plane", |it| &mut it.core.depth_clamp),
    ("dualSrcBlend", "blends with a second colour of the shader", |it| &mut it.core.dual_src_blend),
    ("wideLines", "lines that are wider than a texel", |it| &mut it.core.wide_lines),
    ("largePoints", "points of the size that a shader says", |it| &mut it.core.large_points),
    ("samplerAnisotropy", "samplers of what is seen at a slant", |it| &mut it.core.sampler_anisotropy),
    ("samplerMirrorClampToEdge", "samplers of images that are mirrored once", |it| {
        &mut it.v1_2.sampler_mirror_clamp_to_edge
    }),
    ("samplerFilterMinmax", "samplers of the least and greatest of texels", |it| &mut it.v1_2.sampler_filter_minmax),
    ("scalarBlockLayout", "blocks in scalar layout", |it| &mut it.v1_2.scalar_block_layout),
    ("uniformBufferStandardLayout", "uniform blocks in the layout of storage blocks, std430", |it| {
        &mut it.v1_2.uniform_buffer_standard_layout
    }),
    ("shaderZeroInitializeWorkgroupMemory", "shared variables that begin with 0", |it| {
        &mut it.v1_3.shader_zero_initialize_workgroup_memory
    }),
    ("textureCompressionBC", "textures in the formats BC1 to BC7", |it| &mut it.core.texture_compression_bc),
    ("textureCompressionETC2", "textures in the formats ETC2 and EAC", |it| &mut it.core.texture_compression_etc2),
    ("textureCompressionASTC_LDR", "textures in the formats of ASTC", |it| &mut it.core.texture_compression_astc_ldr),
    ("shaderFloat64", "floating point of 64 bits", |it| &mut it.core.shader_float64),
    ("shaderInt64", "integers of 64 bits", |it| &mut it.core.shader_int64),
    ("shaderInt16", "integers of 16 bits", |it| &mut it.core.shader_int16),
    ("shaderFloat16", "floating point of 16 bits", |it| &mut it.v1_2.shader_float16),
    ("shaderInt8", "integers of 8 bits", |it| &mut it.v1_2.shader_int8),
    ("storageBuffer16BitAccess", "numbers of 16 bits in storage blocks", |it| &mut it.v1_1.storage_buffer16_bit_access),
    ("uniformAndStorageBuffer16BitAccess", "numbers of 16 bits in uniform blocks", |it| {
        &mut it.v1_1.uniform_and_storage_buffer16_bit_access
    }),
    ("storageBuffer8BitAccess", "numbers of 8 bits in storage blocks", |it| &mut it.v1_2.storage_buffer8_bit_access),
    ("uniformAndStorageBuffer8BitAccess", "numbers of 8 bits in uniform blocks", |it| {
        &mut it.v1_2.uniform_and_storage_buffer8_bit_access
    }),
    ("shaderBufferInt64Atomics", "atomic operations on 64 bits in storage blocks", |it| {
        &mut it.v1_2.shader_buffer_int64_atomics
    }),
    ("shaderSharedInt64Atomics", "atomic operations on 64 bits in shared variables", |it| {
        &mut it.v1_2.shader_shared_int64_atomics
    }),
    ("shaderStorageImageReadWithoutFormat", "loads from storage images without a format", |it| {
        &mut it.core.shader_storage_image_read_without_format
    }),
    ("shaderStorageImageWriteWithoutFormat", "stores into storage images without a format", |it| {
        &mut it.core.shader_storage_image_write_without_format
    }),
    ("shaderImageGatherExtended", "gathers with offsets that vary or differ", |it| {
        &mut it.core.shader_image_gather_extended
    }),
    ("shaderDrawParameters", "the base vertex, base instance and number of a draw", |it| {
        &mut it.v1_1.shader_draw_parameters
    }),
    ("shaderCullDistance", "triangles that a vertex shader leaves out", |it| &mut it.core.shader_cull_distance),
    ("fragmentShaderBarycentric", "places within a triangle, in fragment shaders", |it| {
        &mut it.of_extensions.barycentric.fragment_shader_barycentric
    }),
    ("vertexAttributeInstanceRateDivisor", "vertex attributes that several instances share", |it| {
        &mut it.of_extensions.divisor.vertex_attribute_instance_rate_divisor
    }),
    ("bufferDeviceAddress", "addresses of buffers, which shaders follow", |it| &mut it.v1_2.buffer_device_address),
    ("rayQuery", "rays that shaders trace", |it| &mut it.of_extensions.ray_query.ray_query),
    ("accelerationStructure", "acceleration structures, which rays are traced through", |it| {
        &mut it.of_extensions.structures.acceleration_structure
    }),
    (
        "descriptorBindingAccelerationStructureUpdateAfterBind",
        "acceleration structures that are written after their set was bound",
        |it| &mut it.of_extensions.structures.descriptor_binding_acceleration_structure_update_after_bind,
    ),
    ("rayTracingPipeline", "ray-tracing pipelines of custom passes", |it| {
        &mut it.of_extensions.ray_tracing.ray_tracing_pipeline
    }),
    (
        "rayTracingMaintenance1",
        "copies of acceleration structures, and shader binding tables, in custom passes",
        |it| &mut it.of_extensions.tracing_maintenance.ray_tracing_maintenance1,
    ),
    ("attachmentFragmentShadingRate", "images of shading rates, in custom passes", |it| {
        &mut it.of_extensions.shading_rates.attachment_fragment_shading_rate
    }),
    ("taskShader", "task shaders of custom passes", |it| &mut it.of_extensions.mesh.task_shader),
    ("meshShader", "mesh shaders of custom passes", |it| &mut it.of_extensions.mesh.mesh_shader),
    ("geometryShader", "numbers of primitives in fragment shaders", |it| &mut it.core.geometry_shader),
    ("shaderSubgroupExtendedTypes", "operations of subgroups on numbers that don't have 32 bits", |it| {
        &mut it.v1_2.shader_subgroup_extended_types
    }),
    ("shaderIntegerDotProduct", "dot products of integers", |it| &mut it.v1_3.shader_integer_dot_product),
    ("vulkanMemoryModel", "shaders of the Vulkan memory model", |it| &mut it.v1_2.vulkan_memory_model),
    ("vulkanMemoryModelDeviceScope", "what other workgroups see, in the Vulkan memory model", |it| {
        &mut it.v1_2.vulkan_memory_model_device_scope
    }),
];
