//! Custom passes within a rendering scope whose draws come in secondary command buffers: how the scope is suspended and resumed around them.

use super::draw_source::DrawSource;
use super::recorded_frame::Counts;
use super::scope::begin;
use super::secondary_recorder::{FLAGS, SecondaryRecorder};
use super::step::Recording;
use crate::base::Error;
use crate::prepare::{DrawCommand, ScopeCommand};
use ash::vk;
use framewright_graph::frame::Draw;
use framewright_graph::plan;

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
        let mut recorder = SecondaryRecorder::new(self.frame, commands, pass, (formats, target));
        let draws = self.source.secondary(&pass.shader, &mut recorder)?;
        let asked = recorder.asked();
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
fn has_secondary(source: &mut dyn DrawSource, pass: &plan::Pass) -> bool {
    pass.draw.is_some_and(Draw::is_custom) && source.has_secondary(&pass.shader)
}
