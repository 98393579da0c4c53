//! A frame becomes a Plan: one file per stage, each a function from data to data.
//!
//! ```text
//! rotate ─► validate ─► parts ─► link ─► cull ─► fit ─► adapt ─► schedule ─► scope ─► retain ─► queues
//!       ─► synchronise ─► outlive ─► usage ─► place ─► occupy ─► take_over ─► batch
//!       ─► redundant ─► hand_over ─► emit
//! ```
//!
//! `place` stands between the halves of `synchronise`: how long something lives and what it is made for is known once all
//! steps have been walked, and what its first use waits for (`take_over`) once it has a place. `structure` runs the stages,
//! those before `place` by themselves since they don't depend on sizes. `compiler` keeps what they found from frame to frame.

use crate::base::Diagnostic;
use crate::device::{MemoryProvider, Profile};
use crate::frame::Frame;
use crate::plan::Plan;
use emit::Parts;
use structure::Structure;

mod adapt;
mod batch;
mod compiler;
mod cull;
mod emit;
mod fit;
mod hand_over;
pub mod heap_size;
mod last_uses;
mod link;
mod model;
mod occupy;
mod options;
mod outlive;
mod pack;
mod parts;
mod place;
mod queues;
mod redundant;
mod retain;
mod rotate;
mod schedule;
mod scope;
mod structure;
mod synchronise;
mod take_over;
mod usage;
mod validate;

pub use compiler::{Compiler, Reuse};
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
    let (mut structure, substitute) = Structure::find_with_fallback(frame, device, options, false)?;
    let mut settled = structure.settle_for_good(device, memory, options)?;
    let frame = substitute.as_ref().unwrap_or(frame);
    let resources = emit::resources(frame, &structure, &settled);
    // What only those took needn't lie beside the steps.
    (structure.states, settled.placed.placements) = (Vec::new(), Vec::new());
    Ok(emit::emit(&Parts::new(frame, device, &structure, &settled), resources))
}
