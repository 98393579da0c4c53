//! A step turned into objects, and into the commands that recording reads.

use super::command_list::{Command, CommandList};
use super::frame::{Frame, FrameClock};
use super::labels::labelled;
use super::pass::{PassPipeline, PreparedDispatch, PreparedDraw, prepare_dispatch};
use super::pass_set::PassSets;
use super::physical::PhysicalResources;
use super::poison::push_poisoned_barriers;
use super::prepared_step::Debugging;
use super::rings::Period;
use super::scope::{prepare_scope, push_scope};
use crate::base::{Error, convert};
use crate::commands::{TransferCommand, TransferSide, memory_barrier};
use crate::gpu::{Gpu, c_string};
use crate::shaders::ShaderLibrary;
use ash::vk;
use framewright_graph::plan::{Cause, Plan, Resource, Step, Transfer, Work};
use framewright_graph::vulkan::Filter;
use std::sync::Arc;

/// The objects of a step's work.
pub(crate) enum PreparedStep {
    /// The objects of a rendering scope's passes.
    Render(Vec<PreparedDraw>),
    /// The objects of a dispatch.
    Dispatch(Box<PreparedDispatch>),
    /// Other work, which has no objects.
    Plain,
}

impl PreparedStep {
    /// The objects of a step, as far as they are the same in all frames, but for its pipelines. `frames`: how many may be in flight.
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        step: &Step,
        (shaders, frames): (&mut ShaderLibrary, u32),
    ) -> Result<PreparedStep, Error> {
        Ok(match &step.work {
            Work::Render(scope) => PreparedStep::Render(prepare_scope(gpu, plan, scope, (shaders, frames))?),
            Work::Dispatch(pass) => {
                PreparedStep::Dispatch(Box::new(prepare_dispatch(gpu, plan, pass, (shaders, frames))?))
            }
            Work::Custom(_) | Work::Resolve(_) | Work::Copy(_) | Work::Blit(_) | Work::Fill(_) | Work::Export => {
                PreparedStep::Plain
            }
        })
    }

    /// Adds what the step number `index` records in a frame.
    pub(super) fn push_commands(
        &mut self,
        list: &mut CommandList,
        frame: &Frame<'_>,
        (index, step): (usize, &Step),
        debugging: Debugging,
    ) -> Result<(), Error> {
        let label = || {
            let cause = step.work.scope().is_none().then(|| cause(&step.work)).flatten();
            c_string(&labelled(frame.gpu, &numbered(frame.plan, index, step), cause))
        };
        list.push_labelled(frame.gpu, label, |list| {
            if debugging.full_barriers {
                list.push_barriers(frame.gpu, [everything()], []);
            }
            if debugging.poison {
                push_poisoned_barriers(list, frame, index, step);
            } else {
                let memory = step.memory_barriers.iter().map(memory_barrier);
                list.push_barriers(frame.gpu, memory, step.image_barriers.iter().map(|it| frame.image_barrier(it)));
            }
            let always = step.run.is_always();
            list.push_unless(always, Command::BeginWork);
            match self {
                PreparedStep::Render(made) => {
                    let mut scopes = step.work.scope().into_iter();
                    scopes.try_for_each(|scope| push_scope(list, frame, scope, made))?;
                }
                PreparedStep::Dispatch(made) => {
                    for pass in step.work.passes() {
                        let dispatch = made.command(list, frame, pass)?;
                        list.push(Command::Dispatch(dispatch));
                    }
                }
                PreparedStep::Plain if step.work.is_custom() => list.push(Command::Custom),
                PreparedStep::Plain => {
                    let transfer = transfer(frame, &step.work).map(|transfer| Command::Transfer(Box::new(transfer)));
                    transfer.into_iter().for_each(|transfer| list.push(transfer));
                }
            }
            list.push_unless(always, Command::EndWork);
            list.push_barriers(frame.gpu, [], frame.releases(step));
            Ok(())
        })
    }

    /// The objects of its scope's passes.
    pub(crate) fn draws(&self) -> &[PreparedDraw] {
        match self {
            PreparedStep::Render(passes) => passes,
            PreparedStep::Dispatch(_) | PreparedStep::Plain => &[],
        }
    }

    /// The objects of its dispatch.
    pub(crate) fn dispatch(&self) -> Option<&PreparedDispatch> {
        match self {
            PreparedStep::Dispatch(dispatch) => Some(dispatch),
            PreparedStep::Render(_) | PreparedStep::Plain => None,
        }
    }

    /// The pipelines of its passes; `None` for a pass without one.
    pub(super) fn pipelines(&mut self) -> Vec<Option<&mut PassPipeline>> {
        match self {
            PreparedStep::Render(passes) => passes.iter_mut().map(|pass| pass.pipeline.as_mut()).collect(),
            PreparedStep::Dispatch(pass) => vec![Some(&mut pass.pipeline)],
            PreparedStep::Plain => Vec::new(),
        }
    }

    /// Writes the values that a frame has its own of. No memory of the host is allocated.
    pub(super) fn write_frame_values(&mut self, frame: u64, clock: FrameClock) -> Result<(), Error> {
        match self {
            PreparedStep::Render(passes) => {
                passes.iter_mut().try_for_each(|pass| pass.sets.write_frame_values(frame, clock))
            }
            PreparedStep::Dispatch(pass) => pass.sets.write_frame_values(frame, clock),
            PreparedStep::Plain => Ok(()),
        }
    }

    /// The sets of its passes.
    pub(crate) fn sets(&mut self) -> Vec<&mut PassSets> {
        match self {
            PreparedStep::Render(passes) => passes.iter_mut().map(|pass| &mut pass.sets).collect(),
            PreparedStep::Dispatch(pass) => vec![&mut pass.sets],
            PreparedStep::Plain => Vec::new(),
        }
    }
}

