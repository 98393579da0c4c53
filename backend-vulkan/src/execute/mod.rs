//! Frames of a Plan: executed, and what goes in and out between them.

mod change;
mod exchange;
mod executor;
mod frame_slot;
mod frames;
mod import;
mod initial_contents;
mod migrate;
mod output_readback;
mod submission;

pub use executor::{Executor, ExecutorOptions};
pub use submission::{ExternalStates, ResourceState, SemaphorePoint, Submission};
