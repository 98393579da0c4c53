//! Outputs, copied to the host.

use crate::device::Shared;
use crate::error::Error;
use crate::image::Image;
use crate::memory::Kind;
use crate::record::{barriers, state_change};
use crate::resources::RawBuffer;
use ash::vk;
use framewright_graph::format::Format;
use framewright_graph::plan::{ImageState, Subresources};
use framewright_graph::vocabulary::{Accesses, Aspects, Layout, Stages};
use std::sync::Arc;

/// Texels of an output's first mip level.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Texels {
    /// What a texel is. Of depth-stencil formats only the depth is read: 2 bytes for `D16_UNORM`, else 4.
    pub format: Format,
    /// Width, height, depth.
    pub extent: [u32; 3],
    /// Array layers.
    pub layers: u32,
    /// Layer after layer, slice after slice, rows from the top, without padding; the machine's byte order.
    pub bytes: Vec<u8>,
}

/// Copies `image`, which is in the state `state` and stays in it.
pub(crate) fn read(shared: &Arc<Shared>, image: &Image, state: ImageState) -> Result<Texels, Error> {
    let descriptor = image.descriptor;
    let [width, height, depth] = descriptor.extent;
    let texels = u64::from(width) * u64::from(height) * u64::from(depth) * u64::from(descriptor.layers);
    let bytes = texels * bytes_of(descriptor.format);
    let buffer = RawBuffer::new(shared, "readback", bytes, vk::BufferUsageFlags::TRANSFER_DST, Kind::Readback)?;
    let aspect = if descriptor.format.is_depth() { Aspects::DEPTH } else { Aspects::COLOR };
    let source =
        ImageState { stages: Stages::COPY, accesses: Accesses::TRANSFER_READ, layout: Layout::TransferSrcOptimal };
    let whole = Subresources::all(descriptor.format, descriptor.mips, descriptor.layers);
    shared.submit_once("reading an output back", |commands| {
        let to_copy = state_change(image.raw, whole, Some(state), source);
        barriers(shared, commands, &[], &[to_copy]);
        let region = vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: crate::convert::aspects(aspect),
                mip_level: 0,
                base_array_layer: 0,
                layer_count: descriptor.layers,
            })
            .image_extent(vk::Extent3D { width, height, depth });
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        // SAFETY: the buffer holds all texels, the image is in this layout, and both live until the wait is over.
        unsafe { shared.raw.cmd_copy_image_to_buffer(commands, image.raw, layout, buffer.raw, &[region]) };
        let to_host = vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::COPY)
            .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::HOST)
            .dst_access_mask(vk::AccessFlags2::HOST_READ);
        barriers(shared, commands, &[to_host], &[state_change(image.raw, whole, Some(source), state)]);
    })?;
    let wanted = usize::try_from(bytes).unwrap_or(usize::MAX);
    let read = buffer.memory.bytes().get(..wanted).ok_or_else(|| Error::OutOfMemory {
        what: "a buffer that the host can read".to_owned(),
        bytes,
        reason: "the memory isn't visible to the host".to_owned(),
    })?;
    Ok(Texels { format: descriptor.format, extent: descriptor.extent, layers: descriptor.layers, bytes: read.to_vec() })
}

/// Bytes of a texel as `vkCmdCopyImageToBuffer` writes it: of depth-stencil formats the depth alone.
fn bytes_of(format: Format) -> u64 {
    match format {
        Format::D32_SFLOAT_S8_UINT | Format::D24_UNORM_S8_UINT => 4,
        format => format.texel_bytes(),
    }
}
