//! Files that are read and written.

pub(crate) mod inputs;
pub(crate) mod outputs;
pub(crate) mod report;
mod stream;
