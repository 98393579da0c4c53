//! Copies and fills, whatever asks for them.

use crate::base::convert::{self, Clear};
use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::vulkan::{Aspects, Subresources};

/// One side of a transfer, on the device.
#[derive(Clone, Copy)]
pub(crate) enum TransferSide {
    /// A part of an image.
    Image { image: vk::Image, range: Subresources, extent: vk::Extent3D, layout: vk::ImageLayout },
    /// The beginning of a buffer.
    Buffer { buffer: vk::Buffer, bytes: u64 },
}

/// Copies one place to another: texel for texel, byte for byte, or texels without gaps to or from a buffer.
pub(crate) fn copy_between(gpu: &Gpu, commands: vk::CommandBuffer, source: TransferSide, target: TransferSide) {
    let device = &gpu.raw;
    match (source, target) {
        (
            TransferSide::Image { image, range, extent, layout },
            TransferSide::Image { image: to, range: to_range, layout: to_layout, .. },
        ) => {
            let regions = [vk::ImageCopy2::default()
                .src_subresource(convert::layers(range))
                .dst_subresource(convert::layers(to_range))
                .extent(extent)];
            let info = vk::CopyImageInfo2::default()
                .src_image(image)
                .src_image_layout(layout)
                .dst_image(to)
                .dst_image_layout(to_layout)
                .regions(&regions);
            // SAFETY: recording outside a scope; both parts exist and are in these layouts.
            unsafe { device.cmd_copy_image2(commands, &info) };
        }
        (TransferSide::Image { image, range, extent, layout }, TransferSide::Buffer { buffer, .. }) => {
            let regions = [rows(range, extent)];
            let info = vk::CopyImageToBufferInfo2::default()
                .src_image(image)
                .src_image_layout(layout)
                .dst_buffer(buffer)
                .regions(&regions);
            // SAFETY: recording outside a scope; the part is in this layout, and the buffer holds its texels.
            unsafe { device.cmd_copy_image_to_buffer2(commands, &info) };
        }
        (TransferSide::Buffer { buffer, .. }, TransferSide::Image { image, range, extent, layout }) => {
            let regions = [rows(range, extent)];
            let info = vk::CopyBufferToImageInfo2::default()
                .src_buffer(buffer)
                .dst_image(image)
                .dst_image_layout(layout)
                .regions(&regions);
            // SAFETY: recording outside a scope; the part is in this layout, and the buffer holds its texels.
            unsafe { device.cmd_copy_buffer_to_image2(commands, &info) };
        }
        (TransferSide::Buffer { buffer, bytes }, TransferSide::Buffer { buffer: to, bytes: to_bytes }) => {
            let regions = [vk::BufferCopy2::default().size(bytes.min(to_bytes))];
            let info = vk::CopyBufferInfo2::default().src_buffer(buffer).dst_buffer(to).regions(&regions);
            // SAFETY: recording outside a scope; both buffers hold as many bytes.
            unsafe { device.cmd_copy_buffer2(commands, &info) };
        }
    }
}

/// A part of an image beside a buffer; of depth and stencil one plane, depth before stencil.
fn rows(range: Subresources, extent: vk::Extent3D) -> vk::BufferImageCopy2<'static> {
    let plane = [Aspects::COLOR, Aspects::DEPTH, Aspects::STENCIL].into_iter().find(|it| range.aspects.contains(*it));
    let range = Subresources { aspects: plane.unwrap_or(range.aspects), ..range };
    vk::BufferImageCopy2::default().image_subresource(convert::layers(range)).image_extent(extent)
}

/// Sets all of a place to a value.
pub(crate) fn fill(gpu: &Gpu, commands: vk::CommandBuffer, target: TransferSide, value: Clear) {
    let device = &gpu.raw;
    match (target, value) {
        (TransferSide::Image { image, range, layout, .. }, Clear::Color(color)) => {
            let ranges = [convert::range(range)];
            // SAFETY: recording outside a scope; the part of this colour image exists and is in this layout.
            unsafe { device.cmd_clear_color_image(commands, image, layout, &color, &ranges) };
        }
        (TransferSide::Image { image, range, layout, .. }, Clear::DepthStencil(value)) => {
            let ranges = [convert::range(range)];
            // SAFETY: recording outside a scope; the part of this depth image exists and is in this layout.
            unsafe { device.cmd_clear_depth_stencil_image(commands, image, layout, &value, &ranges) };
        }
        (TransferSide::Buffer { buffer, bytes }, Clear::Word(word)) => {
            let bytes = bytes.next_multiple_of(4);
            // SAFETY: recording outside a scope; buffers are made of whole words.
            unsafe { device.cmd_fill_buffer(commands, buffer, 0, bytes, word) };
        }
        // A format's clear is of its own kind.
        (TransferSide::Image { .. }, Clear::Word(_))
        | (TransferSide::Buffer { .. }, Clear::Color(_) | Clear::DepthStencil(_)) => {}
    }
}
