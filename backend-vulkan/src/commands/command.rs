//! A command that was prepared.

use super::barriers::Barriers;
use super::transfer::Transfer;
use crate::gpu::Gpu;
use ash::vk;

/// A command outside of scopes, ready to be recorded as often as needed.
pub(crate) enum Command {
    Barriers(Barriers),
    Transfer(Transfer),
}

impl Command {
    /// Records it.
    pub(crate) fn record(&self, gpu: &Gpu, commands: vk::CommandBuffer) {
        match self {
            Command::Barriers(barriers) => barriers.record(gpu, commands),
            Command::Transfer(transfer) => transfer.record(gpu, commands),
        }
    }
}
