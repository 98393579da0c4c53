//! Sets and push constants that belong to a pass.

use crate::gpu::Gpu;
use crate::pipeline::PARTS_STAGES;
use crate::prepare::{Bindings, CommandList};
use ash::vk;

/// Binds a pass's own set, and tells its shaders which parts of images are in use.
pub(super) fn bind(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    point: vk::PipelineBindPoint,
    list: &CommandList,
    bindings: &Bindings,
) {
    if bindings.set != vk::DescriptorSet::null() {
        bind_set(gpu, commands, point, bindings.layout, (0, bindings.set, &[]));
    }
    if !bindings.parts.is_empty() {
        let parts = bindings.parts.of(&list.parts);
        // SAFETY: the command buffer is being recorded, every layout has this range, and no more parts than fit were let
        // through.
        unsafe { gpu.raw.cmd_push_constants(commands, bindings.layout, PARTS_STAGES, 0, parts) };
    }
}

/// Binds a set to a number, where the layout has the set's own layout, with its dynamic offsets.
pub(super) fn bind_set(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    point: vk::PipelineBindPoint,
    layout: vk::PipelineLayout,
    (number, set, offsets): (u32, vk::DescriptorSet, &[u32]),
) {
    let bind = gpu.raw.fp_v1_0().cmd_bind_descriptor_sets;
    // A list of offsets without entries would be allocated by drivers: there is none.
    let first = if offsets.is_empty() { std::ptr::null() } else { offsets.as_ptr() };
    let count = u32::try_from(offsets.len()).unwrap_or(0);
    // SAFETY: the command buffer is being recorded, and the set has the layout that the pipeline layout has at this number, and as many
    // dynamic offsets.
    unsafe { bind(commands, point, layout, number, 1, &raw const set, count, first) };
}
