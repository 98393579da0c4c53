//! Synchronisation: from the accesses of steps to the barriers before them.
//!
//! ```text
//! timeline:  walk ─► final_states
//! barriers:  initial_barriers ─► batches ─► redundant ─► aliasing_barriers
//! ```
//! `timeline` depends on no sizes. `barriers` needs alias edges, and so comes once everything has its place in memory. One
//! queue is the case in which no subresource is crossed.

mod aliasing_barriers;
mod barriers;
mod batches;
mod crossed_subresource;
mod final_states;
mod initial_barriers;
mod last_accesses;
mod redundant;
mod subresource;
mod timeline;
mod walk;

pub(super) use barriers::{Barriers, barriers};
pub(super) use batches::{BarrierAtStep, waits};
pub(super) use subresource::SubresourceBarrier;
pub(super) use timeline::{AccessTimeline, States};
pub(super) use walk::timeline;
