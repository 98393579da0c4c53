//! A Plan's steps as commands.

use super::custom::CustomRecorder;
use super::draw_source::DrawSource;
use super::frame::{Frame, Recorded};
use super::poison;
use super::timing::{Counts, Timing};
use crate::base::Error;
use crate::commands::{barriers, memory_barriers};
use crate::prepare::{PreparedStep, name_and_role};
use ash::vk;
use framewright_graph::plan::{Plan, Resource, Step, Work};

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
        self.gpu.labelled(commands, &label, || {
            if self.poison {
                poison::record(self, commands, index, step);
            } else {
                let images = step.image_barriers.iter().map(|it| self.image_barrier(it)).collect::<Vec<_>>();
                barriers(self.gpu, commands, &memory_barriers(&step.memory_barriers), &images);
            }
            match (&step.work, made) {
                (Work::Render(plan), PreparedStep::Render(scope)) => {
                    self.render(commands, plan, scope, source, timing, recorded)?;
                }
                (Work::Dispatch(plan), PreparedStep::Dispatch(pass)) => {
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
            barriers(self.gpu, commands, &[], &releases);
            timing.stamp(commands);
            Ok(())
        })
    }
}

/// What a debugger shows for a step.
fn title(plan: &Plan, step: &Step) -> String {
    let name = |resource: Resource| name_and_role(plan, resource).0;
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
