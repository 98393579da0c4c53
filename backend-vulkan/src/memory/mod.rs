//! Device memory, and the images, buffers and views in it.

mod block;
mod buffer;
mod image;
mod needs;
mod view;

pub use needs::{LiveMemory, MemoryInUse};

pub(crate) use block::{MemoryBlock, MemoryUse};
pub(crate) use buffer::RawBuffer;
pub(crate) use image::{Image, create_info};
pub(crate) use view::ViewShape;
