//! Drawing a planned frame: the pictures that come out.

pub(crate) mod captures;
pub(crate) mod pictures;
pub(crate) mod timed;
