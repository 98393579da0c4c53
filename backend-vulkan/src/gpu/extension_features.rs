//! The structures of features that come with an extension of the device.

use ash::{ext, khr, vk};
use std::ffi::CStr;
use std::marker::PhantomData;

/// The extension of the divisor, which the Khronos Group has taken over under a name of its own: either will do.
pub(super) const DIVISOR: &CStr = ext::vertex_attribute_divisor::NAME;

/// Each structure: its field, its type, its extension, the number that tells its type, and the flags that are used of it.
macro_rules! structures {
    ($($field:ident: $structure:ident, $extension:expr, $kind:ident, $($flag:ident)|+;)*) => {
        /// Features that come with an extension of the device.
        #[derive(Clone, Copy, Default)]
        pub(crate) struct ExtensionFeatures {
            $(pub(super) $field: vk::$structure<'static>,)*
        }

        impl ExtensionFeatures {
            /// Adds structures to a chain: those of which `wanted` says so, by whether any of their flags is set, and by their extension.
            pub(super) fn chain<'c>(
                &'c mut self,
                mut chain: vk::PhysicalDeviceFeatures2<'c>,
                wanted: impl Fn(bool, &CStr) -> bool,
            ) -> vk::PhysicalDeviceFeatures2<'c> {
                $(
                    let is_on = [$(self.$field.$flag),+].contains(&vk::TRUE);
                    // An earlier chain is taken apart.
                    self.$field.p_next = std::ptr::null_mut();
                    if wanted(is_on, $extension) {
                        chain = chain.push_next(&mut self.$field);
                    }
                )*
                chain
            }

            /// The same, chained to nothing.
            pub(super) fn unchained(mut self) -> ExtensionFeatures {
                $(self.$field.p_next = std::ptr::null_mut();)*
                self
            }

            /// Takes over a structure, if it is one of these.
            ///
            /// # Safety
            /// It is of the type that it says.
            pub(super) unsafe fn take(&mut self, structure: &vk::BaseInStructure<'_>) {
                match structure.s_type {
                    $(vk::StructureType::$kind => {
                        let given = std::ptr::from_ref(structure).cast::<vk::$structure<'_>>();
                        // SAFETY: the caller's word.
                        let given = unsafe { &*given };
                        self.$field =
                            vk::$structure { p_next: std::ptr::null_mut(), _marker: PhantomData, ..*given };
                    })*
                    _ => {}
                }
            }
        }
    };
}

structures! {
    local_read: PhysicalDeviceDynamicRenderingLocalReadFeaturesKHR, khr::dynamic_rendering_local_read::NAME,
        PHYSICAL_DEVICE_DYNAMIC_RENDERING_LOCAL_READ_FEATURES_KHR, dynamic_rendering_local_read;
    barycentric: PhysicalDeviceFragmentShaderBarycentricFeaturesKHR, khr::fragment_shader_barycentric::NAME,
        PHYSICAL_DEVICE_FRAGMENT_SHADER_BARYCENTRIC_FEATURES_KHR, fragment_shader_barycentric;
    divisor: PhysicalDeviceVertexAttributeDivisorFeaturesKHR, DIVISOR,
        PHYSICAL_DEVICE_VERTEX_ATTRIBUTE_DIVISOR_FEATURES_KHR, vertex_attribute_instance_rate_divisor;
    structures: PhysicalDeviceAccelerationStructureFeaturesKHR, khr::acceleration_structure::NAME,
        PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR,
        acceleration_structure | descriptor_binding_acceleration_structure_update_after_bind;
    ray_query: PhysicalDeviceRayQueryFeaturesKHR, khr::ray_query::NAME, PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR, ray_query;
    ray_tracing: PhysicalDeviceRayTracingPipelineFeaturesKHR, khr::ray_tracing_pipeline::NAME,
        PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR, ray_tracing_pipeline;
    tracing_maintenance: PhysicalDeviceRayTracingMaintenance1FeaturesKHR, khr::ray_tracing_maintenance1::NAME,
        PHYSICAL_DEVICE_RAY_TRACING_MAINTENANCE_1_FEATURES_KHR, ray_tracing_maintenance1;
    shading_rates: PhysicalDeviceFragmentShadingRateFeaturesKHR, khr::fragment_shading_rate::NAME,
        PHYSICAL_DEVICE_FRAGMENT_SHADING_RATE_FEATURES_KHR, attachment_fragment_shading_rate;
    mesh: PhysicalDeviceMeshShaderFeaturesEXT, ext::mesh_shader::NAME,
        PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT, task_shader | mesh_shader;
}