/// When a step records the same again.
pub(super) fn period(physical: &PhysicalResources, step: &Step, made: &mut PreparedStep) -> Period {
    let sets = made.sets().into_iter().map(|sets| sets.params_period());
    physical.period(step.touched()).and_every(sets.max().unwrap_or(1))
}

/// The transfer that a step is, if it is one.
fn transfer(frame: &Frame<'_>, work: &Work) -> Option<TransferCommand> {
    let images = |it: &Transfer| match (frame.side(&it.source), frame.side(&it.target)) {
        (TransferSide::Image(source), TransferSide::Image(target)) => Some((source, target)),
        _ => None,
    };
    Some(match work {
        Work::Resolve(it) => images(it).map(|(source, target)| TransferCommand::Resolve(source, target))?,
        Work::Copy(it) => TransferCommand::Copy(frame.side(&it.source), frame.side(&it.target)),
        Work::Blit(it) => {
            let filter = convert::filter(it.filter.unwrap_or(Filter::Nearest));
            images(it).map(|(source, target)| TransferCommand::Blit(source, target, filter))?
        }
        Work::Fill(fill) => {
            let format = match fill.target.resource() {
                Resource::Image(image) => Some(frame.plan.image(image).format),
                Resource::Buffer(_) => None,
            };
            TransferCommand::Fill(frame.side(&fill.target), convert::clear(format, fill.value))
        }
        Work::Render(_) | Work::Dispatch(_) | Work::Custom(_) | Work::Export => return None,
    })
}

/// A barrier between all that was recorded before and all that comes after.
fn everything() -> vk::MemoryBarrier2<'static> {
    let (stages, accesses) =
        (vk::PipelineStageFlags2::ALL_COMMANDS, vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE);
    vk::MemoryBarrier2::default()
        .src_stage_mask(stages)
        .src_access_mask(accesses)
        .dst_stage_mask(stages)
        .dst_access_mask(accesses)
}

/// A step with its number and its title, as labels of command buffers and errors name it.
pub(crate) fn numbered(plan: &Plan, number: usize, step: &Step) -> String {
    format!("step {number}: {}", title(plan, step))
}

/// Why the work of a step is there, if it is one pass or one transfer.
fn cause(work: &Work) -> Option<&Cause> {
    work.cause().or_else(|| work.passes().first().map(|pass| &pass.cause))
}

/// Those of all steps.
pub(crate) fn numbered_titles(plan: &Plan) -> impl Iterator<Item = String> {
    plan.steps.iter().enumerate().map(|(number, step)| numbered(plan, number, step))
}

/// A step in words, for debuggers and messages.
fn title(plan: &Plan, step: &Step) -> String {
    let work = &step.work;
    if !work.passes().is_empty() {
        return work.passes().iter().map(|pass| &*pass.name).collect::<Vec<_>>().join(", ");
    }
    match work.sides().next() {
        Some(side) => format!("{} {}", work.word(), plan.resource_name(side.resource())),
        None => work.word().to_owned(),
    }
}
