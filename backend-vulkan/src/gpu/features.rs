//! The features that a device must have, and those that are used where it has them.

use super::buffer_bounds::BufferBounds;
use super::extension_features::{DIVISOR, ExtensionFeatures};
use super::minimum::has_extensions;
use super::needed_features::NEEDED_FEATURES;
use ash::{ext, khr, vk};
use std::ffi::CStr;

/// Feature structures in the order in which they are chained.
#[derive(Default)]
pub(crate) struct Features {
    pub(super) core: vk::PhysicalDeviceFeatures,
    pub(super) v1_1: vk::PhysicalDeviceVulkan11Features<'static>,
    pub(super) v1_2: vk::PhysicalDeviceVulkan12Features<'static>,
    pub(super) v1_3: vk::PhysicalDeviceVulkan13Features<'static>,
    pub(super) of_extensions: ExtensionFeatures,
    /// Whether the divisor comes with the extension of the Khronos Group alone.
    pub(super) khr_divisor: bool,
    pub(super) subgroups: Subgroups,
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
pub(super) type Flag = fn(&mut Features) -> &mut vk::Bool32;

/// A feature that is used where a device has it: Vulkan's name, the purpose, the flag.
pub(super) type OptionalFeature = (&'static str, &'static str, Flag);

/// What keeps files and shaders of strangers within their buffers.
pub(super) const ROBUST: &str = "robustBufferAccess";

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

/// Profiles tell of it by whether there are local reads.
const LOCAL_READ: &str = "dynamicRenderingLocalRead";
/// Profiles tell of it by the number of clip distances.
const CLIP_DISTANCE: &str = "shaderClipDistance";

/// What is used beyond the minimum: Vulkan's name, the purpose, the flag. Local reads stand apart: they are no row of profiles.
const OPTIONAL_FEATURES: [OptionalFeature; 4] = [
    (CLIP_DISTANCE, "clip distances; two eyes in one draw, side by side", |it| &mut it.core.shader_clip_distance),
    ("pipelineStatisticsQuery", "counts of fragment shaders that ran", |it| &mut it.core.pipeline_statistics_query),
    ("multiview", "two eyes in one draw, in layers", |it| &mut it.v1_1.multiview),
    ("shaderOutputLayer", "two eyes by instances, in layers", |it| &mut it.v1_2.shader_output_layer),
];

/// Features that come with an extension of the device: its name, and the flag. They are used where a device has them.
const OF_EXTENSIONS: [(&CStr, Flag); 11] = [
    (khr::dynamic_rendering_local_read::NAME, LOCAL_READ_FLAG),
    (khr::fragment_shader_barycentric::NAME, |it| &mut it.of_extensions.barycentric.fragment_shader_barycentric),
    (DIVISOR, |it| &mut it.of_extensions.divisor.vertex_attribute_instance_rate_divisor),
    (STRUCTURES, |it| &mut it.of_extensions.structures.acceleration_structure),
    (STRUCTURES, |it| &mut it.of_extensions.structures.descriptor_binding_acceleration_structure_update_after_bind),
    (khr::ray_query::NAME, |it| &mut it.of_extensions.ray_query.ray_query),
    (khr::ray_tracing_pipeline::NAME, |it| &mut it.of_extensions.ray_tracing.ray_tracing_pipeline),
    (khr::ray_tracing_maintenance1::NAME, |it| &mut it.of_extensions.tracing_maintenance.ray_tracing_maintenance1),
    (khr::fragment_shading_rate::NAME, |it| &mut it.of_extensions.shading_rates.attachment_fragment_shading_rate),
    (ext::mesh_shader::NAME, |it| &mut it.of_extensions.mesh.task_shader),
    (ext::mesh_shader::NAME, |it| &mut it.of_extensions.mesh.mesh_shader),
];

/// The extension of acceleration structures, which asks for one more, and on which those of rays build.
const STRUCTURES: &CStr = khr::acceleration_structure::NAME;

const LOCAL_READ_FLAG: Flag = |it| &mut it.of_extensions.local_read.dynamic_rendering_local_read;

/// What Vulkan wants switched on together with a feature: its name, that of the other one. A row comes before those that it leads to.
const TOGETHER: [(&str, &str); 6] = [
    ("taskShader", "meshShader"),
    ("rayQuery", "accelerationStructure"),
    ("rayTracingPipeline", "accelerationStructure"),
    ("rayTracingMaintenance1", "accelerationStructure"),
    ("descriptorBindingAccelerationStructureUpdateAfterBind", "accelerationStructure"),
    ("accelerationStructure", "bufferDeviceAddress"),
];

/// All names that [`Features::has`] knows.
pub(super) fn known_features() -> impl Iterator<Item = &'static str> {
    let optional = optional_features().map(|(name, _)| name);
    minimum_features().chain(optional).chain([LOCAL_READ]).chain(SUBGROUPS.iter().map(|(name, _)| *name))
}

