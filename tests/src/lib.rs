//! Code that the tests of the whole share. The tests themselves are in `tests/tests/suite`.
//!
//! - [`frames`]: small frames built in memory.
//! - [`happens_before`]: a brute-force judge of Plans.
//! - [`mutation`]: Plans with one mistake each, and who notices.
//! - [`random_pipelines`]: pipelines from a seed, and their meaning.
//! - [`incidents`]: frames after what users of other graphs reported.
//! - [`partial_passes`]: passes that leave texels out, by every means that there is.
//! - [`raycast`]: a second, slow and simple way to a picture.
//! - [`render`]: a pipeline file and a scene become pictures.
//! - [`shapes`]: simple scenes.
//! - [`optima`]: the least cost of small frames.
//! - [`sweep`]: all cases of a sweep, or a sample.
//! - [`shipped`]: the shipped pipelines, as frames.
//! - [`sources`]: the program's own sources, as tokens.
//! - [`agreement`]: compares it with the GPU's picture.
//! - [`drivers`]: the software drivers and validation layers of this machine.
//! - [`wayland_server`], [`x_server`]: servers for windows that nobody sees.

pub mod agreement;
pub mod drivers;
pub mod frames;
pub mod happens_before;
pub mod incidents;
pub mod mutation;
pub mod optima;
pub mod partial_passes;
#[path = "../../graph/tests/suite/testing/parts.rs"]
mod parts;
pub mod random_pipelines;
pub mod raycast;
pub mod render;
pub mod shapes;
pub mod shipped;
pub mod sources;
pub mod sweep;
pub mod texture_files;
pub mod wayland_server;
pub mod x_server;
