//! A pipeline file says *what* a frame is made of; this crate finds out *how*: no GPU, no unsafe code.
//!
//! ```text
//! pipeline.ron ─► language ─► expand ─► compile ─► Plan ─► verify
//! ```

pub mod base;
pub mod compile;
pub mod dataflow;
pub mod device;
pub mod difference;
pub mod expand;
pub mod expression;
pub mod frame;
pub mod hints;
pub mod language;
pub mod plan;
pub mod ron;
pub mod shader;
pub mod verify;
pub mod vulkan;
