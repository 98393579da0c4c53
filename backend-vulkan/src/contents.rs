//! Contents from outside: what persists begins with its initial value, and the host may write what outlives the frame.

use crate::buffer::RawBuffer;
use crate::convert;
use crate::device::Shared;
use crate::error::Error;
use crate::image::Image;
use crate::memory::Kind;
use crate::physical::Physical;
use crate::readback::{memory_change, mip_extent};
use crate::record::{Place, barriers, copy_between, fill, state_change};
use ash::vk;
use framewright_graph::plan::{Plan, Queue, Role, Subresources};
use framewright_graph::vocabulary::{Accesses, Aspects, FillValue, Layout, Stages, State, Usage};
use std::sync::Arc;

/// Not used by anything yet.
pub(crate) const UNUSED: State =
    State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::Undefined };

/// While it is set to a value or copied to.
const WRITTEN: State = State {
    stages: Stages::COPY.union(Stages::CLEAR),
    accesses: Accesses::TRANSFER_WRITE,
    layout: Layout::TransferDstOptimal,
};

/// Sets everything that outlives the frame and was not handed in to what the first frame finds: persistent things to their
/// initial value, others to zero, and each to the state that the Plan relies on.
pub(crate) fn initialise(shared: &Arc<Shared>, plan: &Plan, physical: &Physical) -> Result<(), Error> {
    shared.submit_once("preparing the first frame", Queue::Graphics, |commands| {
        for image in &plan.images {
            let made = physical.image(image.id, 0);
            let (before, initial) = match &image.role {
                Role::Persistent { before, initial, .. } => (*before, *initial),
                Role::External { before, .. } if before.layout != Layout::Undefined && !made.is_foreign() => {
                    (*before, FillValue::Bits([0; 4]))
                }
                Role::Transient(_) | Role::External { .. } => continue,
            };
            let whole = Subresources::all(image.format, image.mips, image.layers);
            let mut state = UNUSED;
            if made.descriptor.usage.contains(Usage::TRANSFER_DST) {
                barriers(shared, commands, &[], &[state_change(made.raw, whole, UNUSED, WRITTEN)]);
                let target = image_place(made, whole, 0);
                fill(shared, commands, target, convert::clear(Some(image.format), initial));
                state = WRITTEN;
            }
            barriers(shared, commands, &[], &[state_change(made.raw, whole, state, before)]);
        }
        for buffer in &plan.buffers {
            let made = physical.buffer(buffer.id, 0);
            let (before, initial) = match &buffer.role {
                Role::Persistent { before, initial, .. } => (*before, *initial),
                Role::External { before, .. } if !made.is_foreign() => (*before, FillValue::Bits([0; 4])),
                Role::Transient(_) | Role::External { .. } => continue,
            };
            let target = Place::Buffer { buffer: made.raw, bytes: made.bytes };
            fill(shared, commands, target, convert::clear(None, initial));
            barriers(shared, commands, &[memory_change(WRITTEN, before)], &[]);
        }
    })
}

fn image_place(image: &Image, range: Subresources, mip: u32) -> Place {
    Place::Image {
        image: image.raw,
        range,
        extent: convert::extent(mip_extent(&image.descriptor, mip)),
        layout: vk::ImageLayout::TRANSFER_DST_OPTIMAL,
    }
}

/// Copies `bytes` into one plane of a mip level of `image`, which is in the state `state` and stays in it.
pub(crate) fn write_image(
    shared: &Arc<Shared>,
    queue: Queue,
    image: &Image,
    (plane, mip): (Aspects, u32),
    state: State,
    bytes: &[u8],
) -> Result<(), Error> {
    let staging = staged(shared, bytes)?;
    let whole = Subresources::all(image.descriptor.format, image.descriptor.mips, image.descriptor.layers);
    shared.submit_once("writing an image", queue, |commands| {
        barriers(shared, commands, &[], &[state_change(image.raw, whole, state, WRITTEN)]);
        let range = Subresources { aspects: plane, base_mip: mip, mips: 1, ..whole };
        let source = Place::Buffer { buffer: staging.raw, bytes: bytes.len() as u64 };
        copy_between(shared, commands, source, image_place(image, range, mip));
        barriers(shared, commands, &[], &[state_change(image.raw, whole, WRITTEN, state)]);
    })
}

/// Copies `bytes` to the beginning of `buffer`, which is in the state `state` and stays in it.
pub(crate) fn write_buffer(
    shared: &Arc<Shared>,
    queue: Queue,
    buffer: &RawBuffer,
    state: State,
    bytes: &[u8],
) -> Result<(), Error> {
    let staging = staged(shared, bytes)?;
    shared.submit_once("writing a buffer", queue, |commands| {
        barriers(shared, commands, &[memory_change(state, WRITTEN)], &[]);
        let bytes = bytes.len() as u64;
        let source = Place::Buffer { buffer: staging.raw, bytes };
        copy_between(shared, commands, source, Place::Buffer { buffer: buffer.raw, bytes });
        barriers(shared, commands, &[memory_change(WRITTEN, state)], &[]);
    })
}

/// `bytes` where the device can copy from.
fn staged(shared: &Arc<Shared>, bytes: &[u8]) -> Result<RawBuffer, Error> {
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let mut staging = RawBuffer::new(shared, "upload", (bytes.len() as u64).max(1), usage, Kind::Upload)?;
    staging.fill(bytes)?;
    Ok(staging)
}
