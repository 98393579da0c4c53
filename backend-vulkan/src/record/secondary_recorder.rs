//! What a program executes the secondary command buffers of a custom pass with.

use super::asked_names::AskedNames;
use super::custom_image::{CustomImage, named_buffer};
use super::eye_target::{EyeTarget, eye_of};
use crate::gpu::ScopeFormats;
use crate::prepare::{DrawTarget, Frame};
use ash::vk;
use framewright_graph::frame::{Eye, EyeForm, ParamValue, Stereo};
use framewright_graph::plan;
use framewright_graph::vulkan::Rotation;

/// What each part of a scope is begun with whose draws come in secondary command buffers: what was drawn before and what is drawn behind
/// belongs to the same scope, so nothing is loaded or stored in between.
pub(super) const FLAGS: vk::RenderingFlags =
    vk::RenderingFlags::from_raw(vk::RenderingFlags::SUSPENDING.as_raw() | vk::RenderingFlags::RESUMING.as_raw());

/// Executes the secondary command buffers of one custom pass, within its rendering scope. They were begun with
/// [`SecondaryRecorder::inheritance`], on any thread, during the frame or before it, and set all state that their draws need: viewport and
/// scissor too.
pub struct SecondaryRecorder<'f> {
    frame: &'f Frame<'f>,
    commands: vk::CommandBuffer,
    pass: &'f plan::Pass,
    formats: &'f ScopeFormats,
    target: &'f DrawTarget,
    asked: AskedNames,
}

impl<'f> SecondaryRecorder<'f> {
    pub(super) fn new(
        frame: &'f Frame<'f>,
        commands: vk::CommandBuffer,
        pass: &'f plan::Pass,
        (formats, target): (&'f ScopeFormats, &'f DrawTarget),
    ) -> SecondaryRecorder<'f> {
        SecondaryRecorder { frame, commands, pass, formats, target, asked: AskedNames::default() }
    }

    /// The images and buffers of the Plan that were asked for, and that the pass doesn't name.
    pub(super) fn asked(&self) -> Vec<String> {
        self.asked.of(self.frame.plan, self.pass)
    }

    /// The pass's name.
    #[must_use]
    pub fn pass(&self) -> &str {
        &self.pass.name
    }

    /// The view that the pass draws for, in the list of the Plan; `None` if the Plan has none.
    #[must_use]
    pub fn view(&self) -> Option<plan::ViewId> {
        self.pass.view
    }

    /// The number of the frame, as [`Executor::submit`](crate::Executor::submit) returns it.
    #[must_use]
    pub fn frame(&self) -> u64 {
        self.frame.told
    }

    /// The queue family that the command buffers are for: that of graphics.
    #[must_use]
    pub fn queue_family(&self) -> u32 {
        self.frame.gpu.queues.families.graphics.index
    }

    /// What pipelines must fit. [`Executor::formats`](crate::Executor::formats) tells it before the frame.
    #[must_use]
    pub fn formats(&self) -> &ScopeFormats {
        self.formats
    }

    /// What secondary command buffers are begun with, beside `RENDER_PASS_CONTINUE`: [`ScopeFormats::inheritance`].
    pub fn inheritance(&self) -> vk::CommandBufferInheritanceRenderingInfo<'_> {
        self.formats.inheritance()
    }

    /// Width and height of the targets, of the turned picture; where they are for both eyes, of one eye's picture.
    #[must_use]
    pub fn target_extent(&self) -> [u32; 2] {
        self.target.extent
    }

    /// The rotation of the picture in the attachments, to which the program turns its positions.
    #[must_use]
    pub fn rotation(&self) -> Rotation {
        self.target.rotation
    }

    /// How the pass draws for both eyes at once, as [`Recorder::both_eyes`](crate::Recorder::both_eyes).
    #[must_use]
    pub fn both_eyes(&self) -> Option<(Stereo, EyeForm)> {
        self.target.eyes
    }

    /// Where each eye's picture lies, as [`Recorder::eye_targets`](crate::Recorder::eye_targets).
    #[must_use]
    pub fn eye_targets(&self) -> Option<[EyeTarget; 2]> {
        EyeTarget::of_both(self.target)
    }

    /// The eye that the pass is drawn for, if it is drawn for one of two.
    #[must_use]
    pub fn eye(&self) -> Option<Eye> {
        eye_of(self.frame.plan, self.pass)
    }

    /// A parameter that the pipeline gives the pass.
    #[must_use]
    pub fn param(&self, name: &str) -> Option<ParamValue> {
        self.pass.params.iter().find(|param| *param.name == *name).map(|param| self.frame.clock.resolved(&param.value))
    }

    /// An image of the pass, by the Plan's name or the shader's: as [`Recorder::image`](crate::Recorder::image).
    #[must_use]
    pub fn image(&self, name: &str) -> Option<CustomImage> {
        self.asked.note(name, CustomImage::of(self.frame, self.pass, name))
    }

    /// A buffer of the pass, by the Plan's name or the shader's.
    #[must_use]
    pub fn buffer(&self, name: &str) -> Option<vk::Buffer> {
        self.asked.note(name, named_buffer(self.frame, self.pass, name))
    }

    /// Executes secondary command buffers, one after the other.
    ///
    /// # Safety
    /// They are of this device and of [`SecondaryRecorder::queue_family`], recorded and ended, begun with
    /// [`SecondaryRecorder::inheritance`], and hold draws into the scope's attachments that touch nothing else but what the pass names and
    /// the program's own resources. No other thread uses them or their pools meanwhile. They live, and aren't recorded anew, until each frame
    /// was waited for that executes them. One that is executed again before that, as by the next of several frames in flight or by the same
    /// pass of the other eye, was begun with `SIMULTANEOUS_USE`.
    pub unsafe fn execute(&mut self, secondary: &[vk::CommandBuffer]) {
        if !secondary.is_empty() {
            // SAFETY: the scope was begun for secondary command buffers, and the caller's word.
            unsafe { self.frame.gpu.raw.cmd_execute_commands(self.commands, secondary) };
        }
    }

    /// The command buffer, recording inside the pass's rendering scope, in which nothing but `vkCmdExecuteCommands` may be recorded, as
    /// [`SecondaryRecorder::execute`] does.
    #[must_use]
    pub fn raw(&mut self) -> vk::CommandBuffer {
        self.commands
    }
}

impl ScopeFormats {
    /// What secondary command buffers are begun with whose draws go into such a scope, beside `RENDER_PASS_CONTINUE`. It points into `self`.
    pub fn inheritance(&self) -> vk::CommandBufferInheritanceRenderingInfo<'_> {
        vk::CommandBufferInheritanceRenderingInfo::default()
            .flags(FLAGS)
            .view_mask(self.view_mask)
            .color_attachment_formats(&self.color)
            .depth_attachment_format(self.depth)
            .stencil_attachment_format(self.stencil)
            .rasterization_samples(self.samples)
    }
}
