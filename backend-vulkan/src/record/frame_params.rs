//! Values of parameters that each frame has its own of: they are written on the way, so that frames on their way keep theirs.

use crate::commands::barrier_call;
use crate::gpu::Gpu;
use crate::prepare::{FrameClock, FrameParam};
use ash::vk;

/// Writes the values of a step's parameters behind all reads of them before, and ahead of those that follow.
pub(super) fn write(gpu: &Gpu, commands: vk::CommandBuffer, params: &[FrameParam], clock: FrameClock) {
    let all = vk::PipelineStageFlags2::ALL_COMMANDS;
    let before = vk::MemoryBarrier2::default()
        .src_stage_mask(all)
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
        .dst_access_mask(vk::AccessFlags2::TRANSFER_WRITE);
    let after = vk::MemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .dst_stage_mask(all)
        .dst_access_mask(vk::AccessFlags2::UNIFORM_READ | vk::AccessFlags2::TRANSFER_WRITE);
    barrier_call(gpu, commands, &[before], &[]);
    for param in params {
        let word = clock.word(param.value);
        // SAFETY: the command buffer is being recorded outside a scope, and the block was made to be written, and holds the word.
        unsafe { gpu.raw.cmd_update_buffer(commands, param.buffer, param.offset, &word) };
    }
    barrier_call(gpu, commands, &[after], &[]);
}
