//! Poison: fills images and buffers with values that nobody may see.
//!
//! Images: a barrier from `UNDEFINED` takes an image into use. The image is cleared to a pattern between the two scopes of
//! this barrier. The clear needs no barrier of its own: what waits for the barrier waits for the clear, and what the barrier
//! waits for is done before the clear.
//!
//! Buffers: no such barrier exists, and the barrier that hands over the memory may stand before an earlier step. So a buffer
//! is filled right before the first step of its lifetime, after all that the Plan orders before that step. The fill is made
//! visible to that step. So is a buffer that a step replaces in every frame: a promise that all of it is written is false where poison stays.
//!
//! Neither makes any write available that the Plan doesn't. So a poisoned frame shows the same picture exactly if nobody
//! reads what was not written, and if the Plan's barriers order memory that changes hands.

use super::command_list::{Command, CommandList};
use super::frame::Frame;
use crate::base::{Clear, convert};
use crate::commands::{ImageSide, TransferCommand, TransferSide, memory_barrier};
use ash::vk;
use framewright_graph::plan::{Buffer, BufferAccess, ImageBarrier, Resource, Role, Step, Work};
use framewright_graph::vulkan::{Aspects, BufferUsage, Format, Layout, Numeric, Usage};

const CLEAR_STAGE: vk::PipelineStageFlags2 = vk::PipelineStageFlags2::CLEAR;
const CLEAR_ACCESS: vk::AccessFlags2 = vk::AccessFlags2::TRANSFER_WRITE;
const CLEAR_LAYOUT: vk::ImageLayout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;

/// The word that poisons a buffer.
const WORD: u32 = 0xDEAD_BEEF;

/// Adds the barriers of the step number `index` with the poison between their scopes.
pub(super) fn push_poisoned_barriers(list: &mut CommandList, frame: &Frame<'_>, index: usize, step: &Step) {
    let images: Vec<_> = step.image_barriers.iter().filter(|barrier| takes_into_use(frame, barrier)).collect();
    // Where a step is left out, what it would replace stays.
    let poisoned = |buffer: &&Buffer| begins(buffer, index) || step.run.is_always() && replaces(step, buffer);
    let buffers: Vec<_> = frame.plan.buffers.iter().filter(poisoned).collect();
    let memory = step.memory_barriers.iter().map(|barrier| {
        let recorded = memory_barrier(barrier);
        // Memory that changes hands is poisoned right after.
        let is_poisoned = |next: &Resource| images.iter().any(|it| Resource::Image(it.image) == *next);
        if barrier.hand_overs.iter().any(|[_, next]| is_poisoned(next)) {
            let (stages, accesses) = (recorded.dst_stage_mask, recorded.dst_access_mask);
            recorded.dst_stage_mask(stages | CLEAR_STAGE).dst_access_mask(accesses | CLEAR_ACCESS)
        } else {
            recorded
        }
    });
    let before = step.image_barriers.iter().map(|barrier| {
        let recorded = frame.image_barrier(barrier);
        if takes_into_use(frame, barrier) {
            recorded.dst_stage_mask(CLEAR_STAGE).dst_access_mask(CLEAR_ACCESS).new_layout(CLEAR_LAYOUT)
        } else {
            recorded
        }
    });
    let after = images.iter().map(|barrier| {
        let recorded = frame.image_barrier(barrier);
        recorded.src_stage_mask(CLEAR_STAGE).src_access_mask(CLEAR_ACCESS).old_layout(CLEAR_LAYOUT)
    });
    list.push_barriers(frame.gpu, memory, before);
    for barrier in &images {
        let (image, range, extent) = (frame.image(barrier.image).raw, barrier.range, vk::Extent3D::default());
        let place = TransferSide::Image(ImageSide { image, range, extent, layout: CLEAR_LAYOUT });
        push_fill(list, place, pattern(frame.plan.image(barrier.image).format));
    }
    let first_uses: Vec<_> = buffers.iter().map(|buffer| first_use(step, buffer)).collect();
    // A barrier of its own call, so that it goes on from where the Plan's barriers lead.
    list.push_barriers(frame.gpu, first_uses.iter().map(until_filled), []);
    for buffer in &buffers {
        let place = TransferSide::Buffer { buffer: frame.buffer(buffer.id).raw, bytes: buffer.bytes };
        push_fill(list, place, Clear::Word(WORD));
    }
    list.push_barriers(frame.gpu, first_uses.iter().map(until_used), after);
}

