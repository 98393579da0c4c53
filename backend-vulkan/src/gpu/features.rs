//! The features that a device must have, and those that are used where it has them.

use ash::vk;
use std::marker::PhantomData;

/// Feature structures in the order in which they are chained.
#[derive(Default)]
pub(crate) struct Features {
    core: vk::PhysicalDeviceFeatures,
    v1_1: vk::PhysicalDeviceVulkan11Features<'static>,
    v1_2: vk::PhysicalDeviceVulkan12Features<'static>,
    v1_3: vk::PhysicalDeviceVulkan13Features<'static>,
    local_read: vk::PhysicalDeviceDynamicRenderingLocalReadFeaturesKHR<'static>,
    subgroups: Subgroups,
}

/// What a device can do with subgroups. No feature switches it on.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Subgroups {
    operations: vk::SubgroupFeatureFlags,
    stages: vk::ShaderStageFlags,
    quads_in_all_stages: bool,
}

/// The features that a device must have beside [`crate::MINIMUM_VERSION`], by Vulkan's names.
pub fn minimum_features() -> impl Iterator<Item = &'static str> {
    MINIMUM_FEATURES.iter().map(|(name, _)| *name)
}

/// The features that are used where a device has them, by Vulkan's names, and what each is for.
pub fn optional_features() -> impl Iterator<Item = (&'static str, &'static str)> {
    OPTIONAL_FEATURES.iter().chain(&NEEDED_FEATURES).map(|(name, purpose, _)| (*name, *purpose))
}

/// Reaches one feature's flag.
type Flag = fn(&mut Features) -> &mut vk::Bool32;

/// A feature that is used where a device has it: Vulkan's name, the purpose, the flag.
type OptionalFeature = (&'static str, &'static str, Flag);

/// The one feature of the minimum that a program may leave out of a device that it makes itself.
const ROBUST: &str = "robustBufferAccess";

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
    // Files and shaders of strangers can't reach beyond their buffers.
    (ROBUST, |it| &mut it.core.robust_buffer_access),
    // Another blend for each attachment.
    ("independentBlend", |it| &mut it.core.independent_blend),
    // Storage images that fragment shaders write.
    ("fragmentStoresAndAtomics", |it| &mut it.core.fragment_stores_and_atomics),
    // Fragment shaders that run once a sample.
    ("sampleRateShading", |it| &mut it.core.sample_rate_shading),
];

/// What is used beyond the minimum: Vulkan's name, the purpose, the flag. Local reads need an extension, and stand apart.
const OPTIONAL_FEATURES: [OptionalFeature; 4] = [
    ("shaderClipDistance", "two eyes in one draw, side by side", |it| &mut it.core.shader_clip_distance),
    ("pipelineStatisticsQuery", "counts of fragment shaders that ran", |it| &mut it.core.pipeline_statistics_query),
    ("multiview", "two eyes in one draw, in layers", |it| &mut it.v1_1.multiview),
    ("shaderOutputLayer", "two eyes by instances, in layers", |it| &mut it.v1_2.shader_output_layer),
];

