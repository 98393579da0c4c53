//! Copies, resolves, blits and fills, for steps of a Plan as for uploads and readbacks.

use crate::base::convert::{self, Clear};
use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::vulkan::{Aspects, Subresources};

/// A part of an image, on the device.
#[derive(Clone, Copy)]
pub(crate) struct ImageSide {
    pub(crate) image: vk::Image,
    pub(crate) range: Subresources,
    pub(crate) extent: vk::Extent3D,
    pub(crate) layout: vk::ImageLayout,
}

/// One side of a transfer, on the device.
#[derive(Clone, Copy)]
pub(crate) enum TransferSide {
    /// A part of an image.
    Image(ImageSide),
    /// The beginning of a buffer.
    Buffer { buffer: vk::Buffer, bytes: u64 },
}

/// A copy, resolve, blit or fill, ready to be recorded as often as needed.
pub(crate) enum TransferCommand {
    Copy(TransferSide, TransferSide),
    Resolve(ImageSide, ImageSide),
    Blit(ImageSide, ImageSide, vk::Filter),
    Fill(TransferSide, Clear),
}

impl TransferCommand {
    /// Records it.
    pub(crate) fn record(&self, gpu: &Gpu, commands: vk::CommandBuffer) {
        match self {
            TransferCommand::Copy(source, target) => copy_between(gpu, commands, *source, *target),
            TransferCommand::Resolve(source, target) => resolve(gpu, commands, *source, *target),
            TransferCommand::Blit(source, target, filter) => blit(gpu, commands, *source, *target, *filter),
            TransferCommand::Fill(target, value) => fill(gpu, commands, *target, *value),
        }
    }
}

/// Copies one place to another: texel for texel, byte for byte, or texels without gaps to or from a buffer.
pub(crate) fn copy_between(gpu: &Gpu, commands: vk::CommandBuffer, source: TransferSide, target: TransferSide) {
    let device = &gpu.raw;
    match (source, target) {
        (TransferSide::Image(from), TransferSide::Image(to)) => {
            let regions = [vk::ImageCopy2::default()
                .src_subresource(convert::layers(from.range))
                .dst_subresource(convert::layers(to.range))
                .extent(from.extent)];
            let info = vk::CopyImageInfo2::default()
                .src_image(from.image)
                .src_image_layout(from.layout)
                .dst_image(to.image)
                .dst_image_layout(to.layout)
                .regions(&regions);
            // SAFETY: recording outside a scope; both parts exist and are in these layouts.
            unsafe { device.cmd_copy_image2(commands, &info) };
        }
        (TransferSide::Image(from), TransferSide::Buffer { buffer, .. }) => {
            copy_from_image(gpu, commands, from, (buffer, 0));
        }
        (TransferSide::Buffer { buffer, .. }, TransferSide::Image(to)) => copy_to_image(gpu, commands, (buffer, 0), to),
        (TransferSide::Buffer { buffer, bytes }, TransferSide::Buffer { buffer: to, bytes: to_bytes }) => {
            let regions = [vk::BufferCopy2::default().size(bytes.min(to_bytes))];
            let info = vk::CopyBufferInfo2::default().src_buffer(buffer).dst_buffer(to).regions(&regions);
            // SAFETY: recording outside a scope; both buffers hold as many bytes.
            unsafe { device.cmd_copy_buffer2(commands, &info) };
        }
    }
}

/// Copies a part of an image to a buffer, where its texels follow each other from an offset on without gaps.
pub(crate) fn copy_from_image(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    from: ImageSide,
    (buffer, at): (vk::Buffer, u64),
) {
    let regions = [rows(from).buffer_offset(at)];
    let info = vk::CopyImageToBufferInfo2::default()
        .src_image(from.image)
        .src_image_layout(from.layout)
        .dst_buffer(buffer)
        .regions(&regions);
    // SAFETY: recording outside a scope; the part is in this layout, and the buffer holds its texels from there on.
    unsafe { gpu.raw.cmd_copy_image_to_buffer2(commands, &info) };
}

