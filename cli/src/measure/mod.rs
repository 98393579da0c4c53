//! Measured sweeps over settings: what each choice costs, and what it buys.

pub(crate) mod results;
