//! Breadcrumbs: the step that the device came to, in memory of the host's.

use crate::base::Error;
use crate::commands::barrier_call;
use crate::gpu::Gpu;
use crate::memory::{MemoryUse, RawBuffer};
use ash::vk;
use std::sync::Arc;

/// A word for each batch of a frame: 0, one more than the number of the step that began last, or [`ENDED`].
pub(crate) struct Breadcrumbs {
    gpu: Arc<Gpu>,
    words: RawBuffer,
    batches: usize,
    /// The batch that is being recorded.
    batch: usize,
}

/// The word of a batch that ended.
const ENDED: u32 = u32::MAX;

impl Breadcrumbs {
    /// Breadcrumbs for frames of this number of batches, each a command buffer.
    pub(crate) fn new(gpu: &Arc<Gpu>, batches: usize) -> Result<Breadcrumbs, Error> {
        let bytes = 4 * batches.max(1) as u64;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let words = RawBuffer::shared(gpu, "breadcrumbs", bytes, usage, MemoryUse::Readback)?;
        Ok(Breadcrumbs { gpu: gpu.clone(), words, batches, batch: 0 })
    }

    /// Takes those of the frame before away, which must have been waited for.
    pub(crate) fn begin_frame(&mut self) -> Result<(), Error> {
        self.batch = 0;
        self.words.clear()
    }

    /// Notes in the command buffer that a step begins. It begins when all before it is done, so that no later one can be the cause of
    /// what goes wrong.
    pub(crate) fn begin_step(&self, commands: vk::CommandBuffer, step: usize) {
        self.note(commands, u32::try_from(step + 1).unwrap_or(ENDED - 1));
    }

    /// Notes that a batch ends.
    pub(crate) fn end_batch(&mut self, commands: vk::CommandBuffer) {
        self.note(commands, ENDED);
        self.batch += 1;
    }

    fn note(&self, commands: vk::CommandBuffer, word: u32) {
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let before = vk::MemoryBarrier2::default()
            .src_stage_mask(all)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
            .dst_access_mask(vk::AccessFlags2::TRANSFER_WRITE);
        let after = vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
            .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
            .dst_stage_mask(all | vk::PipelineStageFlags2::HOST)
            .dst_access_mask(vk::AccessFlags2::HOST_READ);
        barrier_call(&self.gpu, commands, &[before], &[]);
        // SAFETY: the command buffer is being recorded outside a scope, and the buffer has a word for each batch.
        unsafe { self.gpu.raw.cmd_fill_buffer(commands, self.words.raw, 4 * self.batch as u64, 4, word) };
        barrier_call(&self.gpu, commands, &[after], &[]);
    }

    /// The steps that began and whose batches haven't ended, by number: one for each queue that is at work. Empty too if the
    /// memory can't be read.
    pub(crate) fn running(&self) -> Vec<usize> {
        let words = self.words.contents(4 * self.batches).unwrap_or_default();
        let words = words.chunks_exact(4).filter_map(|word| word.try_into().ok()).map(u32::from_ne_bytes);
        words.filter(|word| *word != ENDED).filter_map(|word| word.checked_sub(1)).map(|step| step as usize).collect()
    }
}
