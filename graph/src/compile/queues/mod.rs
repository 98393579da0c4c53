//! Queues beside graphics: which steps run on them, and what they wait for.
//!
//! `decide` finds the queue of each step, and `cost` weighs what that gains; `assign` finds what follows. A device with one
//! queue, or a frame in which nothing gains by more, leaves all steps on graphics: then no image or buffer is crossed, no step
//! waits, and [`Queues`] allocates nothing.
//!
//! - A step waits for steps of other queues (`clocks`), but only for those that its queue doesn't know to be done.
//! - A semaphore makes every write available and visible. A subresource that another queue used takes a barrier only for a
//!   change of layout, or of the owner of an image that isn't concurrent (`sync::crossed`).
//! - Steps of different queues run side by side, so memory is shared only between what waits keep apart (`memory_spans`).

mod assign;
mod clocks;
mod cost;
mod crossing;
mod decide;
mod eligible_queues;
mod layout_changes;
mod memory_spans;
mod notes;
mod number;
mod state;
mod step_uses;
mod windows;

pub(super) use assign::{QueueAssignment, assign};
pub(super) use crossing::{Crossing, LayoutChange, OwnershipTransfer, QueueUse, QueueUses};
pub(super) use number::{QUEUES, Steps};
pub(super) use state::Queues;
