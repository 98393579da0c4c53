//! Settings, facts, the view and the device are put in: a pipeline becomes one flat frame.
//!
//! ```text
//! Document ─► settings ─► Document::lower ─► images and buffers ─► passes (parts, shaders) ─► order ─► Frame
//! ```
//! Every stage goes on past mistakes, so that all independent ones are reported at once.

mod contents;
mod decided;
mod eyes;
mod flatten;
mod inputs;
mod mistakes;
mod outputs;
mod passes;
mod precision;
mod resources;
mod settings;
mod shader;

pub use flatten::{expand, expand_reading};
pub use inputs::{Inputs, check_inputs};
pub use settings::canonical_value;
