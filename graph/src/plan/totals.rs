//! Sums over a Plan.

use serde::{Deserialize, Serialize};

/// Sums over a Plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Totals {
    /// Passes that the file says and the Plan runs.
    pub passes: u32,
    /// Passes that the compiler inserted.
    pub inserted_passes: u32,
    /// Rendering scopes.
    pub scopes: u32,
    /// Resolves, folded into a scope and standalone.
    pub resolves: u32,
    /// Resolves folded into a scope.
    pub folded_resolves: u32,
    /// Copies.
    pub copies: u32,
    /// Calls of `vkCmdPipelineBarrier2`: steps with barriers.
    pub barrier_calls: u32,
    /// Image barriers.
    pub image_barriers: u32,
    /// Memory barriers.
    pub memory_barriers: u32,
    /// Bytes of all transient images, if each had memory of its own.
    pub transient_bytes: u64,
    /// Bytes of the heaps.
    pub placed_bytes: u64,
    /// Largest total of transient images alive at one step: no placement can need less.
    pub live_peak_bytes: u64,
    /// Bytes of output images.
    pub output_bytes: u64,
}
