//! A Plan's steps as commands: what was prepared for each is walked, and nothing is allocated.

use super::custom::CustomRecorder;
use super::draw_source::DrawSource;
use super::recorder::HeldResources;
use super::state::CommandState;
use super::timing::{Counts, Timing};
use crate::base::Error;
use crate::gpu::Gpu;
use crate::pipeline::PARTS_STAGES;
use crate::prepare::{
    DispatchCommands, Frame, PreparedDispatch, PreparedStep, PreparedWork, WorkCommands, WorkgroupCount,
};
use ash::vk;
use framewright_graph::plan::{Pass, Queue, Step, Work};
use std::time::Duration;

/// The recording of a frame.
pub(crate) struct Recording<'r> {
    pub(crate) frame: &'r Frame<'r>,
    pub(crate) source: &'r mut dyn DrawSource,
    /// If the frame is timed.
    pub(crate) timing: Option<&'r mut Timing>,
    pub(crate) recorded: &'r mut Recorded,
    /// Of the command buffer that is being recorded.
    pub(crate) state: CommandState,
}

/// A recorded frame.
#[derive(Default)]
pub(crate) struct Recorded {
    /// By pass.
    pub(crate) counts: Vec<Counts>,
    pub(super) kept: HeldResources,
    /// How long that took.
    pub(crate) took: Duration,
}

impl Recorded {
    /// Makes it empty for the next frame, which finds the memory of this one. The device must be done with the frame.
    pub(crate) fn clear(&mut self) {
        self.counts.clear();
        self.kept.clear();
    }
}

impl Recording<'_> {
    /// Begins the command buffer of a batch.
    pub(crate) fn begin_batch(&mut self, commands: vk::CommandBuffer, queue: Queue) {
        self.state.begin_commands();
        if let Some(timing) = &mut self.timing {
            timing.begin_batch(commands, queue);
        }
    }

    /// Records a step.
    pub(crate) fn step(&mut self, commands: vk::CommandBuffer, step: &Step, made: &PreparedStep) -> Result<(), Error> {
        let gpu = self.frame.gpu;
        let unprepared = || Error::BadPlan { what: "nothing was prepared for this frame".to_owned() };
        let prepared = made.commands.at(self.frame.number).ok_or_else(unprepared)?;
        gpu.labelled(commands, &made.label, || {
            prepared.before.iter().for_each(|it| it.record(gpu, commands));
            match (&step.work, &made.work, &prepared.work) {
                (Work::Render(plan), PreparedWork::Render(made), WorkCommands::Render(scope)) => {
                    self.render(commands, plan, made, scope)?;
                }
                (Work::Dispatch(_), PreparedWork::Dispatch(made), WorkCommands::Dispatch(pass)) => {
                    self.dispatch(commands, made, pass);
                    self.end_pass(commands, Counts { draws: 1, culled: 0 });
                }
                (Work::Custom(pass), ..) => {
                    let draws = self.custom(commands, pass)?;
                    self.end_pass(commands, Counts { draws, culled: 0 });
                }
                _ => {}
            }
            prepared.releases.record(gpu, commands);
            self.stamp(commands);
            Ok(())
        })
    }

    /// Notes what was recorded for a pass, and when it ends.
    pub(super) fn end_pass(&mut self, commands: vk::CommandBuffer, counts: Counts) {
        self.recorded.counts.push(counts);
        self.stamp(commands);
    }

    /// Writes the next timestamp, if the frame is timed.
    fn stamp(&mut self, commands: vk::CommandBuffer) {
        if let Some(timing) = &mut self.timing {
            timing.stamp(commands);
        }
    }

    fn custom(&mut self, commands: vk::CommandBuffer, pass: &Pass) -> Result<u32, Error> {
        self.state.lose_track();
        let mut recorder = CustomRecorder::new(self.frame, commands, pass);
        self.source.custom(&pass.shader, &mut recorder)?;
        recorder.finish().map_err(|what| Error::Recording { pass: pass.name.to_string(), what })
    }

    fn dispatch(&mut self, commands: vk::CommandBuffer, made: &PreparedDispatch, pass: &DispatchCommands) {
        let gpu = self.frame.gpu;
        self.state.begin_pass();
        tell_parts(gpu, commands, made.layout, &pass.parts);
        let device = &gpu.raw;
        // SAFETY: the command buffer is being recorded outside a scope, the set has the layout's only set layout, and counts
        // and the buffer behind them were checked.
        unsafe {
            let compute = vk::PipelineBindPoint::COMPUTE;
            if self.state.needs_compute(made.pipeline) {
                device.cmd_bind_pipeline(commands, compute, made.pipeline);
            }
            if let Some(set) = pass.set {
                device.cmd_bind_descriptor_sets(commands, compute, made.layout, 0, &[set], &[]);
            }
            match pass.groups {
                WorkgroupCount::Direct([x, y, z]) => device.cmd_dispatch(commands, x, y, z),
                WorkgroupCount::Indirect(buffer, offset) => device.cmd_dispatch_indirect(commands, buffer, offset),
            }
        }
    }
}

/// Tells a pass's shaders which parts of images are in use.
pub(super) fn tell_parts(gpu: &Gpu, commands: vk::CommandBuffer, layout: vk::PipelineLayout, parts: &[u8]) {
    if !parts.is_empty() {
        // SAFETY: the command buffer is being recorded, every layout has this range, and no more parts than fit were let
        // through.
        unsafe { gpu.raw.cmd_push_constants(commands, layout, PARTS_STAGES, 0, parts) };
    }
}
