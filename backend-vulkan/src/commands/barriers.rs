//! Barriers, as the Plan writes them and as the executor needs them beside it.

use crate::base::convert;
use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::plan::MemoryBarrier;
use framewright_graph::vulkan::{State, Subresources};

/// The memory barriers of a step.
pub(crate) fn memory_barriers(barriers: &[MemoryBarrier]) -> Vec<vk::MemoryBarrier2<'static>> {
    barriers
        .iter()
        .map(|it| {
            vk::MemoryBarrier2::default()
                .src_stage_mask(convert::stages(it.src_stages))
                .src_access_mask(convert::accesses(it.src_accesses))
                .dst_stage_mask(convert::stages(it.dst_stages))
                .dst_access_mask(convert::accesses(it.dst_accesses))
        })
        .collect()
}

/// Records memory barriers in one call, then image barriers in another: a layout change comes after what its own barrier
/// and those of earlier calls make available. Nothing if there are none.
pub(crate) fn barriers(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    memory: &[vk::MemoryBarrier2<'_>],
    images: &[vk::ImageMemoryBarrier2<'_>],
) {
    let record = |info: vk::DependencyInfo<'_>| {
        // SAFETY: the command buffer is being recorded outside a scope, and the images live.
        unsafe { gpu.raw.cmd_pipeline_barrier2(commands, &info) };
    };
    if !memory.is_empty() {
        record(vk::DependencyInfo::default().memory_barriers(memory));
    }
    if !images.is_empty() {
        let stages = if gpu.instance.validation.is_some() { stages_of(images) } else { Vec::new() };
        record(vk::DependencyInfo::default().memory_barriers(&stages).image_memory_barriers(images));
    }
}

/// The stages of image barriers once more, as memory barriers without accesses. They order nothing that the image barriers
/// don't order. Validation layers before 1.4.326 believe that an image barrier orders only what uses its own image, and report
/// hazards where a chain of barriers leads through another image.
fn stages_of(images: &[vk::ImageMemoryBarrier2<'_>]) -> Vec<vk::MemoryBarrier2<'static>> {
    // A change of owner orders one half on each queue.
    let keeps_its_owner = |it: &&vk::ImageMemoryBarrier2<'_>| it.src_queue_family_index == it.dst_queue_family_index;
    let stages = |it: &vk::ImageMemoryBarrier2<'_>| {
        vk::MemoryBarrier2::default().src_stage_mask(it.src_stage_mask).dst_stage_mask(it.dst_stage_mask)
    };
    images.iter().filter(keeps_its_owner).map(stages).collect()
}

/// A barrier from one state of an image to another; from the layout `UNDEFINED` nothing is kept.
pub(crate) fn state_change(
    image: vk::Image,
    range: Subresources,
    from: State,
    to: State,
) -> vk::ImageMemoryBarrier2<'static> {
    vk::ImageMemoryBarrier2::default()
        .src_stage_mask(convert::stages(from.stages))
        .src_access_mask(convert::accesses(from.accesses))
        .old_layout(convert::layout(from.layout))
        .dst_stage_mask(convert::stages(to.stages))
        .dst_access_mask(convert::accesses(to.accesses))
        .new_layout(convert::layout(to.layout))
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .image(image)
        .subresource_range(convert::range(range))
}

/// A memory barrier from one state of a buffer to another.
pub(crate) fn memory_change(from: State, to: State) -> vk::MemoryBarrier2<'static> {
    vk::MemoryBarrier2::default()
        .src_stage_mask(convert::stages(from.stages))
        .src_access_mask(convert::accesses(from.accesses))
        .dst_stage_mask(convert::stages(to.stages))
        .dst_access_mask(convert::accesses(to.accesses))
}
