//! Settings, conditions, facts and sizes are put in: a pipeline becomes one flat frame.

mod facts;

pub use facts::Facts;
