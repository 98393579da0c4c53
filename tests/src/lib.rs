//! What the tests of the whole share. The tests themselves are in `tests/tests`.
//!
//! - [`happens_before`]: a brute-force judge of Plans.
//! - [`raycast`]: a second, slow and simple way to a picture.
//! - [`render`]: a pipeline file and a scene become pictures.
//! - [`shapes`]: simple scenes.
//! - [`shipped`]: the shipped pipelines, as frames.
//! - [`agreement`]: what the GPU drew, held against it.

pub mod agreement;
pub mod happens_before;
pub mod random_pipelines;
pub mod raycast;
pub mod render;
pub mod shapes;
pub mod shipped;
