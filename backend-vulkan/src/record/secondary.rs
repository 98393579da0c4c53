//! Custom passes within a rendering scope whose draws come in secondary command buffers: how the scope is suspended and resumed around them.

use super::fragments::COUNTED;
use super::guarded_source::has_secondary;
use super::recorded_frame::Counts;
use super::scope::begin;
use super::secondary_recorder::{FLAGS, SecondaryRecorder};
use super::step::Recording;
use crate::base::Error;
use crate::prepare::{DrawCommand, ScopeCommand};
use ash::vk;
use framewright_graph::frame::Draw;

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
    /// Begins the rendering scope of a step. The draw source says once for each pass how its draws come.
    pub(super) fn begin_scope(
        &mut self,
        commands: vk::CommandBuffer,
        step: usize,
        command: &'r ScopeCommand,
    ) -> Result<(), Error> {
        let answers = &mut self.recorded.secondary;
        answers.clear();
        for pass in self.frame.plan.steps[step].work.passes() {
            let is_custom = pass.draw.is_some_and(Draw::is_custom);
            answers.push(is_custom && has_secondary(self.source, &pass.name, &pass.shader)?);
        }
        let scope = OpenScope { command, left: answers.iter().filter(|has| **has).count() };
        self.scope = Some(scope);
        begin(self.frame.gpu, commands, &self.prepared.list, command, scope.flags());
        Ok(())
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
        if !self.recorded.secondary[draw.pass as usize] {
            return Ok(None);
        }
        scope.left -= 1;
        let scope = *scope;
        let draws = self.prepared.steps[step].draws();
        let formats = &draws[draw.pass as usize].state.formats;
        let misused = |what: &str| Error::Recording { pass: pass.name.to_string(), what: what.to_owned() };
        // Where the scope is gone on with, what its passes see of the attachments begins anew.
        if draws.iter().any(|it| it.state.formats.local.is_some()) {
            return Err(misused(
                "secondary command buffers in a scope whose passes read what it drew, or draw into others of its attachments",
            ));
        }
        if self.observers.has_query() {
            return Err(misused(COUNTED));
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
