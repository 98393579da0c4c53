//! Resources of a draw source: buffers, textures and bind groups.

mod bind_group;
mod texture;

pub use bind_group::{BindGroup, Resource};
pub use texture::{Buffer, BufferUsage, Texture};

pub(crate) use bind_group::{RawBindGroup, supplied_layouts};
