//! Filling images and buffers with values that nobody may see.
//!
//! Where the frame takes an image into use (a barrier from `UNDEFINED`), the image is cleared to a pattern first; a buffer
//! is filled before the first step of its lifetime. The clear stands between the two scopes of the Plan's own barrier and
//! has no other: what waits for the barrier waits for the clear, and what the barrier waits for is done before it. So a
//! poisoned frame shows the same picture exactly if nobody reads what was not written, and if the Plan's barriers order
//! memory that changes hands.

use crate::convert::{self, Clear};
use crate::record::{Frame, Place, barriers, fill, memory_barriers};
use ash::vk;
use framewright_graph::format::{Format, Numeric};
use framewright_graph::plan::{Buffer, ImageBarrier, Resource, Role, Step, Work};
use framewright_graph::vocabulary::{Aspects, Layout};

const CLEAR_STAGE: vk::PipelineStageFlags2 = vk::PipelineStageFlags2::CLEAR;
const CLEAR_ACCESS: vk::AccessFlags2 = vk::AccessFlags2::TRANSFER_WRITE;
const CLEAR_LAYOUT: vk::ImageLayout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;

/// What a buffer is filled with.
const WORD: u32 = 0xDEAD_BEEF;

/// Records the barriers of the step number `index` with the poison between their scopes.
pub(crate) fn record(frame: &Frame<'_>, commands: vk::CommandBuffer, index: usize, step: &Step) {
    let images: Vec<_> = step.image_barriers.iter().filter(|barrier| takes_into_use(frame, barrier)).collect();
    let buffers: Vec<_> = frame.plan.buffers.iter().filter(|buffer| begins(buffer, index)).collect();
    let poisoned = |resource: &Resource| match resource {
        Resource::Image(image) => images.iter().any(|it| it.image == *image),
        Resource::Buffer(buffer) => buffers.iter().any(|it| it.id == *buffer),
    };
    let mut memory = memory_barriers(&step.memory_barriers);
    for (recorded, barrier) in memory.iter_mut().zip(&step.memory_barriers) {
        // Memory that changes hands is poisoned right after.
        let named = barrier.buffers.iter().any(|it| poisoned(&Resource::Buffer(it.buffer)));
        if named || barrier.hand_overs.iter().any(|[_, next]| poisoned(next)) {
            recorded.dst_stage_mask |= CLEAR_STAGE;
            recorded.dst_access_mask |= CLEAR_ACCESS;
        }
    }
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
    barriers(frame.shared, commands, &memory, &before.collect::<Vec<_>>());
    for barrier in &images {
        let image = frame.plan.image(barrier.image);
        let place = Place::Image {
            image: frame.prepared.physical.image(barrier.image, frame.number).raw,
            range: barrier.range,
            extent: vk::Extent3D::default(),
            layout: CLEAR_LAYOUT,
        };
        fill(frame.shared, commands, place, pattern(image.format));
    }
    for buffer in &buffers {
        let raw = frame.prepared.physical.buffer(buffer.id, frame.number).raw;
        fill(frame.shared, commands, Place::Buffer { buffer: raw, bytes: buffer.bytes }, Clear::Word(WORD));
    }
    let filled: Vec<_> = buffers.iter().map(|buffer| until_used(step, buffer)).collect();
    barriers(frame.shared, commands, &filled, &after.collect::<Vec<_>>());
}

/// Whether the barrier begins an image's life in the frame.
fn takes_into_use(frame: &Frame<'_>, barrier: &ImageBarrier) -> bool {
    let transient = matches!(frame.plan.image(barrier.image).role, Role::Transient(_));
    transient && barrier.old_layout == Layout::Undefined
}

/// Whether a buffer's life in the frame begins with the step.
fn begins(buffer: &Buffer, step: usize) -> bool {
    matches!(&buffer.role, Role::Transient(place) if place.lifetime[0].0 as usize == step)
}

/// From a buffer's poison to what its first step does with it.
fn until_used(step: &Step, buffer: &Buffer) -> vk::MemoryBarrier2<'static> {
    let recorded = vk::MemoryBarrier2::default().src_stage_mask(CLEAR_STAGE).src_access_mask(CLEAR_ACCESS);
    let passes = match &step.work {
        Work::Render(scope) => &scope.passes[..],
        Work::Dispatch(pass) | Work::Custom(pass) => std::slice::from_ref(pass),
        _ => &[],
    };
    let uses = passes.iter().flat_map(|pass| &pass.buffers).filter(|access| access.buffer == buffer.id);
    let (stages, accesses) = uses.fold((vk::PipelineStageFlags2::NONE, vk::AccessFlags2::NONE), |(stages, all), it| {
        (stages | convert::stages(it.stages), all | convert::accesses(it.accesses))
    });
    if stages.is_empty() {
        // A transfer.
        let transfer = vk::AccessFlags2::TRANSFER_READ | vk::AccessFlags2::TRANSFER_WRITE;
        return recorded.dst_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER).dst_access_mask(transfer);
    }
    recorded.dst_stage_mask(stages).dst_access_mask(accesses)
}

/// A colour that is conspicuous, and spreads where the format allows.
fn pattern(format: Format) -> Clear {
    if !format.aspects().contains(Aspects::COLOR) {
        return Clear::DepthStencil(vk::ClearDepthStencilValue { depth: 0.5, stencil: 0xAA });
    }
    Clear::Color(match format.numeric() {
        Numeric::Sfloat | Numeric::Ufloat => vk::ClearColorValue { float32: [f32::NAN; 4] },
        Numeric::Unorm | Numeric::Srgb => vk::ClearColorValue { float32: [1.0, 0.0, 1.0, 1.0] },
        Numeric::Uint => {
            let bits = format.texel_bytes() * 8 / u64::from(format.components().max(1));
            let mask = u32::MAX.unbounded_shr(32_u32.saturating_sub(u32::try_from(bits).unwrap_or(32)));
            vk::ClearColorValue { uint32: [WORD & mask; 4] }
        }
    })
}
