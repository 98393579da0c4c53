//! What the shipped passes draw: the scene, the sky, full-screen effects; and the twins that their shaders are held against.
//!
//! - [`scene`]: scenes as plain data, read from our own RON format or from GLB.
//! - [`facts`]: what pipeline files may ask of a scene.
//! - [`shipped`]: the shaders, carried within the binary.
//! - [`texture_files`]: pictures for the textures of a frame.
//! - [`draw`]: what a draw brings along, and the draw source that draws a scene.
//! - [`twin`]: the shaders' closed formulas in 64-bit floating point.

pub mod draw;
pub mod facts;
pub mod scene;
pub mod shipped;
pub mod texture_files;
pub mod twin;
