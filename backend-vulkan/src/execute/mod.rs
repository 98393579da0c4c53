//! Frames of a Plan: executed, and what goes in and out between them.

mod change;
mod exchange;
mod executor;
mod frames;
mod import;
mod initial_contents;
mod migrate;
mod output_readback;

pub use executor::{Executor, ExecutorOptions};