/// Copies texels without gaps, which begin at an offset in a buffer, to a part of an image.
pub(crate) fn copy_to_image(gpu: &Gpu, commands: vk::CommandBuffer, (buffer, at): (vk::Buffer, u64), to: ImageSide) {
    let regions = [rows(to).buffer_offset(at)];
    let info = vk::CopyBufferToImageInfo2::default()
        .src_buffer(buffer)
        .dst_image(to.image)
        .dst_image_layout(to.layout)
        .regions(&regions);
    // SAFETY: recording outside a scope; the part is in this layout, and the buffer holds its texels.
    unsafe { gpu.raw.cmd_copy_buffer_to_image2(commands, &info) };
}

/// Resolves one image into another.
pub(super) fn resolve(gpu: &Gpu, commands: vk::CommandBuffer, from: ImageSide, to: ImageSide) {
    let regions = [vk::ImageResolve2::default()
        .src_subresource(convert::layers(from.range))
        .dst_subresource(convert::layers(to.range))
        .extent(from.extent)];
    let info = vk::ResolveImageInfo2::default()
        .src_image(from.image)
        .src_image_layout(from.layout)
        .dst_image(to.image)
        .dst_image_layout(to.layout)
        .regions(&regions);
    // SAFETY: recording outside a scope; both parts exist and are in these layouts.
    unsafe { gpu.raw.cmd_resolve_image2(commands, &info) };
}

/// Copies one image to another, and scales it.
pub(super) fn blit(gpu: &Gpu, commands: vk::CommandBuffer, from: ImageSide, to: ImageSide, filter: vk::Filter) {
    let regions = [vk::ImageBlit2::default()
        .src_subresource(convert::layers(from.range))
        .src_offsets([vk::Offset3D::default(), corner(from.extent)])
        .dst_subresource(convert::layers(to.range))
        .dst_offsets([vk::Offset3D::default(), corner(to.extent)])];
    let info = vk::BlitImageInfo2::default()
        .src_image(from.image)
        .src_image_layout(from.layout)
        .dst_image(to.image)
        .dst_image_layout(to.layout)
        .regions(&regions)
        .filter(filter);
    // SAFETY: recording outside a scope; both parts exist and are in these layouts.
    unsafe { gpu.raw.cmd_blit_image2(commands, &info) };
}

fn corner(extent: vk::Extent3D) -> vk::Offset3D {
    let at = |texels: u32| i32::try_from(texels).unwrap_or(i32::MAX);
    vk::Offset3D { x: at(extent.width), y: at(extent.height), z: at(extent.depth) }
}

/// A part of an image beside a buffer; of depth and stencil one plane, depth before stencil.
fn rows(ImageSide { range, extent, .. }: ImageSide) -> vk::BufferImageCopy2<'static> {
    let plane = [Aspects::COLOR, Aspects::DEPTH, Aspects::STENCIL].into_iter().find(|it| range.aspects.contains(*it));
    let range = Subresources { aspects: plane.unwrap_or(range.aspects), ..range };
    vk::BufferImageCopy2::default().image_subresource(convert::layers(range)).image_extent(extent)
}

/// Sets all of a place to a value.
pub(crate) fn fill(gpu: &Gpu, commands: vk::CommandBuffer, target: TransferSide, value: Clear) {
    let device = &gpu.raw;
    match (target, value) {
        (TransferSide::Image(ImageSide { image, range, layout, .. }), Clear::Color(color)) => {
            let ranges = [convert::range(range)];
            // SAFETY: recording outside a scope; the part of this colour image exists and is in this layout.
            unsafe { device.cmd_clear_color_image(commands, image, layout, &color, &ranges) };
        }
        (TransferSide::Image(ImageSide { image, range, layout, .. }), Clear::DepthStencil(value)) => {
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
        (TransferSide::Image(_), Clear::Word(_))
        | (TransferSide::Buffer { .. }, Clear::Color(_) | Clear::DepthStencil(_)) => {}
    }
}
