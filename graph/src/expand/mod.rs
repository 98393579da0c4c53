//! Settings, facts, the view and the device are put in: a pipeline becomes one flat frame.
//!
//! ```text
//! Document ─► settings ─► Document::lower ─► images and buffers ─► passes (parts, shaders) ─► order ─► Frame
//! ```
//! Every stage goes on past mistakes, so that all independent ones are reported at once.

mod accesses;
mod arrays;
mod casters;
mod compared;
mod coverage;
mod decided;
mod depth_only;
mod expander;
mod eyes;
mod fills;
mod flatten;
mod follow;
mod halves;
mod history;
mod images;
mod inputs;
mod instances;
mod local;
mod once;
mod order;
mod outputs;
mod padding;
mod params;
mod parts;
mod passes;
mod precision;
mod resources;
mod rotation;
mod sampled;
mod seen_alike;
mod settings;
mod shader;
mod shapes;
mod state;
mod states;
mod storage;
mod stored;
mod supplied;
mod targets;
mod transfers;
mod variant;
mod views;
mod waits;
mod work;
mod writers;

pub use expander::Expander;
pub use flatten::{expand, expand_reading};
pub use inputs::{Inputs, check_inputs};
pub use settings::canonical_value;
