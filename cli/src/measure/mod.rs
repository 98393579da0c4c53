//! Measured sweeps over settings: what each choice costs, and what it buys.
//!
//! ```text
//! sweeps ─► choices (subjects) ─► resuming: what is missing ─► run: batches in turns ─► measured: cost, reference, errors
//! results ─► store: file, table, page, plot
//!        └─► choosing, joining
//! ```

mod checks;
pub(crate) mod choosing;
mod converging;
mod cost;
mod csv;
mod digest;
mod front;
mod held_against;
mod joining;
mod measured;
mod naming;
mod page;
pub(crate) mod pictures;
mod pipeline_digest;
mod plausible;
mod plot;
mod reference;
mod references;
pub(crate) mod results;
mod resuming;
mod run;
pub(crate) mod settings_file;
mod spread;
pub(crate) mod store;
mod subjects;
mod sweep;
mod table;

pub(crate) use joining::{Part, joined};
pub(crate) use naming::Group;
pub(crate) use resuming::measure;
