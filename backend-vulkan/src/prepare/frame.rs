//! A Plan in one frame: the images and buffers that stand for its own, in Vulkan's words.

use super::descriptions::part;
use super::physical::PhysicalResources;
use super::rings::Turn;
use crate::base::convert;
use crate::commands::{ImageSide, TransferSide};
use crate::gpu::Gpu;
use crate::memory::{Image, RawBuffer};
use crate::resources::ProgramSets;
use ash::vk;
use framewright_graph::frame::{EyeForm, FrameValue, ParamValue};
use framewright_graph::plan::{BufferId, ImageBarrier, ImageId, Plan, Side, Step};
use framewright_graph::vulkan::{Layout, Subresources};
use std::sync::Arc;

/// A Plan, and what stands for its images and buffers in one frame.
pub(crate) struct Frame<'f> {
    pub(crate) gpu: &'f Arc<Gpu>,
    pub(crate) plan: &'f Plan,
    pub(crate) physical: &'f PhysicalResources,
    /// The sets that the program binds for all passes.
    pub(crate) sets: &'f ProgramSets,
    /// The number of the frame among those of its executor, from 0.
    pub(crate) number: u64,
    /// The number by which the program knows it. Preparing, which shows the program nothing, has none.
    pub(crate) told: u64,
    /// By step, whether it is left out; empty: none is.
    pub(crate) left_out: &'f [bool],
    /// What its parameters may be of.
    pub(crate) clock: FrameClock,
}

/// The values that each frame has its own of.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct FrameClock {
    /// The frame's number.
    pub(crate) frame: u64,
    /// Its time in seconds.
    pub(crate) seconds: f64,
}

impl FrameClock {
    /// A parameter as a pass that the program records gets it.
    pub(crate) fn resolved(self, value: &ParamValue) -> ParamValue {
        match value {
            ParamValue::OfFrame(FrameValue::Frame) => ParamValue::Integer(i64::from(self.number())),
            ParamValue::OfFrame(FrameValue::Time) => ParamValue::Number(self.seconds),
            ParamValue::List(values) => ParamValue::list(values.iter().map(|value| self.resolved(value))),
            ParamValue::Bool(_) | ParamValue::Integer(_) | ParamValue::Number(_) => value.clone(),
        }
    }

    /// A value as a shader gets it.
    pub(crate) fn word(self, value: FrameValue) -> [u8; 4] {
        #[allow(clippy::cast_possible_truncation, reason = "shaders compute in 32 bits")]
        let seconds = self.seconds as f32;
        match value {
            FrameValue::Frame => self.number().to_ne_bytes(),
            FrameValue::Time => seconds.to_ne_bytes(),
        }
    }

    /// The number of the frame in 32 bits, which begins anew with 0 behind the largest.
    fn number(self) -> u32 {
        #[allow(clippy::cast_possible_truncation, reason = "it begins anew")]
        let number = self.frame as u32;
        number
    }
}

impl Frame<'_> {
    /// Whether the work of a step is recorded.
    pub(crate) fn runs(&self, step: usize) -> bool {
        !self.left_out.get(step).is_some_and(|out| *out)
    }

    /// The image on the device that stands for a Plan's image.
    pub(crate) fn image(&self, image: ImageId) -> &Arc<Image> {
        self.physical.image(image, self.number)
    }

    /// Width, height and depth of a mip level of what a Plan's image holds: of a part, if more is allocated.
    pub(crate) fn extent(&self, image: ImageId, mip: u32) -> [u32; 3] {
        let planned = self.plan.image(image);
        planned.level(self.physical.extent(planned, self.number), mip)
    }

    /// The buffer on the device that stands for a Plan's buffer.
    pub(crate) fn buffer(&self, buffer: BufferId) -> &Arc<RawBuffer> {
        self.physical.buffer(buffer, self.number)
    }

    /// What stands for what.
    pub(crate) fn turn(&self) -> Turn<'_> {
        self.physical.turn(self.number)
    }

    /// The barriers that release images of a step to other queues. To a queue of the same family nothing is released: the barrier that
    /// acquires does all of it.
    pub(super) fn releases(&self, step: &Step) -> impl Iterator<Item = vk::ImageMemoryBarrier2<'static>> {
        step.releases.iter().filter(|barrier| self.handed_over(barrier).is_some()).map(|it| self.image_barrier(it))
    }

    /// The two families between which a barrier hands an image over, if they are two.
    fn handed_over(&self, barrier: &ImageBarrier) -> Option<[u32; 2]> {
        let [from, to] = barrier.ownership?.map(|queue| self.gpu.queues.families.family(queue).index);
        (from != to).then_some([from, to])
    }

    /// A barrier of the Plan.
    pub(super) fn image_barrier(&self, barrier: &ImageBarrier) -> vk::ImageMemoryBarrier2<'static> {
        let recorded = vk::ImageMemoryBarrier2::default()
            .src_stage_mask(convert::stages(barrier.src_stages))
            .src_access_mask(convert::accesses(barrier.src_accesses))
            .dst_stage_mask(convert::stages(barrier.dst_stages))
            .dst_access_mask(convert::accesses(barrier.dst_accesses))
            .old_layout(convert::layout(barrier.old_layout))
            .new_layout(convert::layout(barrier.new_layout))
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.image(barrier.image).raw)
            .subresource_range(convert::range(part(self.plan.image(barrier.image), barrier.range)));
        match (barrier.ownership, self.handed_over(barrier)) {
            // An image that the program hands in goes on from the semaphore that the frame waited for.
            (None, _) if barrier.src_stages.is_empty() && self.image(barrier.image).is_foreign() => {
                recorded.src_stage_mask(recorded.dst_stage_mask)
            }
            (None, _) => recorded,
            (Some(_), Some([from, to])) => recorded.src_queue_family_index(from).dst_queue_family_index(to),
            // It goes on from the semaphore that the step waited for, in all stages.
            (Some(_), None) => recorded.src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS),
        }
    }

    /// A side of a transfer.
    pub(super) fn side(&self, side: &Side) -> TransferSide {
        match side {
            Side::Image { image, range, extent, layout } => {
                TransferSide::Image(self.image_side(*image, *range, *extent, *layout))
            }
            Side::Buffer { buffer, bytes } => TransferSide::Buffer { buffer: self.buffer(*buffer).raw, bytes: *bytes },
        }
    }

    /// A part of an image as a side of a transfer.
    pub(crate) fn image_side(
        &self,
        image: ImageId,
        range: Subresources,
        extent: [u32; 3],
        layout: Layout,
    ) -> ImageSide {
        let planned = self.plan.image(image);
        ImageSide {
            image: self.image(image).raw,
            range: part(planned, range),
            extent: convert::extent(EyeForm::extent(planned.eyes, extent, planned.rotation)),
            layout: convert::layout(layout),
        }
    }
}
