//! The objects of all steps of a Plan, with their pipelines.

use super::check::{Refusals, check};
use super::step::PreparedStep;
use crate::base::Error;
use crate::gpu::{Device, Gpu, PipelineHold};
use crate::shaders::ShaderLibrary;
use framewright_graph::plan::Plan;
use std::sync::Arc;

/// The objects of a Plan's steps, as far as they are the same in all frames, of which `frames` may be in flight. The Plan must have passed [`check()`].
pub(super) fn prepare_steps(
    gpu: &Arc<Gpu>,
    plan: &Plan,
    shaders: &mut ShaderLibrary,
    frames: u32,
) -> Result<Vec<PreparedStep>, Error> {
    let steps = plan.steps.iter().map(|step| PreparedStep::new(gpu, plan, step, (shaders, frames)));
    let mut steps = steps.collect::<Result<Vec<_>, _>>()?;
    let with_names =
        plan.steps.iter().zip(&mut steps).flat_map(|(step, made)| step.work.passes().iter().zip(made.pipelines()));
    let (names, mut made): (Vec<_>, Vec<_>) =
        with_names.filter_map(|(pass, pipeline)| Some((&*pass.name, pipeline?))).unzip();
    let wanted: Vec<_> = names.into_iter().zip(made.iter().map(|pipeline| &pipeline.descriptor)).collect();
    let raw = gpu.pipelines(&wanted)?;
    for (pipeline, raw) in made.iter_mut().zip(raw) {
        pipeline.raw = raw;
    }
    Ok(steps)
}

impl Device {
    /// Makes the pipelines that `plan` needs, on several threads, so that an executor of the Plan finds them made. It can be called on
    /// any thread while frames are drawn, for what a user may choose next. The pipelines stay while there is an executor on the device.
    ///
    /// # Errors
    /// Those of the Plan, its shaders and pipelines, as of [`Executor::new`](crate::Executor::new).
    pub fn make_pipelines(&self, plan: &Plan, shaders: &mut ShaderLibrary) -> Result<(), Error> {
        check(&self.gpu, plan, Refusals::Violations, false)?;
        let _hold = PipelineHold::new(&self.gpu);
        prepare_steps(&self.gpu, plan, shaders, 1).map(drop)
    }
}
