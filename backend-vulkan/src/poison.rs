//! Filling images with values that nobody may see.
//!
//! Where the frame takes an image into use (a barrier from `UNDEFINED`), the image is cleared to a pattern first. The clear
//! stands between the two scopes of the Plan's own barrier and has no other: what waits for the barrier waits for the
//! clear, and what the barrier waits for is done before it. So a poisoned frame shows the same picture exactly if nobody
//! reads what was not written, and if the Plan's barriers order memory that changes hands.

use crate::convert;
use crate::record::{Frame, barriers, memory_barriers};
use ash::vk;
use framewright_graph::format::{Format, Numeric};
use framewright_graph::plan::{ImageBarrier, Role, Step};
use framewright_graph::vocabulary::Layout;

const CLEAR_STAGE: vk::PipelineStageFlags2 = vk::PipelineStageFlags2::CLEAR;
const CLEAR_ACCESS: vk::AccessFlags2 = vk::AccessFlags2::TRANSFER_WRITE;
const CLEAR_LAYOUT: vk::ImageLayout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;

/// Records a step's barriers with the poison between their scopes.
pub(crate) fn record(frame: &Frame<'_>, commands: vk::CommandBuffer, step: &Step) {
    let poisoned: Vec<_> = step.image_barriers.iter().filter(|barrier| takes_into_use(frame, barrier)).collect();
    let mut memory = memory_barriers(&step.memory_barriers);
    for (recorded, barrier) in memory.iter_mut().zip(&step.memory_barriers) {
        // Memory that changes hands is poisoned right after.
        if barrier.hand_overs.iter().any(|[_, next]| poisoned.iter().any(|it| it.image == *next)) {
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
    let after = poisoned.iter().map(|barrier| {
        let recorded = frame.image_barrier(barrier);
        recorded.src_stage_mask(CLEAR_STAGE).src_access_mask(CLEAR_ACCESS).old_layout(CLEAR_LAYOUT)
    });
    barriers(frame.shared, commands, &memory, &before.collect::<Vec<_>>());
    poisoned.iter().for_each(|barrier| clear(frame, commands, barrier));
    barriers(frame.shared, commands, &[], &after.collect::<Vec<_>>());
}

/// Whether the barrier begins an image's life in the frame.
fn takes_into_use(frame: &Frame<'_>, barrier: &ImageBarrier) -> bool {
    let transient = matches!(frame.plan.image(barrier.image).role, Role::Transient(_));
    transient && barrier.old_layout == Layout::Undefined
}

fn clear(frame: &Frame<'_>, commands: vk::CommandBuffer, barrier: &ImageBarrier) {
    let device = &frame.shared.raw;
    let image = frame.prepared.images[barrier.image.0 as usize].raw;
    let format = frame.plan.image(barrier.image).format;
    let ranges = [convert::range(barrier.range)];
    // SAFETY: the command buffer is being recorded outside a scope, the image is in this layout since the barrier before,
    // and it was checked that it may be a transfer's destination.
    unsafe {
        if format.is_depth() {
            let value = vk::ClearDepthStencilValue { depth: 0.5, stencil: 0xAA };
            device.cmd_clear_depth_stencil_image(commands, image, CLEAR_LAYOUT, &value, &ranges);
        } else {
            device.cmd_clear_color_image(commands, image, CLEAR_LAYOUT, &pattern(format), &ranges);
        }
    }
}

/// A colour that is conspicuous, and spreads where the format allows.
fn pattern(format: Format) -> vk::ClearColorValue {
    match format.numeric() {
        Numeric::Sfloat | Numeric::Ufloat => vk::ClearColorValue { float32: [f32::NAN; 4] },
        Numeric::Unorm | Numeric::Srgb => vk::ClearColorValue { float32: [1.0, 0.0, 1.0, 1.0] },
        Numeric::Uint => {
            let bits = format.texel_bytes() * 8 / u64::from(format.components().max(1));
            vk::ClearColorValue {
                uint32: [0xDEAD_BEEF_u32 & u32::MAX.unbounded_shr(32_u32.saturating_sub(bits as u32)); 4],
            }
        }
    }
}
