//! The commands of a Plan's frames, which recording reads one after the other. Each holds what it needs, or says where that lies
//! in a list of its kind. So recording a frame looks at little memory, and almost only forwards.

use super::draw_target::DrawTarget;
use super::rings::{Period, RingCache, Turn};
use crate::base::Error;
use crate::commands::{TransferCommand, stages_of};
use crate::gpu::{Gpu, LocalReads};
use ash::vk;
use framewright_graph::frame::{IndirectDraws, RasterState};
use framewright_graph::plan::Pass;
use framewright_graph::vulkan::{CullMode, FrontFace};
use std::ffi::CString;

/// The commands of a Plan's frames, as Vulkan's own structures.
pub(crate) struct CommandList {
    commands: Vec<Command>,
    pub(crate) memory: Vec<vk::MemoryBarrier2<'static>>,
    pub(crate) images: Vec<vk::ImageMemoryBarrier2<'static>>,
    pub(crate) attachments: Vec<vk::RenderingAttachmentInfo<'static>>,
    pub(crate) targets: Vec<DrawTarget>,
    /// Push constants: which parts of images are in use.
    pub(crate) parts: Vec<u8>,
    /// After how many frames, one after the other, everything is made that depends on no choice of the program's.
    pub(super) period: u64,
    /// The steps that depend on such a choice.
    pub(super) chosen: Vec<usize>,
    /// By step: its commands in each frame until it records the same again.
    made: Vec<RingCache<Run>>,
}

/// Consecutive entries of a list.
#[derive(Clone, Copy, Default)]
pub(crate) struct Run {
    first: u32,
    end: u32,
}

/// One or a few of Vulkan's commands.
pub(crate) enum Command {
    /// Begins a label that debuggers show.
    BeginLabel(CString),
    /// Ends the label that was begun last.
    EndLabel,
    /// One call with memory barriers and image barriers.
    Barriers(Run, Run),
    /// A copy, resolve, blit or fill.
    Transfer(Box<TransferCommand>),
    /// Begins a rendering scope.
    BeginScope(ScopeCommand),
    /// Makes what the scope drew so far visible to its fragment shaders at their own position.
    LocalBarrier,
    /// Sets what locations and input attachments the scope's colour attachments are to the next passes.
    SeeAttachments(Box<LocalReads>),
    /// A pass of the scope.
    Draw(DrawCommand),
    /// Ends the rendering scope.
    EndScope,
    /// A dispatch.
    Dispatch(DispatchCommand),
    /// The step's custom pass.
    Custom,
    /// What follows is left out of frames in which the step doesn't run.
    BeginWork,
    /// What follows is recorded in each frame again.
    EndWork,
}

/// The begin of a rendering scope.
pub(crate) struct ScopeCommand {
    /// The colour attachments, then those of depth and stencil.
    pub(crate) color: Run,
    pub(crate) depth: Run,
    pub(crate) stencil: Run,
    pub(crate) extent: vk::Extent2D,
    pub(crate) layers: u32,
    pub(crate) view_mask: u32,
}

/// A pass of a rendering scope.
pub(crate) struct DrawCommand {
    /// `None`: a custom draw whose program brings its own pipeline.
    pub(crate) pipeline: Option<vk::Pipeline>,
    pub(crate) bindings: Bindings,
    /// Its number in the scope.
    pub(crate) pass: u32,
    /// Its number in [`CommandList::targets`].
    pub(crate) target: u32,
    pub(crate) vertices: DrawnVertices,
    pub(crate) faces: Faces,
}

/// What a pass says of faces.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Faces {
    /// The faces that are left out, whatever the draw source says.
    pub(crate) cull_mode: Option<CullMode>,
    /// Whether the front is the back.
    pub(crate) turned_over: bool,
}

impl Faces {
    pub(super) fn of(pass: &Pass) -> Faces {
        let RasterState { cull_mode, front_face, .. } = pass.raster;
        Faces { cull_mode, turned_over: front_face == FrontFace::Clockwise }
    }
}

/// What a pass's pipeline reads of the pass's own.
#[derive(Clone, Copy)]
pub(crate) struct Bindings {
    pub(crate) layout: vk::PipelineLayout,
    /// Null: the shader reads nothing of the pass's own.
    pub(crate) set: vk::DescriptorSet,
    /// Push constants, in [`CommandList::parts`].
    pub(crate) parts: Run,
    /// Whether the shader reads sets that the program binds itself.
    pub(crate) program: bool,
}

/// What a pass draws.
pub(crate) enum DrawnVertices {
    /// One triangle over the whole picture.
    FullScreen,
    /// What the Plan says.
    Own(Box<OwnDraw>),
    /// What the draw source brings along.
    Source,
}

/// A draw of vertices of the pass's own.
pub(crate) struct OwnDraw {
    /// The pass's own vertex buffers, and where each begins.
    pub(crate) vertices: Vec<vk::Buffer>,
    pub(crate) offsets: Vec<vk::DeviceSize>,
    pub(crate) indices: Option<vk::Buffer>,
    pub(crate) counts: DrawCounts,
    /// Whether the shader reads what the draw source brings along.
    pub(crate) supplied: bool,
}

/// How much is drawn.
pub(crate) enum DrawCounts {
    /// The number of vertices or indices, and the number of instances.
    Direct(u32, u32),
    /// The counts that the buffer holds, and the buffer that holds how many there are.
    Indirect(IndirectDraws, vk::Buffer, Option<vk::Buffer>),
}

