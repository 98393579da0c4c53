//! From a Plan to the objects that executing it needs, and to what its steps record.

use super::command_list::CommandList;
use super::frame::{Frame, FrameClock};
use super::pass_set::{MadeSets, PassSets};
use super::physical::PhysicalResources;
use super::step::{PreparedStep, period};
use super::steps::prepare_steps;
use crate::base::Error;
use crate::gpu::Gpu;
use crate::memory::{Image, RawBuffer};
use crate::resources::ProgramSets;
use crate::shaders::ShaderLibrary;
use framewright_graph::plan::{self, BufferId, ImageId, Plan, Resource, Role};
use std::sync::Arc;

/// What is recorded beside the Plan, to look for mistakes. None of it may change a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Debugging {
    /// Images and buffers are filled with garbage when they are taken into use.
    pub(crate) poison: bool,
    /// Each step waits for all that its queue did before.
    pub(crate) full_barriers: bool,
}

/// How frames are prepared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Preparation {
    pub(crate) debugging: Debugging,
    /// How many frames may be in flight, at least one.
    pub(crate) frames_in_flight: u32,
}

/// What stood for an external image or buffer, and the sets that point to it. Fields are dropped in this order.
pub(crate) struct Replaced {
    _sets: Vec<MadeSets>,
    _images: Vec<Arc<Image>>,
    _buffers: Vec<Arc<RawBuffer>>,
}

/// Everything that a Plan needs on a device.
pub(crate) struct PreparedPlan {
    pub(crate) physical: PhysicalResources,
    /// By step.
    pub(crate) steps: Vec<PreparedStep>,
    pub(crate) list: CommandList,
    how: Preparation,
    /// The frame from which on all is prepared anew; `None`: the next one.
    first: Option<u64>,
    /// Images whose size changes, that outlive the frame, and that it writes.
    parts: Vec<ImageId>,
    /// Steps whose parameters each frame has its own values of.
    timed: Vec<usize>,
}

impl PreparedPlan {
    /// Makes everything that the first frame needs. The Plan must have passed [`crate::prepare::check()`].
    pub(crate) fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        shaders: &mut ShaderLibrary,
        how: Preparation,
    ) -> Result<PreparedPlan, Error> {
        let physical = PhysicalResources::new(gpu, plan)?;
        let steps = prepare_steps(gpu, plan, shaders, how.frames_in_flight)?;
        let outlives = |image: &&plan::Image| image.allocated.is_some() && !matches!(image.role, Role::Transient(_));
        let written = |image: &&plan::Image| plan.steps.iter().any(|step| step.work.writes(image.id));
        let parts = plan.images.iter().filter(outlives).filter(written).map(|image| image.id).collect();
        let (list, timed) = (CommandList::new([].into_iter()), Vec::new());
        let mut prepared = PreparedPlan { physical, steps, list, how, first: None, parts, timed };
        prepared.renew_commands(plan);
        prepared.prepare_frame(gpu, plan, 0)?;
        Ok(prepared)
    }

    /// Makes what frame `number` needs and no frame before it needed. Frames follow each other without gaps.
    pub(crate) fn prepare_frame(&mut self, gpu: &Arc<Gpu>, plan: &Plan, number: u64) -> Result<(), Error> {
        // Commands tell shaders which part of an image they see.
        let mut changed = false;
        for image in &self.parts {
            changed |= self.physical.write_part(plan.image(*image), number);
        }
        if changed {
            self.forget_commands();
        }
        let first = *self.first.get_or_insert(number);
        let repeats = number - first >= self.list.period;
        let frame = Frame {
            gpu,
            plan,
            physical: &self.physical,
            sets: ProgramSets::NONE,
            number,
            told: number,
            left_out: &[],
            clock: FrameClock::default(),
        };
        let debugging = self.how.debugging;
        let (list, steps) = (&mut self.list, &mut self.steps);
        let mut prepare = |list: &mut CommandList, index: usize| {
            let (step, made) = (&plan.steps[index], &mut steps[index]);
            list.prepare(index, frame.turn(), |list| made.push_commands(list, &frame, (index, step), debugging))
        };
        if repeats {
            return (0..list.chosen.len()).try_for_each(|number| prepare(list, list.chosen[number]));
        }
        (0..plan.steps.len()).try_for_each(|index| prepare(list, index))
    }

    /// Takes the program's images for an external one, as [`PhysicalResources::replace_images`] does, and returns what frames in flight may
    /// use of those before.
    pub(crate) fn replace_images(&mut self, image: ImageId, by: impl IntoIterator<Item = Image>) -> Replaced {
        let _images = self.physical.replace_images(image, by);
        Replaced { _sets: self.replaced_sets(Resource::Image(image)), _images, _buffers: Vec::new() }
    }

    /// Takes the program's buffers for an external one, as [`PreparedPlan::replace_images`] does.
    pub(crate) fn replace_buffers(&mut self, buffer: BufferId, by: impl IntoIterator<Item = RawBuffer>) -> Replaced {
        let _buffers = self.physical.replace_buffers(buffer, by);
        Replaced { _sets: self.replaced_sets(Resource::Buffer(buffer)), _images: Vec::new(), _buffers }
    }

    /// Forgets what was made for an image or buffer that another one stands for now. Frames in flight may read the sets.
    fn replaced_sets(&mut self, resource: Resource) -> Vec<MadeSets> {
        self.forget_commands();
        let sets = self.steps.iter_mut().flat_map(PreparedStep::sets);
        sets.filter_map(|sets| sets.replace(resource)).collect()
    }

    /// Forgets all sets and commands, since other images and buffers stand for the Plan's. Nothing may be in flight.
    pub(crate) fn forget(&mut self) {
        self.forget_commands();
        self.steps.iter_mut().flat_map(PreparedStep::sets).for_each(PassSets::forget);
    }

    /// Writes the values that frame `number` has its own of. It has a place in flight, and isn't submitted.
    pub(crate) fn write_frame_values(&mut self, number: u64, clock: FrameClock) -> Result<(), Error> {
        for step in &self.timed {
            self.steps[*step].write_frame_values(number, clock)?;
        }
        Ok(())
    }

    /// The number of frames that may be in flight.
    pub(crate) fn frames_in_flight(&self) -> u32 {
        self.how.frames_in_flight
    }

    /// Forgets all commands, since parameters are other ones: each frame may have its own values of others.
    pub(crate) fn renew_commands(&mut self, plan: &Plan) {
        let mut timed = Vec::new();
        for (number, step) in self.steps.iter_mut().enumerate() {
            timed.extend(step.sets().iter().any(|sets| sets.has_frame_values()).then_some(number));
        }
        self.timed = timed;
        let steps = plan.steps.iter().zip(&mut self.steps);
        self.list = CommandList::new(steps.map(|(step, made)| period(&self.physical, step, made)));
        self.first = None;
    }

    /// Forgets all commands, since the Plan has other values, or images hold other parts.
    pub(crate) fn forget_commands(&mut self) {
        self.first = None;
        self.list.forget();
    }
}
