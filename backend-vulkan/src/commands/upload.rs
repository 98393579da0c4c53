//! Texels and bytes from the host into images and buffers.

use super::barriers::{barriers, memory_change, state_change};
use super::readback::{level_bytes, mip_extent};
use super::transfer::{ImageSide, TransferSide, blit, copy_between, copy_to_image};
use crate::base::{Error, convert};
use crate::gpu::Gpu;
use crate::memory::{Image, MemoryUse, RawBuffer};
use ash::vk;
use framewright_graph::plan::Queue;
use framewright_graph::vulkan::{Accesses, Aspects, Layout, Stages, State, Subresources};
use std::sync::Arc;

/// The state of an image or buffer that a clear or a copy writes.
pub(crate) const WRITTEN: State = State {
    stages: Stages::COPY.union(Stages::CLEAR),
    accesses: Accesses::TRANSFER_WRITE,
    layout: Layout::TransferDstOptimal,
};

/// The state of a mip level that a blit reads, to make a smaller level.
const BLITTED: State =
    State { stages: Stages::BLIT, accesses: Accesses::TRANSFER_READ, layout: Layout::TransferSrcOptimal };

/// The state of an image while copies and blits write its mip levels.
const MADE: State = State { stages: Stages::COPY.union(Stages::BLIT), ..WRITTEN };

/// The state of an image or buffer before its first use.
pub(crate) const UNUSED: State =
    State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::Undefined };

/// Records the copy of a new image's first `held` mip levels, one after the other, from `staging`, which must live as long as the
/// commands, and of each smaller one from the level before; all of it is in the layout `ready` then, for the next commands on the
/// queue.
pub(crate) fn record_upload(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    image: &Image,
    (staging, held): (&RawBuffer, u32),
    ready: Layout,
) {
    let accesses = Accesses::MEMORY_READ.union(Accesses::MEMORY_WRITE);
    let ready = State { stages: Stages::ALL_COMMANDS, accesses, layout: ready };
    let levels = image.descriptor.mips;
    let whole = Subresources::all(image.descriptor.format, levels, image.descriptor.layers);
    let level = |base_mip: u32| Subresources { base_mip, mips: 1, ..whole };
    let change = |range, from, to| barriers(gpu, commands, &[], &[state_change(image.raw, range, from, to)]);
    change(whole, UNUSED, MADE);
    let mut from = 0;
    for stored in 0..held {
        copy_to_image(gpu, commands, (staging.raw, from), image_side(image, level(stored), stored));
        from += level_bytes(&image.descriptor, Aspects::COLOR, stored);
    }
    for smaller in held..levels {
        change(level(smaller - 1), MADE, BLITTED);
        let larger = image_side(image, level(smaller - 1), smaller - 1);
        let larger = ImageSide { layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL, ..larger };
        blit(gpu, commands, larger, image_side(image, level(smaller), smaller), vk::Filter::LINEAR);
    }
    let blitted = Subresources { base_mip: held - 1, mips: levels - held, ..whole };
    if blitted.mips > 0 {
        change(blitted, BLITTED, ready);
        change(level(levels - 1), MADE, ready);
    }
    let copied = if blitted.mips > 0 { held - 1 } else { held };
    if copied > 0 {
        change(Subresources { mips: copied, ..whole }, MADE, ready);
    }
}

/// Where a fill or copy goes in an image that is in the layout for it.
pub(crate) fn image_side(image: &Image, range: Subresources, mip: u32) -> ImageSide {
    ImageSide {
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
    let staging = staged(gpu, "upload", bytes)?;
    let whole = Subresources::all(image.descriptor.format, image.descriptor.mips, image.descriptor.layers);
    gpu.submit_once("writing an image", queue, |commands| {
        barriers(gpu, commands, &[], &[state_change(image.raw, whole, state, WRITTEN)]);
        let range = Subresources { aspects: plane, base_mip: mip, mips: 1, ..whole };
        let source = TransferSide::Buffer { buffer: staging.raw, bytes: bytes.len() as u64 };
        copy_between(gpu, commands, source, TransferSide::Image(image_side(image, range, mip)));
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
    let staging = staged(gpu, "upload", bytes)?;
    gpu.submit_once("writing a buffer", queue, |commands| {
        barriers(gpu, commands, &[memory_change(state, WRITTEN)], &[]);
        let bytes = bytes.len() as u64;
        let source = TransferSide::Buffer { buffer: staging.raw, bytes };
        copy_between(gpu, commands, source, TransferSide::Buffer { buffer: buffer.raw, bytes });
        barriers(gpu, commands, &[memory_change(WRITTEN, state)], &[]);
    })
}

/// `bytes` where the device can copy from.
pub(crate) fn staged(gpu: &Arc<Gpu>, name: &str, bytes: &[u8]) -> Result<RawBuffer, Error> {
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let mut staging = RawBuffer::new(gpu, name, (bytes.len() as u64).max(1), usage, MemoryUse::Upload)?;
    staging.fill(bytes)?;
    Ok(staging)
}
