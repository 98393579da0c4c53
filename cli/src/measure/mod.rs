//! Measured sweeps over settings: what each choice costs, and what it buys.
//!
//! ```text
//! sweeps ─► choices (subjects) ─► run: batches in turns, reference, errors ─► results ─► store: file, table, page, plot
//!                                                                                └─► choosing, joining
//! ```

mod checks;
pub(crate) mod choosing;
mod converging;
mod csv;
mod digest;
mod front;
mod held_against;
mod joining;
mod naming;
mod page;
pub(crate) mod pictures;
mod pipeline_digest;
mod plausible;
mod plot;
mod reference;
mod references;
pub(crate) mod results;
mod run;
pub(crate) mod settings_file;
mod spread;
pub(crate) mod store;
mod subjects;
mod sweep;
mod table;

pub(crate) use joining::{Part, joined};
pub(crate) use run::measure;
