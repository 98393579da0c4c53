//! Measured sweeps over settings: the folder of their results, and what is made of it for people.
//!
//! ```text
//! sweeps ─► choices (subjects) ─► resuming: what is missing ─► the bench of framewright-lab measures it
//! results ─► store: file, table, page, plot
//! ```

mod csv;
mod page;
pub(crate) mod pictures;
mod plot;
mod program;
mod resuming;
pub(crate) mod store;
mod subjects;
mod table;

pub(crate) use resuming::measure;
