//! A frame becomes a Plan: one file or folder per stage, each a function from data to data.
//!
//! ```text
//! rotate ─► validate ─► parts ─► link ─► cull ─► fit ─► adapt ─► schedule ─► scope ─► queues ─► retain ─► timeline ─► usage
//!       ─► place ─► aliasing ─► barriers ─► emit
//! ```
//!
//! `stages` runs them. `incremental` keeps their decisions from frame to frame.

use crate::base::Diagnostic;
use crate::device::{MemoryProvider, Profile};
use crate::frame::{Frame, tracked_parts as parts};
use crate::plan::Plan;

mod access_chain;
mod adapt;
mod cadence;
mod cull;
mod emit;
mod fit;
pub mod heap_size;
mod history_ring;
mod incremental;
mod link;
mod memory;
mod model;
mod options;
mod queues;
mod retain;
mod rotate;
mod schedule;
mod scope;
pub mod shaders;
mod sizes;
mod stages;
mod steps;
mod sync;
mod usage;
mod validate;

pub use incremental::{Compiler, Reuse};
pub use options::{Options, Order};

/// Finds out how `frame` is made on `device`.
///
/// Deterministic: equal input gives an equal Plan.
///
/// # Errors
/// Everything that is wrong with the frame itself, or that the device can't do, with places.
pub fn compile(
    frame: &Frame,
    device: &Profile,
    memory: &mut dyn MemoryProvider,
    options: &Options,
) -> Result<Plan, Vec<Diagnostic>> {
    let turned = rotate::rotate(frame)?;
    let frame = turned.as_ref().unwrap_or(frame);
    let (decisions, substitute) = stages::decide(frame, device, memory, options)?;
    Ok(emit::emit(substitute.as_ref().unwrap_or(frame), device, &decisions))
}
