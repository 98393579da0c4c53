//! Drawing a planned frame: the pictures that come out, and the times of passes.

pub(crate) mod captures;
pub(crate) mod pictures;

pub(crate) use framewright_lab::timings;
