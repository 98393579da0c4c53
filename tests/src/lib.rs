//! What the tests of the whole share. The tests themselves are in `tests/tests`.
//!
//! - [`raycast`]: a second, slow and simple way to a picture, for judging what the GPU drew.

pub mod raycast;
