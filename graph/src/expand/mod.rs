//! Settings, facts, the view and the device are put in: a pipeline becomes one flat frame.
//!
//! ```text
//! inputs, settings ─► eyes ─► resources ─► shader, passes ─► outputs ─► contents ─► decisions, precision ─► Frame
//! ```
//! `flatten` runs the stages; no folder uses a later one.
//! Every stage goes on past mistakes, so that all independent ones are reported at once.

mod contents;
mod decisions;
mod expander;
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

pub use expander::Expander;
pub use flatten::{check_inputs, expand, expand_reading};
pub use inputs::Inputs;
pub use settings::canonical_value;
