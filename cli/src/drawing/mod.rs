//! Drawing a planned frame: the executor with its scene, the pictures that come out, and the times of passes.

pub(crate) mod captures;
pub(crate) mod diagnostics;
pub(crate) mod pictures;
mod prepared;
pub(crate) mod timings;

pub(crate) use prepared::Prepared;
