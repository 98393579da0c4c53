//! Resources of a draw source: buffers, textures and bind groups.

mod bind_group;
mod dynamic_buffer;
mod program_resource;
mod program_set;
mod texture;

pub use bind_group::{BindGroup, Resource};
pub use dynamic_buffer::DynamicBuffer;
pub use program_resource::{ProgramBuffer, ProgramView};
pub use program_set::RawSet;
pub use texture::{Buffer, BufferUsage, Texture};

pub(crate) use bind_group::{RawBindGroup, supplied_layout};
pub(crate) use program_set::{ProgramSets, offset_alignments, program_layout};
