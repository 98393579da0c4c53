//! Commands: their recording and submission, barriers, copies, uploads and readback.

mod barriers;
mod readback;
pub(crate) mod rotate_texels;
mod submit;
mod transfer;
mod upload;

pub use readback::Texels;

pub(crate) use barriers::{barrier_call, barriers, memory_barrier, memory_change, stages_of, state_change};
pub(crate) use readback::{Readback, first_plane, level_bytes, mip_extent, plane_bytes, to_host};
pub(crate) use submit::{CommandPool, Commands, Timeline, record};
pub(crate) use transfer::{
    ImageSide, TransferCommand, TransferSide, copy_between, copy_from_image, copy_to_image, fill,
};
pub(crate) use upload::{UNUSED, WRITTEN, image_side, record_upload, staged, write_buffer, write_image};