fn push_fill(list: &mut CommandList, place: TransferSide, value: Clear) {
    list.push(Command::Transfer(Box::new(TransferCommand::Fill(place, value))));
}

/// Whether the barrier begins an image's life, or gives up its contents, and the image can be poisoned.
fn takes_into_use(frame: &Frame<'_>, barrier: &ImageBarrier) -> bool {
    let image = frame.plan.image(barrier.image);
    barrier.old_layout == Layout::Undefined && image.usage.contains(Usage::TRANSFER_DST)
}

/// Whether a buffer's life in the frame begins with the step.
fn begins(buffer: &Buffer, step: usize) -> bool {
    matches!(&buffer.role, Role::Transient(place) if place.lifetime[0].0 as usize == step)
}

/// Whether the step replaces all of a buffer, as its passes promise, and the buffer can be poisoned.
fn replaces(step: &Step, buffer: &Buffer) -> bool {
    let mut uses =
        step.work.passes().iter().flat_map(|pass| &pass.buffers).filter(|it| it.buffer == buffer.id).peekable();
    let whole = |it: &BufferAccess| it.role.is_some_and(|role| !role.reads() && role.writes());
    buffer.usage.contains(BufferUsage::TRANSFER_DST) && uses.peek().is_some() && uses.all(whole)
}

/// Stages and accesses.
type SyncScope = (vk::PipelineStageFlags2, vk::AccessFlags2);

/// Stages and accesses of the first step of a buffer's lifetime.
fn first_use(step: &Step, buffer: &Buffer) -> SyncScope {
    match &step.work {
        Work::Render(_) | Work::Dispatch(_) | Work::Custom(_) => {}
        Work::Fill(_) => return (CLEAR_STAGE, CLEAR_ACCESS),
        // Nothing but copies names buffers.
        Work::Copy(_) | Work::Blit(_) | Work::Resolve(_) | Work::Export => {
            return (vk::PipelineStageFlags2::COPY, vk::AccessFlags2::TRANSFER_READ | vk::AccessFlags2::TRANSFER_WRITE);
        }
    }
    let uses = step.work.passes().iter().flat_map(|pass| &pass.buffers).filter(|access| access.buffer == buffer.id);
    uses.fold((vk::PipelineStageFlags2::NONE, vk::AccessFlags2::NONE), |(stages, accesses), it| {
        (stages | convert::stages(it.stages), accesses | convert::accesses(it.accesses))
    })
}

/// The Plan's barriers lead to a buffer's first use: from there on to its poison.
fn until_filled((stages, _): &SyncScope) -> vk::MemoryBarrier2<'static> {
    vk::MemoryBarrier2::default().src_stage_mask(*stages).dst_stage_mask(CLEAR_STAGE).dst_access_mask(CLEAR_ACCESS)
}

/// From a buffer's poison to its first use.
fn until_used((stages, accesses): &SyncScope) -> vk::MemoryBarrier2<'static> {
    vk::MemoryBarrier2::default()
        .src_stage_mask(CLEAR_STAGE)
        .src_access_mask(CLEAR_ACCESS)
        .dst_stage_mask(*stages)
        .dst_access_mask(*accesses)
}

/// A colour that is conspicuous, and spreads where the format allows.
pub(crate) fn pattern(format: Format) -> Clear {
    if !format.aspects().contains(Aspects::COLOR) {
        return Clear::DepthStencil(vk::ClearDepthStencilValue { depth: 0.5, stencil: 0xAA });
    }
    Clear::Color(match format.numeric() {
        Numeric::Sfloat | Numeric::Ufloat => vk::ClearColorValue { float32: [f32::NAN; 4] },
        Numeric::Unorm | Numeric::Snorm | Numeric::Srgb => vk::ClearColorValue { float32: [1.0, 0.0, 1.0, 1.0] },
        Numeric::Uint | Numeric::Sint => {
            // The sign stays clear, so that signed and unsigned numbers have the same bits.
            let sign = u64::from(format.numeric() == Numeric::Sint);
            let bits = format.texel_bytes() * 8 / u64::from(format.components().max(1)) - sign;
            let mask = u32::MAX.unbounded_shr(32_u32.saturating_sub(u32::try_from(bits).unwrap_or(32)));
            vk::ClearColorValue { uint32: [WORD & mask; 4] }
        }
    })
}
