//! A Plan's steps as commands.

mod barriers;
mod dispatch;
mod scope;
mod transfer;

pub(crate) use barriers::{barriers, memory_barriers, state_change};
pub(crate) use transfer::{Place, copy_between, fill};

use crate::caches::PARTS_STAGES;
use crate::custom::CustomRecorder;
use crate::device::Shared;
use crate::error::Error;
use crate::poison;
use crate::prepare::{Prepared, Step as Made};
use crate::recorder::{DrawSource, Kept};
use crate::timing::{Counts, Timing};
use ash::vk;
use framewright_graph::plan::{self, Plan, Resource, Step, Work};
use std::time::Duration;

/// What a frame is recorded from.
pub(crate) struct Frame<'f> {
    pub(crate) shared: &'f Shared,
    pub(crate) plan: &'f Plan,
    pub(crate) prepared: &'f Prepared,
    /// Which frame it is, from 0.
    pub(crate) number: u64,
    pub(crate) poison: bool,
}

/// A recorded frame.
#[derive(Default)]
pub(crate) struct Recorded {
    /// By pass.
    pub(crate) counts: Vec<Counts>,
    pub(crate) kept: Kept,
    /// How long that took.
    pub(crate) took: Duration,
}

impl Frame<'_> {
    /// Records the step number `index`.
    pub(crate) fn step(
        &self,
        commands: vk::CommandBuffer,
        index: usize,
        source: &mut dyn DrawSource,
        timing: &mut Timing,
        recorded: &mut Recorded,
    ) -> Result<(), Error> {
        let (Some(step), Some(made)) = (self.plan.steps.get(index), self.prepared.steps.get(index)) else {
            return Ok(());
        };
        let label = format!("step {index}: {}", title(self.plan, step));
        self.shared.labelled(commands, &label, || {
            if self.poison {
                poison::record(self, commands, index, step);
            } else {
                let images = step.image_barriers.iter().map(|it| self.image_barrier(it)).collect::<Vec<_>>();
                barriers(self.shared, commands, &memory_barriers(&step.memory_barriers), &images);
            }
            match (&step.work, made) {
                (Work::Render(plan), Made::Render(scope)) => {
                    self.render(commands, plan, scope, source, timing, recorded)?;
                }
                (Work::Dispatch(plan), Made::Dispatch(pass)) => {
                    self.dispatch(commands, plan, pass)?;
                    recorded.counts.push(Counts { draws: 1, culled: 0 });
                    timing.stamp(commands);
                }
                (Work::Custom(pass), _) => {
                    let mut recorder = CustomRecorder::new(self, commands, pass);
                    source.custom(&pass.shader, &mut recorder)?;
                    let recorded_commands = recorder.finish();
                    let wrong = |what| Error::Recording { pass: pass.name.to_string(), what };
                    recorded.counts.push(Counts { draws: recorded_commands.map_err(wrong)?, culled: 0 });
                    timing.stamp(commands);
                }
                (Work::Resolve(transfer), _) => self.resolve(commands, transfer),
                (Work::Copy(transfer), _) => self.copy(commands, transfer),
                (Work::Blit(transfer), _) => self.blit(commands, transfer),
                (Work::Fill(fill), _) => self.fill(commands, fill),
                (Work::Render(_) | Work::Dispatch(_) | Work::Export, _) => {}
            }
            let releases: Vec<_> = step.releases.iter().map(|it| self.image_barrier(it)).collect();
            barriers(self.shared, commands, &[], &releases);
            timing.stamp(commands);
            Ok(())
        })
    }
}

impl Frame<'_> {
    /// Tells the pass's shaders which parts of images are in use.
    fn tell_parts(&self, commands: vk::CommandBuffer, pass: &plan::Pass, layout: vk::PipelineLayout) {
        let parts: Vec<u8> = self.plan.parts(pass).flat_map(|(_, part)| part.map(f32::to_ne_bytes)).flatten().collect();
        if !parts.is_empty() {
            // SAFETY: the command buffer is being recorded, every layout has this range, and no more parts than fit were let
            // through.
            unsafe { self.shared.raw.cmd_push_constants(commands, layout, PARTS_STAGES, 0, &parts) };
        }
    }
}

/// What a debugger shows for a step.
fn title(plan: &Plan, step: &Step) -> String {
    let name = |resource: Resource| match resource {
        Resource::Image(image) => plan.image(image).name.to_string(),
        Resource::Buffer(buffer) => plan.buffers[buffer.0 as usize].name.to_string(),
    };
    match &step.work {
        Work::Render(scope) => scope.passes.iter().map(|pass| &*pass.name).collect::<Vec<_>>().join(", "),
        Work::Dispatch(pass) | Work::Custom(pass) => pass.name.to_string(),
        Work::Resolve(transfer) => format!("resolve {}", name(transfer.source.resource())),
        Work::Copy(transfer) => format!("copy {}", name(transfer.source.resource())),
        Work::Blit(transfer) => format!("blit {}", name(transfer.source.resource())),
        Work::Fill(fill) => format!("fill {}", name(fill.target.resource())),
        Work::Export => "export".to_owned(),
    }
}
