//! A picture that is laid over what a window shows.

mod layer;
mod picture;
mod pipeline;
mod shaders;
mod texture;

pub use picture::Overlay;

pub(super) use layer::OverlayLayer;
