//! Barriers, as the Plan writes them and as the executor needs them beside it.

use crate::base::convert;
use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::plan::MemoryBarrier;
use framewright_graph::vulkan::{State, Subresources};

/// Records memory barriers in one call, then image barriers in another: a layout change comes after what its own barrier
/// and those of earlier calls make available. Nothing if there are none.
pub(crate) fn barriers<const N: usize>(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    memory: &[vk::MemoryBarrier2<'_>],
    images: &[vk::ImageMemoryBarrier2<'_>; N],
) {
    if !memory.is_empty() {
        barrier_call(gpu, commands, memory, &[]);
    }
    if !images.is_empty() {
        let stages = images.each_ref().map(stages_of);
        barrier_call(gpu, commands, if gpu.instance.validation.is_some() { &stages } else { &[] }, images);
    }
}

/// Records barriers in one call. An empty list is left out: to a pointer without entries drivers allocate a list without entries.
pub(crate) fn barrier_call(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    memory: &[vk::MemoryBarrier2<'_>],
    images: &[vk::ImageMemoryBarrier2<'_>],
) {
    let mut info = vk::DependencyInfo::default();
    if !memory.is_empty() {
        info = info.memory_barriers(memory);
    }
    if !images.is_empty() {
        info = info.image_memory_barriers(images);
    }
    // SAFETY: the command buffer is being recorded outside a scope, and the images live.
    unsafe { gpu.raw.cmd_pipeline_barrier2(commands, &info) };
}

/// The stages of an image barrier once more, as a memory barrier without accesses. It orders nothing that the image barrier
/// doesn't order. Validation layers before 1.4.326 believe that an image barrier orders only what uses its own image, and report
/// hazards where a chain of barriers leads through another image.
pub(crate) fn stages_of(barrier: &vk::ImageMemoryBarrier2<'_>) -> vk::MemoryBarrier2<'static> {
    if barrier.src_queue_family_index != barrier.dst_queue_family_index {
        // A change of owner orders one half on each queue.
        return vk::MemoryBarrier2::default();
    }
    vk::MemoryBarrier2::default().src_stage_mask(barrier.src_stage_mask).dst_stage_mask(barrier.dst_stage_mask)
}

/// A memory barrier of a Plan.
pub(crate) fn memory_barrier(barrier: &MemoryBarrier) -> vk::MemoryBarrier2<'static> {
    vk::MemoryBarrier2::default()
        .src_stage_mask(convert::stages(barrier.src_stages))
        .src_access_mask(convert::accesses(barrier.src_accesses))
        .dst_stage_mask(convert::stages(barrier.dst_stages))
        .dst_access_mask(convert::accesses(barrier.dst_accesses))
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
