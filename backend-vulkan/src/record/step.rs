//! A Plan's steps as commands: the list of what was prepared is walked, and nothing is allocated.

use super::bindings::bind;
use super::bound_sets::bind_program_sets;
use super::custom::CustomRecorder;
use super::dispatch::DispatchRecorder;
use super::draw_source::DrawSource;
use super::observers::Observers;
use super::recorded_frame::{Counts, RecordedFrame};
use super::secondary::OpenScope;
use super::state::CommandState;
use crate::base::Error;
use crate::commands::barrier_call;
use crate::prepare::{Command, DispatchCommand, Frame, PreparedPlan, WorkgroupCount};
use ash::vk;
use framewright_graph::plan::{Pass, Queue};

/// The recording of a frame.
pub(crate) struct Recording<'r> {
    pub(crate) frame: &'r Frame<'r>,
    pub(crate) prepared: &'r PreparedPlan,
    pub(crate) source: &'r mut dyn DrawSource,
    pub(crate) observers: &'r mut Observers,
    pub(crate) recorded: &'r mut RecordedFrame,
    /// The state of the command buffer that is being recorded.
    pub(crate) state: CommandState,
    /// The rendering scope that is being recorded.
    pub(super) scope: Option<OpenScope<'r>>,
}

impl<'r> Recording<'r> {
    /// The recording of a frame, in which nothing is recorded yet.
    pub(crate) fn new(
        frame: &'r Frame<'r>,
        prepared: &'r PreparedPlan,
        source: &'r mut dyn DrawSource,
        observers: &'r mut Observers,
        recorded: &'r mut RecordedFrame,
    ) -> Recording<'r> {
        Recording { frame, prepared, source, observers, recorded, state: CommandState::default(), scope: None }
    }

    /// Begins the command buffer of a batch.
    pub(crate) fn begin_batch(&mut self, commands: vk::CommandBuffer, queue: Queue) {
        self.state.begin_commands();
        self.observers.begin_batch(commands, queue);
    }

    /// Ends the command buffer of a batch.
    pub(crate) fn end_batch(&mut self, commands: vk::CommandBuffer) {
        self.observers.end_batch(commands);
    }

    /// Records a step.
    pub(crate) fn step(&mut self, commands: vk::CommandBuffer, step: usize) -> Result<(), Error> {
        let (gpu, list) = (self.frame.gpu, &self.prepared.list);
        self.observers.begin_step(commands, step);
        let runs = self.frame.runs(step);
        let mut left_out = false;
        let unprepared = || Error::BadPlan { what: "nothing was prepared for this frame".to_owned() };
        for command in list.step(step, self.frame.turn()).ok_or_else(unprepared)? {
            match command {
                Command::BeginWork => left_out = !runs,
                Command::EndWork => left_out = false,
                _ if left_out => {}
                Command::BeginLabel(label) => gpu.begin_label(commands, label),
                Command::EndLabel => gpu.end_label(commands),
                Command::Barriers(memory, images) => {
                    barrier_call(gpu, commands, memory.of(&list.memory), images.of(&list.images));
                }
                Command::Transfer(transfer) => transfer.record(gpu, commands),
                Command::BeginScope(scope) => {
                    self.observers.begin_work(self.frame, commands, step)?;
                    self.begin_scope(commands, step, scope)?;
                }
                Command::LocalBarrier => super::scope::local_barrier(gpu, commands),
                Command::SeeAttachments(local) => super::scope::see_attachments(gpu, commands, local),
                Command::Draw(draw) => {
                    let counts = self.draw(commands, step, draw)?;
                    self.end_pass(commands, counts);
                }
                Command::EndScope => {
                    // SAFETY: the scope was begun by a command before.
                    unsafe { gpu.raw.cmd_end_rendering(commands) };
                    self.observers.end_work(self.frame, commands);
                }
                Command::Dispatch(dispatch) => {
                    self.dispatch(commands, step, dispatch)?;
                    self.end_pass(commands, Counts { draws: 1, culled: 0 });
                }
                Command::Custom => {
                    let planned = &self.frame.plan.steps[step];
                    self.observers.begin_work(self.frame, commands, step)?;
                    for pass in planned.work.passes() {
                        let draws = self.custom(commands, pass, planned.queue)?;
                        self.end_pass(commands, Counts { draws, culled: 0 });
                    }
                    self.observers.end_work(self.frame, commands);
                }
            }
        }
        if !runs {
            self.leave_out(commands, step);
        }
        self.observers.stamp(commands);
        Ok(())
    }

    /// Notes that the passes of a step were left out: each has its place in the report.
    fn leave_out(&mut self, commands: vk::CommandBuffer, step: usize) {
        self.recorded.left_out.push(step);
        for _ in self.frame.plan.steps[step].work.passes() {
            self.end_pass(commands, Counts::default());
        }
    }

    /// Notes what was recorded for a pass, and when it ends.
    fn end_pass(&mut self, commands: vk::CommandBuffer, counts: Counts) {
        self.recorded.counts.push(counts);
        self.observers.stamp(commands);
    }

    fn custom(&mut self, commands: vk::CommandBuffer, pass: &Pass, queue: Queue) -> Result<u32, Error> {
        self.state.lose_track();
        let mut recorder = CustomRecorder::new(self.frame, commands, pass, (queue, self.observers.has_query()));
        self.source.custom(&pass.shader, &mut recorder)?;
        if let Some(watch) = &mut self.observers.watch {
            watch.note_asked(pass, recorder.asked());
        }
        recorder.finish().map_err(|what| Error::Recording { pass: pass.name.to_string(), what })
    }

    fn dispatch(&mut self, commands: vk::CommandBuffer, step: usize, dispatch: &DispatchCommand) -> Result<(), Error> {
        let gpu = self.frame.gpu;
        self.state.begin_pass();
        let (device, compute) = (&gpu.raw, vk::PipelineBindPoint::COMPUTE);
        if self.state.needs_compute(dispatch.pipeline) {
            // SAFETY: the command buffer is being recorded outside a scope.
            unsafe { device.cmd_bind_pipeline(commands, compute, dispatch.pipeline) };
        }
        bind(gpu, commands, compute, &self.prepared.list, &dispatch.bindings);
        let missing = dispatch.bindings.program && self.bind_program_sets(commands, step)?.is_some();
        if dispatch.supplied || missing {
            self.bind_supplied(commands, step)?;
        }
        // SAFETY: the command buffer is being recorded outside a scope, everything that the pipeline reads is bound, and counts and
        // the buffer behind them were checked.
        unsafe {
            match dispatch.groups {
                WorkgroupCount::Direct([x, y, z]) => device.cmd_dispatch(commands, x, y, z),
                WorkgroupCount::Indirect(buffer, offset) => device.cmd_dispatch_indirect(commands, buffer, offset),
            }
        }
        Ok(())
    }

    /// Binds the program's sets for the dispatch of a step. Returns the first that isn't bound for all passes.
    fn bind_program_sets(&self, commands: vk::CommandBuffer, step: usize) -> Result<Option<u32>, Error> {
        let Some(made) = self.prepared.steps[step].dispatch() else { return Ok(None) };
        let (gpu, compute) = (self.frame.gpu, vk::PipelineBindPoint::COMPUTE);
        bind_program_sets(gpu, commands, compute, &made.supplied, self.frame.sets).map_err(|what| {
            let pass =
                self.frame.plan.steps[step].work.passes().first().map_or_else(String::new, |it| it.name.to_string());
            Error::Recording { pass, what }
        })
    }

    /// Has the draw source bind its sets for the dispatch of a step.
    fn bind_supplied(&mut self, commands: vk::CommandBuffer, step: usize) -> Result<(), Error> {
        let planned = self.frame.plan.steps[step].work.passes().first();
        let (Some(made), Some(pass)) = (self.prepared.steps[step].dispatch(), planned) else { return Ok(()) };
        let held = &mut self.recorded.kept;
        let mut recorder = DispatchRecorder::new(commands, &made.supplied, held, (pass, self.frame));
        self.source.dispatch(&mut recorder)?;
        recorder.finish().map_err(|what| Error::Recording { pass: pass.name.to_string(), what })
    }
}
