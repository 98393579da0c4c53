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
mod batch;
mod cull;
mod emit;
mod hand_over;
mod legal;
mod link;
mod model;
mod outlive;
mod pack;
mod parts;
mod place;
mod purpose;
mod queues;
mod retain;
mod samples;
mod schedule;
mod scope;
mod synchronise;
mod take_over;

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
    let grids = parts::Grids::new(frame);
    let linked = link::link(frame, &grids)?;
    let live = cull::cull(frame, &linked);
    let mut negotiated = samples::negotiate(frame, &live.passes, device)?;
    let notes = std::mem::take(&mut negotiated.notes);
    let input = adapt::Input { frame, grids: &grids, live: &live, negotiated: &negotiated, device, options };
    let mut adapted = adapt::adapt(input)?;
    let order = schedule::schedule(&grids, &adapted, options.order);
    let mut scoped = scope::scope(frame, &grids, &mut adapted, &order, device);
    let retained = retain::retain(frame, &grids, &adapted, &scoped);
    let queues = queues::assign(frame, &grids, &mut adapted, &scoped, device, options);
    let mut walked = synchronise::walk(&grids, &mut adapted, &scoped, &retained, queues);
    let export = scoped.steps.len() as u32;
    let states = outlive::promise(&grids, &adapted, &mut walked, export);
    purpose::note(&grids, &mut adapted, &walked, &states, &retained, &scoped, options);
    let spans = walked.queues.as_ref().map(|queues| queues.spans(&adapted, &scoped, &walked.lifetimes));
    let placed = place::place(&adapted, &walked.lifetimes, spans.as_deref(), device, memory, options)?;
    let hand_overs = take_over::take_over(&grids, &adapted, &states, &placed, &mut walked);
    let (pending, queues) = (walked.barriers, walked.queues);
    let batched = match &queues {
        None => batch::batch(&pending),
        Some(queues) => batch::batch_on(queues, &pending),
    };
    let waits = queues.as_ref().is_some_and(|queues| !queues.waits(export).is_empty());
    if batched.last().is_some_and(|last| last.at == export) || export == 0 || waits {
        scoped.steps.push(scope::Step::Export);
    }
    let steps = scoped.steps.len();
    let memory_barriers = match &queues {
        None => hand_over::memory_barriers(&hand_overs, &pending, &batched, steps),
        Some(queues) => hand_over::memory_barriers_on(queues, &hand_overs, &pending, &batched, steps),
    };
    Ok(emit::emit(emit::Parts {
        frame,
        device,
        grids: &grids,
        live,
        notes,
        subjects: emit::Subject::of(&adapted, &grids),
        adapted,
        scoped,
        retained,
        states,
        placed,
        pending,
        queues,
        batched,
        memory: memory_barriers,
        exact_memory: memory.exact(),
        nothing: std::sync::Arc::default(),
    }))
}