/// The flag of a feature, by Vulkan's name.
fn flag(name: &str) -> Option<Flag> {
    let minimum = MINIMUM_FEATURES.iter().find(|(known, _)| *known == name).map(|(_, flag)| *flag);
    let optional = || OPTIONAL_FEATURES.iter().chain(&NEEDED_FEATURES).find(|(known, ..)| *known == name);
    minimum.or_else(|| optional().map(|(.., flag)| *flag)).or_else(|| (name == LOCAL_READ).then_some(LOCAL_READ_FLAG))
}

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
    /// The features that `physical` has together with `robustBufferAccess`.
    pub(crate) fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Features {
        Features::with_bounds(instance, physical, BufferBounds::CHECKED)
    }

    /// The features of `physical`. With unchecked bounds `robustBufferAccess` isn't among them.
    pub(super) fn with_bounds(
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        bounds: BufferBounds,
    ) -> Features {
        let mut v1_1 = vk::PhysicalDeviceVulkan11Features::default();
        let mut v1_2 = vk::PhysicalDeviceVulkan12Features::default();
        let mut v1_3 = vk::PhysicalDeviceVulkan13Features::default();
        let mut of_extensions = ExtensionFeatures::default();
        let names = OF_EXTENSIONS.map(|(name, _)| name);
        let there = has_extensions(instance, physical, names);
        let has = |name: &CStr| names.iter().zip(there).any(|(known, there)| there && *known == name);
        let [has_khr_divisor] = has_extensions(instance, physical, [khr::vertex_attribute_divisor::NAME]);
        let mut all = vk::PhysicalDeviceFeatures2::default();
        all = all.push_next(&mut v1_1).push_next(&mut v1_2).push_next(&mut v1_3);
        all = of_extensions.chain(all, |_, name| has(name) || name == DIVISOR && has_khr_divisor);
        // SAFETY: `physical` belongs to `instance`, and the chained structures outlive the call.
        unsafe { instance.get_physical_device_features2(physical, &mut all) };
        let mut core = all.features;
        v1_1.p_next = std::ptr::null_mut();
        v1_2.p_next = std::ptr::null_mut();
        v1_3.p_next = std::ptr::null_mut();
        let subgroups = Subgroups::of(instance, physical);
        match bounds.are_checked() {
            true => without_unchecked(instance, physical, &mut v1_2),
            false => core.robust_buffer_access = vk::FALSE,
        }
        let khr_divisor = has_khr_divisor && !has(DIVISOR);
        Features { core, v1_1, v1_2, v1_3, of_extensions: of_extensions.unchained(), khr_divisor, subgroups }
    }

    /// The features that are switched on: those of the minimum, what [`optional_features`] lists beyond it, and local
    /// reads, as far as the device has them. `extensions`: whether the device may have this extension switched on.
    pub(crate) fn used(mut has: Features, extensions: impl Fn(&CStr) -> bool) -> Features {
        let khr_divisor = |name: &CStr| name == DIVISOR && extensions(khr::vertex_attribute_divisor::NAME);
        for (name, flag) in OF_EXTENSIONS {
            *flag(&mut has) &= vk::Bool32::from(extensions(name) || khr_divisor(name));
        }
        let mut features = Features { khr_divisor: has.khr_divisor, ..Features::default() };
        for (_, flag) in MINIMUM_FEATURES {
            *flag(&mut features) = *flag(&mut has);
        }
        for (_, _, flag) in OPTIONAL_FEATURES.into_iter().chain(NEEDED_FEATURES) {
            *flag(&mut features) = *flag(&mut has);
        }
        for (_, flag) in OF_EXTENSIONS {
            *flag(&mut features) = *flag(&mut has);
        }
        // With the memory model, atomic operations of all shaders are bound to a workgroup unless this is on too.
        features.v1_2.vulkan_memory_model &= features.v1_2.vulkan_memory_model_device_scope;
        features.subgroups = has.subgroups;
        features
    }

    /// Features of the minimum that are switched off, by Vulkan's names.
    pub(crate) fn missing(&self) -> Vec<&'static str> {
        let mut all = self.copy();
        MINIMUM_FEATURES.iter().filter(|(_, flag)| *flag(&mut all) == vk::FALSE).map(|(name, _)| *name).collect()
    }

    /// Whether a feature is switched on, or a property of subgroups is there. `name` is Vulkan's.
    pub(crate) fn has(&self, name: &str) -> bool {
        let property = || SUBGROUPS.into_iter().any(|(known, has)| known == name && has(self.subgroups));
        flag(name).map_or_else(property, |flag| *flag(&mut self.copy()) == vk::TRUE)
    }

    /// Those of these features alone, as far as `self` has them, and what Vulkan wants together with them.
    pub(super) fn only(&self, names: &[&str]) -> Features {
        let (subgroups, khr_divisor) = (self.subgroups, self.khr_divisor);
        let mut features = Features { subgroups, khr_divisor, ..Features::default() };
        let mut names = names.to_vec();
        for (name, other) in TOGETHER {
            names.extend(names.contains(&name).then_some(other));
        }
        for flag in names.iter().filter_map(|name| flag(name)) {
            *flag(&mut features) = *flag(&mut self.copy());
        }
        // `used` has one only with the other.
        features.v1_2.vulkan_memory_model_device_scope |= features.v1_2.vulkan_memory_model;
        features
    }

    /// A copy, chained to nothing.
    pub(crate) fn copy(&self) -> Features {
        let Features { core, v1_1, v1_2, v1_3, of_extensions, khr_divisor, subgroups } = *self;
        Features { core, v1_1, v1_2, v1_3, of_extensions: of_extensions.unchained(), khr_divisor, subgroups }
    }

    /// The device's extensions that the features come with.
    pub(crate) fn extensions(&self) -> Vec<&'static CStr> {
        let mut all = self.copy();
        let on = OF_EXTENSIONS.into_iter().filter(|(_, flag)| *flag(&mut all) == vk::TRUE);
        let named = |name| if name == DIVISOR && self.khr_divisor { khr::vertex_attribute_divisor::NAME } else { name };
        let mut names: Vec<&CStr> = on.map(|(name, _)| named(name)).collect();
        // Those of one extension stand side by side.
        names.dedup();
        names.extend(names.contains(&STRUCTURES).then_some(khr::deferred_host_operations::NAME));
        names
    }

    /// Vulkan's names of the features that are switched on, and that pipelines can need.
    pub(crate) fn needed(&self) -> impl Iterator<Item = &'static str> {
        let (mut all, subgroups) = (self.copy(), self.subgroups);
        let features = NEEDED_FEATURES
            .into_iter()
            .filter_map(move |(name, _, flag)| (*flag(&mut all) == vk::TRUE).then_some(name));
        features.chain(SUBGROUPS.into_iter().filter(move |(_, has)| has(subgroups)).map(|(name, _)| name))
    }

    /// Whether fragment shaders can read what their rendering scope drew.
    pub(crate) fn local_read(&self) -> bool {
        self.of_extensions.local_read.dynamic_rendering_local_read == vk::TRUE
    }

    /// Whether draws and shaders are kept within their buffers.
    pub(crate) fn bounds(&self) -> bool {
        self.core.robust_buffer_access == vk::TRUE
    }

    /// Whether buffers can have addresses.
    pub(crate) fn addresses(&self) -> bool {
        self.v1_2.buffer_device_address == vk::TRUE
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
        let chain = vk::PhysicalDeviceFeatures2::default().features(self.core);
        let chain = chain.push_next(&mut self.v1_1).push_next(&mut self.v1_2).push_next(&mut self.v1_3);
        self.of_extensions.chain(chain, |is_on, _| is_on)
    }
}

impl Subgroups {
    /// What `physical` can do.
    pub(super) fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Subgroups {
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

/// Takes away what a device can't do together with `robustBufferAccess`: some can't check the bounds of buffers
/// that are written after their set was bound.
fn without_unchecked(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    features: &mut vk::PhysicalDeviceVulkan12Features<'_>,
) {
    let mut v1_2 = vk::PhysicalDeviceVulkan12Properties::default();
    let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut v1_2);
    // SAFETY: `physical` belongs to `instance`, and the chained structure outlives the call.
    unsafe { instance.get_physical_device_properties2(physical, &mut all) };
    if v1_2.robust_buffer_access_update_after_bind == vk::TRUE {
        return;
    }
    features.descriptor_binding_uniform_buffer_update_after_bind = vk::FALSE;
    features.descriptor_binding_storage_buffer_update_after_bind = vk::FALSE;
    features.descriptor_binding_uniform_texel_buffer_update_after_bind = vk::FALSE;
    features.descriptor_binding_storage_texel_buffer_update_after_bind = vk::FALSE;
}
