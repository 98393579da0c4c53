//! Measured sweeps over settings: what each choice costs, and what it buys.
//!
//! ```text
//! sweeps ─► choices (subjects) ─► run: batches in turns, reference, errors ─► results ─► store
//! ```

mod digest;
mod moved_bytes;
mod reference;
pub(crate) mod results;
mod run;
mod spread;
mod store;
mod subjects;
pub(crate) mod sweep;

pub(crate) use run::measure;
