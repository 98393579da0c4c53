//! Resources of a draw source: buffers, textures and bind groups.

mod bind_group;
mod dynamic_buffer;
mod texture;

pub use bind_group::{BindGroup, Resource};
pub use dynamic_buffer::DynamicBuffer;
pub use texture::{Buffer, BufferUsage, Texture};

pub(crate) use bind_group::{RawBindGroup, supplied_layouts};
