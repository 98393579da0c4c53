//! The extensions of SPIR-V that stages may declare: those that Vulkan 1.3 has, and those of features that devices may have.

use super::module::IndexedModule;
use super::text::{RefusedStage, Words};
use rspirv::dr::Operand;

/// From the appendix "Vulkan Environment for SPIR-V" of Vulkan's specification. What an extension brings takes a capability, or is
/// harmless. The last two need extensions of Vulkan's, whose features the capabilities ask for.
const ALLOWED: [&str; 20] = [
    "SPV_KHR_16bit_storage",
    "SPV_KHR_8bit_storage",
    "SPV_KHR_device_group",
    "SPV_KHR_float_controls",
    "SPV_KHR_integer_dot_product",
    "SPV_KHR_multiview",
    "SPV_KHR_no_integer_wrap_decoration",
    "SPV_KHR_non_semantic_info",
    "SPV_KHR_physical_storage_buffer",
    "SPV_EXT_physical_storage_buffer",
    "SPV_KHR_shader_draw_parameters",
    "SPV_KHR_storage_buffer_storage_class",
    "SPV_KHR_terminate_invocation",
    "SPV_KHR_variable_pointers",
    "SPV_KHR_vulkan_memory_model",
    "SPV_EXT_demote_to_helper_invocation",
    "SPV_EXT_descriptor_indexing",
    "SPV_EXT_shader_viewport_index_layer",
    "SPV_KHR_fragment_shader_barycentric",
    "SPV_KHR_ray_query",
];

/// Refuses other extensions, with the word of the text that asks for it.
///
/// # Errors
/// The first of them.
pub(super) fn check_extensions(module: &IndexedModule<'_>) -> Result<(), RefusedStage> {
    let declared = module.module.extensions.iter().filter_map(|it| match it.operands.first() {
        Some(Operand::LiteralString(name)) => Some(name.as_str()),
        _ => None,
    });
    let Some(other) = declared.into_iter().find(|name| !ALLOWED.contains(name)) else { return Ok(()) };
    // GL_EXT_subgroup_uniform_control_flow asks for SPV_KHR_subgroup_uniform_control_flow.
    let words = other.splitn(3, '_').nth(2).map_or(Words::None, |name| Words::Ending(name.to_ascii_lowercase()));
    Err(RefusedStage::shown_by(
        words,
        format!("it needs SPIR-V's extension {other}, which isn't supported: do without it"),
    ))
}
