//! Commands that were prepared.

use super::barriers::Barriers;
use super::transfer::{ImageSide, TransferSide, blit, copy_between, fill, resolve};
use crate::base::Clear;
use crate::gpu::Gpu;
use ash::vk;

/// A command outside of scopes, ready to be recorded as often as needed.
pub(crate) enum Command {
    Barriers(Barriers),
    Copy(TransferSide, TransferSide),
    Resolve(ImageSide, ImageSide),
    Blit(ImageSide, ImageSide, vk::Filter),
    Fill(TransferSide, Clear),
}

impl Command {
    /// Records it.
    pub(crate) fn record(&self, gpu: &Gpu, commands: vk::CommandBuffer) {
        match self {
            Command::Barriers(barriers) => barriers.record(gpu, commands),
            Command::Copy(source, target) => copy_between(gpu, commands, *source, *target),
            Command::Resolve(source, target) => resolve(gpu, commands, *source, *target),
            Command::Blit(source, target, filter) => blit(gpu, commands, *source, *target, *filter),
            Command::Fill(target, value) => fill(gpu, commands, *target, *value),
        }
    }
}
