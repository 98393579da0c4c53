//! Files that are read and written.

pub(crate) mod inputs;
pub(crate) mod outputs;
pub(crate) mod shipped;
mod stream;
