//! Copies, resolves, blits and fills, whatever asks for them.

use crate::base::convert::{self, Clear};
use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::plan::Subresources;
use framewright_graph::vulkan::Aspects;

/// One side of a transfer, on the device.
#[derive(Clone, Copy)]
pub(crate) enum TransferSide {
    /// A part of an image.
    Image { image: vk::Image, range: Subresources, extent: vk::Extent3D, layout: vk::ImageLayout },
    /// The beginning of a buffer.
    Buffer { buffer: vk::Buffer, bytes: u64 },
}

/// A transfer as Vulkan takes it: ready to be recorded outside a scope, as often as needed.
pub(crate) enum Transfer {
    Copy(ImagePair, vk::ImageCopy2<'static>),
    Resolve(ImagePair, vk::ImageResolve2<'static>),
    Blit(ImagePair, vk::ImageBlit2<'static>, vk::Filter),
    ToBuffer(vk::Image, vk::ImageLayout, vk::Buffer, vk::BufferImageCopy2<'static>),
    FromBuffer(vk::Buffer, vk::Image, vk::ImageLayout, vk::BufferImageCopy2<'static>),
    CopyBuffer(vk::Buffer, vk::Buffer, vk::BufferCopy2<'static>),
    ClearColor(vk::Image, vk::ImageLayout, vk::ClearColorValue, vk::ImageSubresourceRange),
    ClearDepthStencil(vk::Image, vk::ImageLayout, vk::ClearDepthStencilValue, vk::ImageSubresourceRange),
    FillBuffer { buffer: vk::Buffer, bytes: u64, word: u32 },
}

/// Source and target of a transfer between images, each with its layout.
#[derive(Clone, Copy)]
pub(crate) struct ImagePair {
    source: (vk::Image, vk::ImageLayout),
    target: (vk::Image, vk::ImageLayout),
}

impl Transfer {
    /// A copy of one place to another: texel for texel, byte for byte, or texels without gaps to or from a buffer.
    pub(crate) fn copy(source: TransferSide, target: TransferSide) -> Transfer {
        match (source, target) {
            (
                TransferSide::Image { image, range, extent, layout },
                TransferSide::Image { image: to, range: to_range, layout: to_layout, .. },
            ) => {
                let region = vk::ImageCopy2::default()
                    .src_subresource(convert::layers(range))
                    .dst_subresource(convert::layers(to_range))
                    .extent(extent);
                Transfer::Copy(ImagePair { source: (image, layout), target: (to, to_layout) }, region)
            }
            (TransferSide::Image { image, range, extent, layout }, TransferSide::Buffer { buffer, .. }) => {
                Transfer::ToBuffer(image, layout, buffer, rows(range, extent))
            }
            (TransferSide::Buffer { buffer, .. }, TransferSide::Image { image, range, extent, layout }) => {
                Transfer::FromBuffer(buffer, image, layout, rows(range, extent))
            }
            (TransferSide::Buffer { buffer, bytes }, TransferSide::Buffer { buffer: to, bytes: to_bytes }) => {
                Transfer::CopyBuffer(buffer, to, vk::BufferCopy2::default().size(bytes.min(to_bytes)))
            }
        }
    }

    /// A resolve; `None` where a side is a buffer.
    pub(crate) fn resolve(source: TransferSide, target: TransferSide) -> Option<Transfer> {
        let (pair, [(range, extent), (to_range, _)]) = images(source, target)?;
        let region = vk::ImageResolve2::default()
            .src_subresource(convert::layers(range))
            .dst_subresource(convert::layers(to_range))
            .extent(extent);
        Some(Transfer::Resolve(pair, region))
    }

    /// A copy that scales; `None` where a side is a buffer.
    pub(crate) fn blit(source: TransferSide, target: TransferSide, filter: vk::Filter) -> Option<Transfer> {
        let (pair, [(range, extent), (to_range, to_extent)]) = images(source, target)?;
        let region = vk::ImageBlit2::default()
            .src_subresource(convert::layers(range))
            .src_offsets([vk::Offset3D::default(), corner(extent)])
            .dst_subresource(convert::layers(to_range))
            .dst_offsets([vk::Offset3D::default(), corner(to_extent)]);
        Some(Transfer::Blit(pair, region, filter))
    }

    /// A fill of all of a place with a value; `None` where the value is of another kind than the place's format.
    pub(crate) fn fill(target: TransferSide, value: Clear) -> Option<Transfer> {
        match (target, value) {
            (TransferSide::Image { image, range, layout, .. }, Clear::Color(color)) => {
                Some(Transfer::ClearColor(image, layout, color, convert::range(range)))
            }
            (TransferSide::Image { image, range, layout, .. }, Clear::DepthStencil(value)) => {
                Some(Transfer::ClearDepthStencil(image, layout, value, convert::range(range)))
            }
            (TransferSide::Buffer { buffer, bytes }, Clear::Word(word)) => {
                Some(Transfer::FillBuffer { buffer, bytes: bytes.next_multiple_of(4), word })
            }
            (TransferSide::Image { .. }, Clear::Word(_))
            | (TransferSide::Buffer { .. }, Clear::Color(_) | Clear::DepthStencil(_)) => None,
        }
    }

    /// Records it.
    pub(crate) fn record(&self, gpu: &Gpu, commands: vk::CommandBuffer) {
        let device = &gpu.raw;
        match self {
            Transfer::Copy(ImagePair { source, target }, region) => {
                let info = vk::CopyImageInfo2::default()
                    .src_image(source.0)
                    .src_image_layout(source.1)
                    .dst_image(target.0)
                    .dst_image_layout(target.1)
                    .regions(std::slice::from_ref(region));
                // SAFETY: recording outside a scope; both parts exist and are in these layouts.
                unsafe { device.cmd_copy_image2(commands, &info) };
            }
            Transfer::Resolve(ImagePair { source, target }, region) => {
                let info = vk::ResolveImageInfo2::default()
                    .src_image(source.0)
                    .src_image_layout(source.1)
                    .dst_image(target.0)
                    .dst_image_layout(target.1)
                    .regions(std::slice::from_ref(region));
                // SAFETY: recording outside a scope; both parts exist and are in these layouts.
                unsafe { device.cmd_resolve_image2(commands, &info) };
            }
            Transfer::Blit(ImagePair { source, target }, region, filter) => {
                let info = vk::BlitImageInfo2::default()
                    .src_image(source.0)
                    .src_image_layout(source.1)
                    .dst_image(target.0)
                    .dst_image_layout(target.1)
                    .regions(std::slice::from_ref(region))
                    .filter(*filter);
                // SAFETY: recording outside a scope; both parts exist and are in these layouts.
                unsafe { device.cmd_blit_image2(commands, &info) };
            }
            Transfer::ToBuffer(image, layout, buffer, region) => {
                let info = vk::CopyImageToBufferInfo2::default()
                    .src_image(*image)
                    .src_image_layout(*layout)
                    .dst_buffer(*buffer)
                    .regions(std::slice::from_ref(region));
                // SAFETY: recording outside a scope; the part is in this layout, and the buffer holds its texels.
                unsafe { device.cmd_copy_image_to_buffer2(commands, &info) };
            }
            Transfer::FromBuffer(buffer, image, layout, region) => {
                let info = vk::CopyBufferToImageInfo2::default()
                    .src_buffer(*buffer)
                    .dst_image(*image)
                    .dst_image_layout(*layout)
                    .regions(std::slice::from_ref(region));
                // SAFETY: recording outside a scope; the part is in this layout, and the buffer holds its texels.
                unsafe { device.cmd_copy_buffer_to_image2(commands, &info) };
            }
            Transfer::CopyBuffer(buffer, to, region) => {
                let info = vk::CopyBufferInfo2::default()
                    .src_buffer(*buffer)
                    .dst_buffer(*to)
                    .regions(std::slice::from_ref(region));
                // SAFETY: recording outside a scope; both buffers hold as many bytes.
                unsafe { device.cmd_copy_buffer2(commands, &info) };
            }
            Transfer::ClearColor(image, layout, color, range) => {
                let ranges = std::slice::from_ref(range);
                // SAFETY: recording outside a scope; the part of this colour image exists and is in this layout.
                unsafe { device.cmd_clear_color_image(commands, *image, *layout, color, ranges) };
            }
            Transfer::ClearDepthStencil(image, layout, value, range) => {
                let ranges = std::slice::from_ref(range);
                // SAFETY: recording outside a scope; the part of this depth image exists and is in this layout.
                unsafe { device.cmd_clear_depth_stencil_image(commands, *image, *layout, value, ranges) };
            }
            Transfer::FillBuffer { buffer, bytes, word } => {
                // SAFETY: recording outside a scope; buffers are made of whole words.
                unsafe { device.cmd_fill_buffer(commands, *buffer, 0, *bytes, *word) };
            }
        }
    }
}

/// Sets all of a place to a value.
pub(crate) fn fill(gpu: &Gpu, commands: vk::CommandBuffer, target: TransferSide, value: Clear) {
    if let Some(fill) = Transfer::fill(target, value) {
        fill.record(gpu, commands);
    }
}

/// Both sides of a transfer between images, and the part and extent of each.
fn images(source: TransferSide, target: TransferSide) -> Option<(ImagePair, [(Subresources, vk::Extent3D); 2])> {
    let side = |side: TransferSide| match side {
        TransferSide::Image { image, range, extent, layout } => Some(((image, layout), (range, extent))),
        TransferSide::Buffer { .. } => None,
    };
    let ((source, from), (target, to)) = (side(source)?, side(target)?);
    Some((ImagePair { source, target }, [from, to]))
}

/// A part of an image beside a buffer; of depth and stencil one plane, depth before stencil.
fn rows(range: Subresources, extent: vk::Extent3D) -> vk::BufferImageCopy2<'static> {
    let plane = [Aspects::COLOR, Aspects::DEPTH, Aspects::STENCIL].into_iter().find(|it| range.aspects.contains(*it));
    let range = Subresources { aspects: plane.unwrap_or(range.aspects), ..range };
    vk::BufferImageCopy2::default().image_subresource(convert::layers(range)).image_extent(extent)
}

fn corner(extent: vk::Extent3D) -> vk::Offset3D {
    let at = |texels: u32| i32::try_from(texels).unwrap_or(i32::MAX);
    vk::Offset3D { x: at(extent.width), y: at(extent.height), z: at(extent.depth) }
}
