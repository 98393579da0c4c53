//! Outputs that are read back.

use crate::arguments::{output, text};
use crate::renderer::{FramewrightRenderer, with};
use crate::status::FramewrightStatus;
use framewright::vulkan::ash::vk;
use std::ffi::c_char;

/// The texels of an image: layer after layer, slice after slice, rows from the top, without padding; the machine's byte order.
#[repr(C)]
pub struct FramewrightTexels {
    /// The format of a texel. Of depth and stencil one is read: the depth takes 2 bytes for `VK_FORMAT_D16_UNORM`, else 4.
    pub format: vk::Format,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Depth in texels: 1, but for a volume.
    pub depth: u32,
    /// Array layers.
    pub layers: u32,
    /// The bytes.
    pub bytes: *const u8,
    /// How many bytes there are.
    pub byte_count: usize,
}

/// Reads the output `name`, an image, as the last frame left it. Frames on their way are waited for. The bytes live until the next call of
/// this function for the renderer, or until it is freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_read(
    renderer: *mut FramewrightRenderer,
    name: *const c_char,
    texels: *mut FramewrightTexels,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let read = state.renderer.read(text(name, "name")?)?;
            let read = state.texels.insert(read);
            let [width, height, depth] = read.extent;
            let found = FramewrightTexels {
                format: vk::Format::from_raw(read.format.vulkan()),
                width,
                height,
                depth,
                layers: read.layers,
                bytes: read.bytes.as_ptr(),
                byte_count: read.bytes.len(),
            };
            output(texels, "texels", found)
        })
    }
}
