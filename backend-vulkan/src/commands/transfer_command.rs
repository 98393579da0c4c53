//! Transfers that were prepared.

use super::transfer::{ImageSide, TransferSide, blit, copy_between, fill, resolve};
use crate::base::Clear;
use crate::gpu::Gpu;
use ash::vk;

/// A copy, resolve, blit or fill, ready to be recorded as often as needed.
pub(crate) enum TransferCommand {
    Copy(TransferSide, TransferSide),
    Resolve(ImageSide, ImageSide),
    Blit(ImageSide, ImageSide, vk::Filter),
    Fill(TransferSide, Clear),
}

impl TransferCommand {
    /// Records it.
    pub(crate) fn record(&self, gpu: &Gpu, commands: vk::CommandBuffer) {
        match self {
            TransferCommand::Copy(source, target) => copy_between(gpu, commands, *source, *target),
            TransferCommand::Resolve(source, target) => resolve(gpu, commands, *source, *target),
            TransferCommand::Blit(source, target, filter) => blit(gpu, commands, *source, *target, *filter),
            TransferCommand::Fill(target, value) => fill(gpu, commands, *target, *value),
        }
    }
}