/// A dispatch.
pub(crate) struct DispatchCommand {
    pub(crate) pipeline: vk::Pipeline,
    pub(crate) bindings: Bindings,
    pub(crate) groups: WorkgroupCount<vk::Buffer>,
    /// Whether the shader reads what the draw source brings along.
    pub(crate) supplied: bool,
}

/// The number of workgroups.
pub(crate) enum WorkgroupCount<B> {
    /// A known number, along each axis.
    Direct([u32; 3]),
    /// The number that the buffer holds at the offset.
    Indirect(B, u64),
}

impl Run {
    /// Adds `entries` to the end of `list`.
    pub(super) fn add<T>(list: &mut Vec<T>, entries: impl IntoIterator<Item = T>) -> Run {
        let first = number(list.len());
        list.extend(entries);
        Run { first, end: number(list.len()) }
    }

    /// Its entries in the list that it was added to.
    pub(crate) fn of<T>(self, list: &[T]) -> &[T] {
        &list[self.first as usize..self.end as usize]
    }

    /// Whether there are none.
    pub(crate) fn is_empty(self) -> bool {
        self.first == self.end
    }
}

impl CommandList {
    /// A list without commands, for steps that repeat their commands after a period: `periods` has one for each step.
    pub(super) fn new(periods: impl Iterator<Item = Period>) -> CommandList {
        let (mut longest, mut chosen) = (1, Vec::new());
        let made = periods.enumerate().map(|(step, period)| {
            longest = longest.max(period.frames());
            chosen.extend(period.is_chosen().then_some(step));
            RingCache::new(period)
        });
        let made = made.collect();
        CommandList {
            commands: Vec::new(),
            memory: Vec::new(),
            images: Vec::new(),
            attachments: Vec::new(),
            targets: Vec::new(),
            parts: Vec::new(),
            period: longest,
            chosen,
            made,
        }
    }

    /// The commands of a step in a turn, if they are made.
    pub(crate) fn step(&self, step: usize, turn: Turn<'_>) -> Option<&[Command]> {
        self.made[step].at(turn).map(|run| run.of(&self.commands))
    }

    /// Makes the commands of a step in a turn, unless they are there.
    pub(super) fn prepare(
        &mut self,
        step: usize,
        turn: Turn<'_>,
        make: impl FnOnce(&mut CommandList) -> Result<(), Error>,
    ) -> Result<(), Error> {
        if self.made[step].at(turn).is_some() {
            return Ok(());
        }
        let first = number(self.commands.len());
        make(self)?;
        let run = Run { first, end: number(self.commands.len()) };
        self.made[step].prepare(turn, || Ok(run)).map(drop)
    }

    /// Forgets all commands, and keeps the memory of the lists.
    pub(super) fn forget(&mut self) {
        self.commands.clear();
        self.memory.clear();
        self.images.clear();
        self.attachments.clear();
        self.targets.clear();
        self.parts.clear();
        self.made.iter_mut().for_each(RingCache::forget);
    }

    /// Adds a command.
    pub(super) fn push(&mut self, command: Command) {
        self.commands.push(command);
    }

    /// Adds a command, unless it is needless.
    pub(super) fn push_unless(&mut self, needless: bool, command: Command) {
        if !needless {
            self.push(command);
        }
    }

    /// Adds memory barriers in one call, then image barriers in another, as [`crate::commands::barriers`] records them.
    pub(super) fn push_barriers(
        &mut self,
        gpu: &Gpu,
        memory: impl IntoIterator<Item = vk::MemoryBarrier2<'static>>,
        images: impl IntoIterator<Item = vk::ImageMemoryBarrier2<'static>>,
    ) {
        let memory = Run::add(&mut self.memory, memory);
        if !memory.is_empty() {
            self.push(Command::Barriers(memory, Run::default()));
        }
        let images = Run::add(&mut self.images, images);
        if !images.is_empty() {
            let validated = gpu.instance.validation.is_some();
            let stages = images.of(&self.images).iter().filter(|_| validated).map(stages_of);
            let stages = Run::add(&mut self.memory, stages);
            self.push(Command::Barriers(stages, images));
        }
    }

    /// Adds what `content` adds, under a label where a tool shows it.
    pub(super) fn push_labelled(
        &mut self,
        gpu: &Gpu,
        label: impl FnOnce() -> CString,
        content: impl FnOnce(&mut CommandList) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let labels = gpu.labels.is_some();
        if labels {
            self.push(Command::BeginLabel(label()));
        }
        content(self)?;
        if labels {
            self.push(Command::EndLabel);
        }
        Ok(())
    }

    /// The number of a target, which the scope before may have added.
    pub(super) fn target(&mut self, target: DrawTarget) -> u32 {
        if self.targets.last() != Some(&target) {
            self.targets.push(target);
        }
        number(self.targets.len() - 1)
    }
}

/// A number in a list, which memory ends far below 2^32.
fn number(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepare::rings::ResourceRings;

    #[test]
    fn a_step_that_never_records_the_same_again_takes_memory_only_for_its_frames() {
        let rings = ResourceRings::default();
        let mut list = CommandList::new([1, u64::MAX].into_iter().map(Period::every));
        for turn in (0..3).map(|frame| rings.turn(frame)) {
            let make = |list: &mut CommandList| {
                list.push(Command::Custom);
                Ok(())
            };
            assert!(list.step(1, turn).is_none());
            list.prepare(1, turn, make).expect("nothing fails");
            assert_eq!(list.step(1, turn).map(<[Command]>::len), Some(1));
        }
        assert_eq!(list.commands.len(), 3);
        list.forget();
        assert!(list.step(1, rings.turn(2)).is_none() && list.commands.is_empty());
    }
}
