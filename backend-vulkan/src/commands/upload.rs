//! Texels and bytes from the host into images and buffers.

use super::barriers::{barriers, memory_change, state_change};
use super::readback::mip_extent;
use super::transfer::{TransferSide, copy_between};
use crate::base::{Error, convert};
use crate::gpu::Gpu;
use crate::memory::{Image, MemoryUse, RawBuffer};
use ash::vk;
use framewright_graph::plan::Queue;
use framewright_graph::vulkan::{Accesses, Aspects, Layout, Stages, State, Subresources};
use std::sync::Arc;

/// While it is set to a value or copied to.
pub(crate) const WRITTEN: State = State {
    stages: Stages::COPY.union(Stages::CLEAR),
    accesses: Accesses::TRANSFER_WRITE,
    layout: Layout::TransferDstOptimal,
};

/// Records the copy of a new image's first level from `staging`, which must live as long as the commands, and of each smaller
/// one from the level before; all of it is in the layout `ready` then, for whatever comes next on the queue.
pub(crate) fn record_upload(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    image: &Image,
    staging: &RawBuffer,
    ready: vk::ImageLayout,
) {
    let levels = image.descriptor.mips;
    let extent = image.descriptor.extent;
    let copy = vk::BufferImageCopy::default().image_subresource(level(0)).image_extent(convert::extent(extent));
    let target = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
    transition(gpu, commands, image.raw, 0..levels, vk::ImageLayout::UNDEFINED, target);
    // SAFETY: the buffer holds all texels of the level, and both live until the submission was waited for.
    unsafe { gpu.raw.cmd_copy_buffer_to_image(commands, staging.raw, image.raw, target, &[copy]) };
    for smaller in 1..levels {
        let corner = |level: u32| {
            let [x, y, z] = extent.map(|side| i32::try_from((side >> level).max(1)).unwrap_or(i32::MAX));
            [vk::Offset3D::default(), vk::Offset3D { x, y, z }]
        };
        let blit = vk::ImageBlit::default()
            .src_subresource(level(smaller - 1))
            .src_offsets(corner(smaller - 1))
            .dst_subresource(level(smaller))
            .dst_offsets(corner(smaller));
        let source = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        transition(gpu, commands, image.raw, smaller - 1..smaller, target, source);
        // SAFETY: both levels exist and are in these layouts.
        unsafe {
            let linear = vk::Filter::LINEAR;
            gpu.raw.cmd_blit_image(commands, image.raw, source, image.raw, target, &[blit], linear);
        }
    }
    if levels > 1 {
        transition(gpu, commands, image.raw, 0..levels - 1, vk::ImageLayout::TRANSFER_SRC_OPTIMAL, ready);
    }
    transition(gpu, commands, image.raw, levels - 1..levels, target, ready);
}

fn level(level: u32) -> vk::ImageSubresourceLayers {
    vk::ImageSubresourceLayers {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        mip_level: level,
        base_array_layer: 0,
        layer_count: 1,
    }
}

/// A barrier between two uses of some levels in one upload.
fn transition(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    image: vk::Image,
    levels: std::ops::Range<u32>,
    old: vk::ImageLayout,
    new: vk::ImageLayout,
) {
    let barrier = vk::ImageMemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
        .old_layout(old)
        .new_layout(new)
        .image(image)
        .subresource_range(vk::ImageSubresourceRange {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            base_mip_level: levels.start,
            level_count: levels.end - levels.start,
            base_array_layer: 0,
            layer_count: 1,
        });
    let barriers = [barrier];
    let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
    // SAFETY: the command buffer is being recorded, and the levels exist.
    unsafe { gpu.raw.cmd_pipeline_barrier2(commands, &info) };
}

/// Where a fill or copy goes in an image that is in the layout for it.
pub(crate) fn image_side(image: &Image, range: Subresources, mip: u32) -> TransferSide {
    TransferSide::Image {
        image: image.raw,
        range,
        extent: convert::extent(mip_extent(&image.descriptor, mip)),
        layout: vk::ImageLayout::TRANSFER_DST_OPTIMAL,
    }
}

/// Copies `bytes` into one plane of a mip level of `image`, which is in the state `state` and stays in it.
pub(crate) fn write_image(
    gpu: &Arc<Gpu>,
    queue: Queue,
    image: &Image,
    (plane, mip): (Aspects, u32),
    state: State,
    bytes: &[u8],
) -> Result<(), Error> {
    let staging = staged(gpu, bytes)?;
    let whole = Subresources::all(image.descriptor.format, image.descriptor.mips, image.descriptor.layers);
    gpu.submit_once("writing an image", queue, |commands| {
        barriers(gpu, commands, &[], &[state_change(image.raw, whole, state, WRITTEN)]);
        let range = Subresources { aspects: plane, base_mip: mip, mips: 1, ..whole };
        let source = TransferSide::Buffer { buffer: staging.raw, bytes: bytes.len() as u64 };
        copy_between(gpu, commands, source, image_side(image, range, mip));
        barriers(gpu, commands, &[], &[state_change(image.raw, whole, WRITTEN, state)]);
    })
}

/// Copies `bytes` to the beginning of `buffer`, which is in the state `state` and stays in it.
pub(crate) fn write_buffer(
    gpu: &Arc<Gpu>,
    queue: Queue,
    buffer: &RawBuffer,
    state: State,
    bytes: &[u8],
) -> Result<(), Error> {
    let staging = staged(gpu, bytes)?;
    gpu.submit_once("writing a buffer", queue, |commands| {
        barriers(gpu, commands, &[memory_change(state, WRITTEN)], &[]);
        let bytes = bytes.len() as u64;
        let source = TransferSide::Buffer { buffer: staging.raw, bytes };
        copy_between(gpu, commands, source, TransferSide::Buffer { buffer: buffer.raw, bytes });
        barriers(gpu, commands, &[memory_change(WRITTEN, state)], &[]);
    })
}

/// `bytes` where the device can copy from.
fn staged(gpu: &Arc<Gpu>, bytes: &[u8]) -> Result<RawBuffer, Error> {
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let mut staging = RawBuffer::new(gpu, "upload", (bytes.len() as u64).max(1), usage, MemoryUse::Upload)?;
    staging.fill(bytes)?;
    Ok(staging)
}
