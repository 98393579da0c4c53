//! Custom passes within a rendering scope whose draws come in secondary command buffers.

use super::asked_names::AskedNames;
use super::custom_image::{CustomImage, named_buffer};
use super::eye_target::{EyeTarget, eye_of};
use super::recorded_frame::Counts;
use super::scope::begin;
use super::step::Recording;
use crate::base::Error;
use crate::gpu::ScopeFormats;
use crate::prepare::{DrawCommand, DrawTarget, Frame, ScopeCommand};
use ash::vk;
use framewright_graph::frame::{Draw, Eye, EyeForm, ParamValue, Stereo};
use framewright_graph::plan;
use framewright_graph::vulkan::Rotation;

/// What each part of a scope is begun with whose draws come in secondary command buffers: what was drawn before and what is drawn behind
/// belongs to the same scope, so nothing is loaded or stored in between.
const FLAGS: vk::RenderingFlags =
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

impl SecondaryRecorder<'_> {
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
    #[must_use]
    pub fn inheritance(&self) -> vk::CommandBufferInheritanceRenderingInfo<'_> {
        self.formats.inheritance()
    }

    /// Width and height of what is drawn into: of the turned picture, and of both eyes' halves.
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
    /// the program's own resources. No other thread uses them or their pools meanwhile, and they live until the frame was waited for.
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
    #[must_use]
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

/// The scope that is being recorded.
#[derive(Clone, Copy)]
pub(super) struct OpenScope<'r> {
    command: &'r ScopeCommand,
    /// How many of its passes, from the one that is recorded on, have their draws in secondary command buffers.
    left: usize,
}

impl OpenScope<'_> {
    /// What the scope is begun with, or gone on with, for passes that record into the frame's own command buffer.
    fn flags(&self) -> vk::RenderingFlags {
        if self.left > 0 { vk::RenderingFlags::SUSPENDING } else { vk::RenderingFlags::empty() }
    }
}

impl<'r> Recording<'r> {
    /// Begins the rendering scope of a step.
    pub(super) fn begin_scope(&mut self, commands: vk::CommandBuffer, step: usize, command: &'r ScopeCommand) {
        let passes = self.frame.plan.steps[step].work.passes();
        let left = passes.iter().filter(|pass| has_secondary(self.source, pass)).count();
        let scope = OpenScope { command, left };
        self.scope = Some(scope);
        begin(self.frame.gpu, commands, &self.prepared.list, command, scope.flags());
    }

    /// Records a pass whose draws come in secondary command buffers, if it is one.
    pub(super) fn secondary(
        &mut self,
        commands: vk::CommandBuffer,
        step: usize,
        draw: &DrawCommand,
    ) -> Result<Option<Counts>, Error> {
        let pass = &self.frame.plan.steps[step].work.passes()[draw.pass as usize];
        let Some(scope) = self.scope.as_mut().filter(|scope| scope.left > 0) else { return Ok(None) };
        if !has_secondary(self.source, pass) {
            return Ok(None);
        }
        scope.left -= 1;
        let scope = *scope;
        let formats = &self.prepared.steps[step].draws()[draw.pass as usize].state.formats;
        let misused = |what: &str| Error::Recording { pass: pass.name.to_string(), what: what.to_owned() };
        if formats.local.is_some() {
            return Err(misused("secondary command buffers in a scope whose passes read what it drew"));
        }
        if self.observers.fragments.is_some() {
            return Err(misused(
                "secondary command buffers while fragments are counted, which they would have to inherit",
            ));
        }
        let (gpu, list) = (self.frame.gpu, &self.prepared.list);
        let go_on = |flags| {
            // SAFETY: the scope is open, and suspended: the next command goes on with it.
            unsafe { gpu.raw.cmd_end_rendering(commands) };
            begin(gpu, commands, list, scope.command, flags);
        };
        go_on(FLAGS | vk::RenderingFlags::CONTENTS_SECONDARY_COMMAND_BUFFERS);
        let target = &list.targets[draw.target as usize];
        let asked = AskedNames::default();
        let mut recorder = SecondaryRecorder { frame: self.frame, commands, pass, formats, target, asked };
        let draws = self.source.secondary(&pass.shader, &mut recorder)?;
        let asked = recorder.asked.of(self.frame.plan);
        if let Some(watch) = &mut self.observers.watch {
            watch.note_asked(pass, asked);
        }
        go_on(vk::RenderingFlags::RESUMING | scope.flags());
        // Behind secondary command buffers no state is what it was.
        self.state.lose_track();
        self.state.begin_pass();
        Ok(Some(Counts { draws, culled: 0 }))
    }
}

/// Whether the draws of a pass come in secondary command buffers.
fn has_secondary(source: &mut dyn super::DrawSource, pass: &plan::Pass) -> bool {
    pass.draw.is_some_and(Draw::is_custom) && source.has_secondary(&pass.shader)
}
