//! Images and buffers of the program's own, as resources of bind groups.

use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::shader::SuppliedKind;

/// A view of an image of the program's own, with a sampler.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProgramView {
    pub(super) view: vk::ImageView,
    pub(super) layout: vk::ImageLayout,
    pub(super) sampler: vk::Sampler,
}

/// A part of a buffer of the program's own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProgramBuffer {
    pub(super) buffer: vk::Buffer,
    pub(super) offset: u64,
    pub(super) bytes: u64,
}

impl ProgramView {
    /// Takes a view, the layout in which its image is whenever it is read, and a sampler.
    ///
    /// # Safety
    /// View and sampler must be of the device, a view of colour or depth of the type `2D`, and live as long as all frames that bind
    /// them. No Plan knows of the image: the program makes its barriers, and sees to it that shaders find it in this layout.
    #[must_use]
    pub unsafe fn new(view: vk::ImageView, layout: vk::ImageLayout, sampler: vk::Sampler) -> ProgramView {
        ProgramView { view, layout, sampler }
    }
}

impl ProgramBuffer {
    /// Takes `bytes` bytes of a buffer, from `offset` on.
    ///
    /// # Safety
    /// The buffer must be of the device, hold that much, have been made for what it is bound as (uniform or storage blocks, vertices or
    /// indices), and live as long as all frames that bind it. No Plan knows of it: the program makes its barriers.
    #[must_use]
    pub unsafe fn new(buffer: vk::Buffer, offset: u64, bytes: u64) -> ProgramBuffer {
        ProgramBuffer { buffer, offset, bytes }
    }

    /// Buffer, offset and bytes, to be bound as vertices or indices.
    ///
    /// # Errors
    /// In words: there is no buffer, or the offset is no multiple of `aligned`.
    pub(crate) fn checked(self, aligned: u64) -> Result<(vk::Buffer, u64, u64), String> {
        let ProgramBuffer { buffer, offset, bytes } = self;
        if buffer == vk::Buffer::null() {
            return Err("the buffer is VK_NULL_HANDLE".to_owned());
        }
        if !offset.is_multiple_of(aligned) {
            return Err(format!("the offset {offset} is no multiple of {aligned}"));
        }
        if bytes == 0 || offset.checked_add(bytes).is_none() {
            return Err(format!("{bytes} bytes from byte {offset} on can't be a part of a buffer"));
        }
        Ok((buffer, offset, bytes))
    }

    /// Why it can't be bound as a block, in words.
    pub(super) fn misfit(&self, gpu: &Gpu, kind: SuppliedKind) -> Option<String> {
        let limits = &gpu.limits;
        let (alignment, most) = match kind {
            SuppliedKind::UniformBlock => (limits.min_uniform_buffer_offset_alignment, limits.max_uniform_buffer_range),
            SuppliedKind::StorageBlock => (limits.min_storage_buffer_offset_alignment, limits.max_storage_buffer_range),
            SuppliedKind::SampledImage => return None,
        };
        let ProgramBuffer { buffer, offset, bytes } = *self;
        if buffer == vk::Buffer::null() {
            return Some("the buffer is VK_NULL_HANDLE".to_owned());
        }
        if !offset.is_multiple_of(alignment.max(1)) {
            return Some(format!("the offset {offset} is no multiple of {alignment}"));
        }
        let fits = (1..=u64::from(most)).contains(&bytes);
        (!fits).then(|| format!("{bytes} bytes of a buffer: {} takes 1 to {most}", gpu.summary.name))
    }
}
