//! What a frame is recorded from, and what recording it leaves.

use super::recorder::HeldResources;
use super::timing::Counts;
use crate::base::{Error, convert};
use crate::commands::TransferSide;
use crate::gpu::Gpu;
use crate::pipeline::PARTS_STAGES;
use crate::prepare::{PreparedPlan, part};
use ash::vk;
use framewright_graph::frame::EyeForm;
use framewright_graph::plan::{self, ImageBarrier, ImageId, Plan, Side};
use framewright_graph::vulkan::{Layout, Subresources};
use std::time::Duration;

/// What a frame is recorded from.
pub(crate) struct Frame<'f> {
    pub(crate) gpu: &'f Gpu,
    pub(crate) plan: &'f Plan,
    pub(crate) prepared: &'f PreparedPlan,
    /// Which frame it is, from 0.
    pub(crate) number: u64,
    pub(crate) poison: bool,
}

/// A recorded frame.
#[derive(Default)]
pub(crate) struct Recorded {
    /// By pass.
    pub(crate) counts: Vec<Counts>,
    pub(crate) kept: HeldResources,
    /// How long that took.
    pub(crate) took: Duration,
}

impl Frame<'_> {
    /// A barrier of the Plan.
    pub(crate) fn image_barrier(&self, barrier: &ImageBarrier) -> vk::ImageMemoryBarrier2<'static> {
        let recorded = vk::ImageMemoryBarrier2::default()
            .src_stage_mask(convert::stages(barrier.src_stages))
            .src_access_mask(convert::accesses(barrier.src_accesses))
            .dst_stage_mask(convert::stages(barrier.dst_stages))
            .dst_access_mask(convert::accesses(barrier.dst_accesses))
            .old_layout(convert::layout(barrier.old_layout))
            .new_layout(convert::layout(barrier.new_layout))
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.prepared.physical.image(barrier.image, self.number).raw)
            .subresource_range(convert::range(part(self.plan.image(barrier.image), barrier.range)));
        match barrier.ownership {
            None => recorded,
            Some([from, to]) => {
                let families = &self.gpu.queues.families;
                recorded
                    .src_queue_family_index(families.family(from).index)
                    .dst_queue_family_index(families.family(to).index)
            }
        }
    }

    /// Where a side of a transfer is in this frame.
    pub(crate) fn side(&self, side: &Side) -> TransferSide {
        match side {
            Side::Image { image, range, extent, layout } => self.image_side(*image, *range, *extent, *layout),
            Side::Buffer { buffer, bytes } => {
                TransferSide::Buffer { buffer: self.prepared.physical.buffer(*buffer, self.number).raw, bytes: *bytes }
            }
        }
    }

    pub(crate) fn image_side(
        &self,
        image: ImageId,
        range: Subresources,
        extent: [u32; 3],
        layout: Layout,
    ) -> TransferSide {
        let planned = self.plan.image(image);
        TransferSide::Image {
            image: self.prepared.physical.image(image, self.number).raw,
            range: part(planned, range),
            extent: convert::extent(EyeForm::extent(planned.eyes, extent, planned.rotation)),
            layout: convert::layout(layout),
        }
    }

    /// Tells the pass's shaders which parts of images are in use.
    pub(super) fn tell_parts(&self, commands: vk::CommandBuffer, pass: &plan::Pass, layout: vk::PipelineLayout) {
        let parts: Vec<u8> = self.plan.parts(pass).flat_map(|(_, part)| part.map(f32::to_ne_bytes)).flatten().collect();
        if !parts.is_empty() {
            // SAFETY: the command buffer is being recorded, every layout has this range, and no more parts than fit were let
            // through.
            unsafe { self.gpu.raw.cmd_push_constants(commands, layout, PARTS_STAGES, 0, &parts) };
        }
    }
}

/// Nothing was made for the frame: [`crate::prepare::PreparedPlan::prepare_frame`] comes before recording.
pub(super) fn unprepared() -> Error {
    Error::BadPlan { what: "nothing was prepared for this frame".to_owned() }
}
