//! The shipped passes: the scene, the sky and full-screen effects that they draw, and CPU twins of their shaders.
//!
//! - [`scene`]: scenes as plain data, read from our own RON format or from GLB.
//! - [`facts`]: the facts of a scene that pipeline files can use.
//! - [`decoder_words`]: what decoders of pictures say, for people.
//! - [`open_exr`]: pictures of OpenEXR files.
//! - [`shipped`]: the shaders, carried within the binary.
//! - [`srgb`]: the curve of sRGB.
//! - [`texture_files`]: pictures for the textures of a frame.
//! - [`draw`]: the draw interface, and the draw source that draws a scene.
//! - [`twin`]: the shaders' closed formulas in 64-bit floating point.

mod decoder_words;
pub mod draw;
pub mod facts;
#[cfg(feature = "pictures")]
pub mod open_exr;
pub mod scene;
pub mod shipped;
pub mod srgb;
pub mod texture_files;
pub mod twin;

pub use decoder_words::decoder_words;
