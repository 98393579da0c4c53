//! Switches of the compiler.

use serde::{Deserialize, Serialize};

/// Switches of the compiler that never change the meaning of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Options {
    /// Whether transient images share memory.
    pub alias: bool,
    /// Whether images and buffers can be filled with poison where what they held is given up: adds `TRANSFER_DST`, and leaves no image
    /// `TRANSIENT_ATTACHMENT`, which excludes it.
    pub poison: bool,
    /// Whether images and buffers that live within the frame can be read and written between steps, as an executor does that holds custom
    /// passes against what they name: adds `TRANSFER_SRC` and `TRANSFER_DST`, and leaves no image `TRANSIENT_ATTACHMENT`.
    pub readable: bool,
    /// The order of execution.
    pub order: Order,
    /// Whether full-screen draws that gain nothing from several samples move to single-sampled images.
    pub demote: bool,
    /// Whether queues beside the first are used, where the device has them.
    pub queues: bool,
}

/// Which of the valid orders is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Order {
    /// That of the file.
    File,
    /// The one that scores best.
    #[default]
    Default,
    /// One that keeps little memory alive.
    LowMemory,
    /// Any, the same for the same seed.
    Random(u64),
}

impl Default for Options {
    fn default() -> Options {
        Options { alias: true, poison: false, readable: false, order: Order::Default, demote: true, queues: true }
    }
}