/// The same that pipelines can need by their shaders and draws: profiles tell of these.
const NEEDED_FEATURES: [OptionalFeature; 37] = [
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
    ("drawIndirectFirstInstance", "draws whose counts, in a buffer, have a first instance that isn't 0", |it| {
        &mut it.core.draw_indirect_first_instance
    }),
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

/// Whether a bit of a device's subgroup properties is set.
type IsSet = fn(Subgroups) -> bool;

/// What devices do with subgroups beyond what each does: Vulkan's name of the property with its bit, and whether it is set.
const SUBGROUPS: [(&str, IsSet); 10] = {
    use vk::{ShaderStageFlags as Stage, SubgroupFeatureFlags as Does};
    [
        ("subgroupSupportedOperations.VOTE", |it| it.operations.contains(Does::VOTE)),
        ("subgroupSupportedOperations.ARITHMETIC", |it| it.operations.contains(Does::ARITHMETIC)),
        ("subgroupSupportedOperations.BALLOT", |it| it.operations.contains(Does::BALLOT)),
        ("subgroupSupportedOperations.SHUFFLE", |it| it.operations.contains(Does::SHUFFLE)),
        ("subgroupSupportedOperations.SHUFFLE_RELATIVE", |it| it.operations.contains(Does::SHUFFLE_RELATIVE)),
        ("subgroupSupportedOperations.CLUSTERED", |it| it.operations.contains(Does::CLUSTERED)),
        ("subgroupSupportedOperations.QUAD", |it| it.operations.contains(Does::QUAD)),
        ("subgroupSupportedStages.VERTEX", |it| it.stages.contains(Stage::VERTEX)),
        ("subgroupSupportedStages.FRAGMENT", |it| it.stages.contains(Stage::FRAGMENT)),
        ("subgroupQuadOperationsInAllStages", |it| it.quads_in_all_stages),
    ]
};

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
        let subgroups = Subgroups::of(instance, physical);
        Features { core, v1_1, v1_2, v1_3, local_read: local, subgroups }
    }

    /// The features that are switched on: the minimum, and beyond it what [`optional_features`] lists, and local
    /// reads, where the device has them.
    pub(crate) fn used(has: &mut Features, local_read: bool) -> Features {
        let mut features = Features::default();
        for (_, flag) in MINIMUM_FEATURES {
            *flag(&mut features) = vk::TRUE;
        }
        for (_, _, flag) in OPTIONAL_FEATURES.into_iter().chain(NEEDED_FEATURES) {
            *flag(&mut features) = *flag(has);
        }
        // With the memory model, atomic operations of all shaders are bound to a workgroup unless this is on too.
        features.v1_2.vulkan_memory_model &= features.v1_2.vulkan_memory_model_device_scope;
        features.local_read.dynamic_rendering_local_read = local_read.into();
        features.subgroups = has.subgroups;
        features
    }

    /// The features in the chain that a device of `physical` was created with. A feature of Vulkan 1.0 to 1.3 may stand in the structure of its version,
    /// or in that of the extension that it comes from.
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
                    let it = read!(PhysicalDeviceDescriptorIndexingFeatures);
                    on.v1_2.shader_sampled_image_array_non_uniform_indexing =
                        it.shader_sampled_image_array_non_uniform_indexing;
                    on.v1_2.shader_storage_image_array_non_uniform_indexing =
                        it.shader_storage_image_array_non_uniform_indexing;
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
                Is::PHYSICAL_DEVICE_DYNAMIC_RENDERING_LOCAL_READ_FEATURES_KHR => {
                    let it = read!(PhysicalDeviceDynamicRenderingLocalReadFeaturesKHR);
                    on.local_read.dynamic_rendering_local_read = it.dynamic_rendering_local_read;
                }
                _ => {}
            }
            next = structure.p_next;
        }
        on
    }

    /// Features of the minimum that the device lacks, by Vulkan's names.
    pub(crate) fn missing(&mut self) -> Vec<&'static str> {
        MINIMUM_FEATURES.iter().filter(|(_, flag)| *flag(self) == vk::FALSE).map(|(name, _)| *name).collect()
    }

    /// The same of a device that the program made, which vouches for its indices: see [`crate::Device::adopt`].
    pub(super) fn missing_of_program(&mut self) -> Vec<&'static str> {
        self.missing().into_iter().filter(|name| *name != ROBUST).collect()
    }

    /// Whether a feature that pipelines can need is switched on. `name` is Vulkan's.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.needed().any(|known| known == name)
    }

    /// Vulkan's names of the features that are switched on, and that pipelines can need.
    pub(crate) fn needed(&self) -> impl Iterator<Item = &'static str> {
        let Features { core, v1_1, v1_2, v1_3, local_read, subgroups } = *self;
        let mut all = Features { core, v1_1, v1_2, v1_3, local_read, subgroups };
        let features = NEEDED_FEATURES
            .into_iter()
            .filter_map(move |(name, _, flag)| (*flag(&mut all) == vk::TRUE).then_some(name));
        features.chain(SUBGROUPS.into_iter().filter(move |(_, has)| has(subgroups)).map(|(name, _)| name))
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

    /// All of them, chained for the creation of a device.
    pub(crate) fn chain(&mut self) -> vk::PhysicalDeviceFeatures2<'_> {
        // An earlier chain is taken apart.
        self.v1_1.p_next = std::ptr::null_mut();
        self.v1_2.p_next = std::ptr::null_mut();
        self.v1_3.p_next = std::ptr::null_mut();
        self.local_read.p_next = std::ptr::null_mut();
        let chain = vk::PhysicalDeviceFeatures2::default().features(self.core);
        let chain = chain.push_next(&mut self.v1_1).push_next(&mut self.v1_2).push_next(&mut self.v1_3);
        match self.local_read.dynamic_rendering_local_read {
            vk::TRUE => chain.push_next(&mut self.local_read),
            _ => chain,
        }
    }
}

impl Subgroups {
    /// What `physical` can do.
    fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Subgroups {
        let mut subgroups = vk::PhysicalDeviceSubgroupProperties::default();
        let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut subgroups);
        // SAFETY: `physical` belongs to `instance`, and the chained structure outlives the call.
        unsafe { instance.get_physical_device_properties2(physical, &mut all) };
        Subgroups {
            operations: subgroups.supported_operations,
            stages: subgroups.supported_stages,
            quads_in_all_stages: subgroups.quad_operations_in_all_stages == vk::TRUE,
        }
    }
}
