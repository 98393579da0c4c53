//! A frame becomes a Plan: one file per stage, each a function from data to data.
//!
//! ```text
//! legal ─► link ─► cull ─► adapt ─► schedule ─► scope ─► retain ─► place ─► synchronise ─► emit
//! ```

use crate::describe::Diagnostic;
use crate::device::{MemoryProvider, Profile};
use crate::frame::Frame;
use crate::plan::Plan;

mod adapt;
mod cull;
mod emit;
mod hand_over;
mod legal;
mod link;
mod model;
mod pack;
mod place;
mod retain;
mod samples;
mod schedule;
mod scope;
mod synchronise;

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
    legal::check(frame)?;
    let linked = link::link(frame)?;
    let live = cull::cull(frame, &linked);
    let samples = samples::negotiate(frame, &live.passes, device)?;
    let mut adapted = adapt::adapt(frame, &live, &samples, device)?;
    let order = schedule::schedule(&adapted);
    let scoped = scope::scope(frame, &mut adapted, &order);
    let retained = retain::retain(&mut adapted, &scoped, options);
    let placed = place::place(&adapted, &retained, device, memory, options)?;
    let barriers = synchronise::synchronise(&adapted, &retained, &placed, scoped.steps.len());
    let parts = emit::Parts { frame, device, live, samples, adapted, scoped, retained, placed, barriers };
    Ok(emit::emit(parts, memory.exact()))
}
