//! What the shipped passes draw: the scene, the sky, full-screen effects; and the twins that their shaders are held against.
//!
//! - [`scene`]: scenes as plain data, read from our own RON format or from GLB.
//! - [`shipped`]: the shaders, carried within the binary.
//! - [`texture_files`]: pictures for the textures of a frame.
//! - [`draw`]: what a draw brings along, and the draw source that draws a scene.
//! - [`twin`]: the shaders' closed formulas in 64-bit floating point.

pub mod draw;
pub mod scene;
pub mod shipped;
pub mod texture_files;
pub mod twin;
