//! Frames of a Plan: executed, and what goes in and out between them.

mod change;
mod exchange;
mod executor;
mod external;
mod frame_runs;
mod frame_slot;
mod frames;
mod import;
mod initial_contents;
mod migrate;
mod options;
mod output_readback;
mod ownership;
mod promises;
mod retired;
mod submission;
mod told_owners;

pub use executor::Executor;
pub use options::ExecutorOptions;
pub use submission::{ExternalStates, ResourceState, SemaphorePoint, Submission};
