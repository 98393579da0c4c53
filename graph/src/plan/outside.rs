//! Outside owners: images and buffers that somebody else than this device has between frames.
//!
//! A frame takes such an image or buffer over before its first use, and gives it back after its last. Each is one half of a queue family
//! ownership transfer. The owner makes the other half, in the same layout; semaphores order the two.

use super::Resource;
use crate::vulkan::{OutsideOwner, State};
use serde::{Deserialize, Serialize};

/// One half of a queue family ownership transfer between a step's queue and an outside owner: a barrier in a call of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutsideTransfer {
    /// The image, with all its parts, or the buffer.
    pub resource: Resource,
    /// Who gives or gets it.
    pub owner: OutsideOwner,
    /// Which half it is.
    pub way: OutsideWay,
    /// The stages and accesses of this device that it comes before, or after. The layout stays; of a buffer it is `UNDEFINED`.
    pub state: State,
}

/// The two ways of a transfer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutsideWay {
    /// From the owner, before the barriers and the work of the step.
    Acquire,
    /// To the owner, after the work of the step.
    Release,
}
