//! From a Plan to the objects that executing it needs, and to what its steps record.

use super::frame::Frame;
use super::physical::PhysicalResources;
use super::step::PreparedStep;
use crate::base::Error;
use crate::gpu::Gpu;
use crate::shaders::ShaderLibrary;
use framewright_graph::plan::Plan;
use std::sync::Arc;

/// Everything that a Plan needs on a device.
pub(crate) struct PreparedPlan {
    pub(crate) physical: PhysicalResources,
    /// By step.
    pub(crate) steps: Vec<PreparedStep>,
    poison: bool,
    /// After how many frames every step has found all its images and buffers.
    period: u64,
    /// The frame from which on all is prepared anew; `None`: the next one.
    first: Option<u64>,
}

impl PreparedPlan {
    /// Makes everything that the first frame needs; with `poison`, images and buffers are filled with garbage when they are taken
    /// into use. The Plan must have passed [`crate::prepare::check()`].
    pub(crate) fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        shaders: &mut ShaderLibrary,
        poison: bool,
    ) -> Result<PreparedPlan, Error> {
        let physical = PhysicalResources::new(gpu, plan)?;
        let frame = Frame { gpu, plan, physical: &physical, number: 0 };
        let steps = plan.steps.iter().enumerate().map(|step| PreparedStep::new(&frame, step, shaders));
        let steps = steps.collect::<Result<Vec<PreparedStep>, _>>()?;
        let period = steps.iter().map(|step| step.commands.period()).max().unwrap_or(1);
        let mut prepared = PreparedPlan { physical, steps, poison, period, first: None };
        prepared.prepare_frame(gpu, plan, 0)?;
        Ok(prepared)
    }

    /// Makes what frame `number` needs and no frame before it needed. Frames follow each other without gaps.
    pub(crate) fn prepare_frame(&mut self, gpu: &Arc<Gpu>, plan: &Plan, number: u64) -> Result<(), Error> {
        let first = *self.first.get_or_insert(number);
        if number - first >= self.period {
            return Ok(());
        }
        let frame = Frame { gpu, plan, physical: &self.physical, number };
        let mut steps = plan.steps.iter().enumerate().zip(&mut self.steps);
        steps.try_for_each(|(step, made)| made.prepare(&frame, step, self.poison))
    }

    /// Forgets all sets and what is recorded, since another image or buffer was imported. Nothing may be in flight.
    pub(crate) fn forget(&mut self) {
        self.first = None;
        self.steps.iter_mut().for_each(PreparedStep::forget);
    }

    /// Forgets what the steps record, since the Plan has other values.
    pub(crate) fn forget_commands(&mut self) {
        self.first = None;
        self.steps.iter_mut().for_each(|step| step.commands.forget());
    }
}
