//! A step turned into what recording walks.

use super::descriptions::name_and_role;
use super::frame::Frame;
use super::history::RingCache;
use super::pass::{DispatchCommands, PreparedDispatch, PreparedDraw, prepare_dispatch};
use super::pass_set::PassSets;
use super::poison::poisoned_barriers;
use super::scope::{ScopeCommands, prepare_scope};
use super::uses::touched;
use crate::base::{Error, convert};
use crate::commands::{Barriers, Command, TransferSide, memory_barrier};
use crate::gpu::c_string;
use crate::shaders::ShaderLibrary;
use framewright_graph::plan::{Plan, Resource, Step, Transfer, Work};
use framewright_graph::vulkan::Filter;
use std::ffi::CString;

/// A step, with its objects.
pub(crate) struct PreparedStep {
    /// The label that debuggers show.
    pub(crate) label: CString,
    pub(crate) work: PreparedWork,
    pub(crate) commands: RingCache<StepCommands>,
}

/// The objects of a step's work.
pub(crate) enum PreparedWork {
    /// The objects of a rendering scope's passes.
    Render(Vec<PreparedDraw>),
    /// The objects of a dispatch.
    Dispatch(PreparedDispatch),
    /// Other work, which has no objects.
    Plain,
}

/// The commands of a step in a frame, as Vulkan's own structures.
pub(crate) struct StepCommands {
    /// The barriers, and the step's work where that is a transfer.
    pub(crate) before: Vec<Command>,
    pub(crate) work: WorkCommands,
    pub(crate) releases: Barriers,
}

/// The commands of a step's work.
pub(crate) enum WorkCommands {
    /// A rendering scope.
    Render(Box<ScopeCommands>),
    /// A dispatch.
    Dispatch(DispatchCommands),
    /// Other work, which records nothing here.
    Plain,
}

impl PreparedStep {
    /// The objects of the step number `index`, as far as they are the same in all frames.
    pub(super) fn new(
        frame: &Frame<'_>,
        (index, step): (usize, &Step),
        shaders: &mut ShaderLibrary,
    ) -> Result<PreparedStep, Error> {
        let work = match &step.work {
            Work::Render(scope) => PreparedWork::Render(prepare_scope(frame, scope, shaders)?),
            Work::Dispatch(pass) => PreparedWork::Dispatch(prepare_dispatch(frame, pass, shaders)?),
            _ => PreparedWork::Plain,
        };
        let mut resources = Vec::new();
        touched(step, &mut |resource| resources.push(resource));
        let label = c_string(&format!("step {index}: {}", title(frame.plan, step)));
        Ok(PreparedStep { label, work, commands: RingCache::new(frame.physical.period(resources)) })
    }

    /// Makes what the step number `index` records in a frame, unless it is there.
    pub(super) fn prepare(
        &mut self,
        frame: &Frame<'_>,
        (index, step): (usize, &Step),
        poison: bool,
    ) -> Result<(), Error> {
        let PreparedStep { work, commands, .. } = self;
        let make = || StepCommands::new(frame, (index, step), work, poison);
        commands.prepare(frame.number, make).map(drop)
    }

    /// The sets of its passes.
    pub(crate) fn sets(&mut self) -> Vec<&mut PassSets> {
        match &mut self.work {
            PreparedWork::Render(passes) => passes.iter_mut().map(|pass| &mut pass.sets).collect(),
            PreparedWork::Dispatch(pass) => vec![&mut pass.sets],
            PreparedWork::Plain => Vec::new(),
        }
    }

    /// Forgets sets and what is recorded.
    pub(super) fn forget(&mut self) {
        self.commands.forget();
        self.sets().into_iter().for_each(PassSets::forget);
    }
}

impl StepCommands {
    fn new(
        frame: &Frame<'_>,
        (index, step): (usize, &Step),
        made: &mut PreparedWork,
        poison: bool,
    ) -> Result<StepCommands, Error> {
        let mut before = if poison {
            poisoned_barriers(frame, index, step)
        } else {
            let memory = step.memory_barriers.iter().map(memory_barrier);
            let images = step.image_barriers.iter().map(|it| frame.image_barrier(it));
            vec![Command::Barriers(Barriers::new(frame.gpu, memory.collect(), images.collect()))]
        };
        before.extend(transfer(frame, &step.work));
        let work = match (&step.work, made) {
            (Work::Render(scope), PreparedWork::Render(made)) => {
                WorkCommands::Render(Box::new(ScopeCommands::new(frame, scope, made)?))
            }
            (Work::Dispatch(pass), PreparedWork::Dispatch(made)) => WorkCommands::Dispatch(made.commands(frame, pass)?),
            _ => WorkCommands::Plain,
        };
        let releases = step.releases.iter().map(|it| frame.image_barrier(it));
        Ok(StepCommands { before, work, releases: Barriers::new(frame.gpu, Vec::new(), releases.collect()) })
    }
}

/// The transfer that a step is, if it is one.
fn transfer(frame: &Frame<'_>, work: &Work) -> Option<Command> {
    let images = |it: &Transfer| match (frame.side(&it.source), frame.side(&it.target)) {
        (TransferSide::Image(source), TransferSide::Image(target)) => Some((source, target)),
        _ => None,
    };
    Some(match work {
        Work::Resolve(it) => images(it).map(|(source, target)| Command::Resolve(source, target))?,
        Work::Copy(it) => Command::Copy(frame.side(&it.source), frame.side(&it.target)),
        Work::Blit(it) => {
            let filter = convert::filter(it.filter.unwrap_or(Filter::Nearest));
            images(it).map(|(source, target)| Command::Blit(source, target, filter))?
        }
        Work::Fill(fill) => {
            let format = match fill.target.resource() {
                Resource::Image(image) => Some(frame.plan.image(image).format),
                Resource::Buffer(_) => None,
            };
            Command::Fill(frame.side(&fill.target), convert::clear(format, fill.value))
        }
        Work::Render(_) | Work::Dispatch(_) | Work::Custom(_) | Work::Export => return None,
    })
}

/// The label of a step in a debugger.
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
