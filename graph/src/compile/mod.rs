//! A frame becomes a Plan: one file per stage, each a function from data to data.
//!
//! ```text
//! rotate ─► legal ─► parts ─► link ─► cull ─► samples ─► adapt ─► schedule ─► scope ─► retain ─► queues
//!       ─► synchronise ─► outlive ─► purpose ─► usable ─► place ─► occupy ─► take_over ─► batch
//!       ─► redundant ─► hand_over ─► emit
//! ```
//!
//! `place` stands between the halves of `synchronise`: how long something lives and what it is made for is known once all
//! steps have been walked, and what its first use waits for (`take_over`) once it has a place. `structure` runs the stages,
//! those before `place` by themselves since they don't depend on sizes; where the device refuses a format, `formats` finds
//! another one and they run again. `compiler` keeps what they found from frame to frame.

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
mod formats;
mod hand_over;
pub mod heap_size;
mod last_uses;
mod legal;
mod link;
mod model;
mod occupy;
mod outlive;
mod pack;
mod parts;
mod place;
mod purpose;
mod queues;
mod redundant;
mod retain;
mod rotate;
mod samples;
mod schedule;
mod scope;
mod structure;
mod synchronise;
mod take_over;
mod usable;

pub use compiler::{Compiler, Reuse};

/// Switches of the compiler that never change what a frame means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Whether transient images share memory.
    pub alias: bool,
    /// Whether transient images can be filled with poison before their first use: adds `TRANSFER_DST`, and leaves no
    /// image `TRANSIENT_ATTACHMENT`, which excludes it.
    pub poison: bool,
    /// The order of execution.
    pub order: Order,
    /// Whether full-screen draws that gain nothing from several samples move to single-sampled images.
    pub demote: bool,
    /// Whether queues beside the first are used, where the device has them.
    pub queues: bool,
}

/// Which of the legal orders is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
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
        Options { alias: true, poison: false, order: Order::Default, demote: true, queues: true }
    }
}

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
