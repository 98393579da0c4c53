//! Change of a Plan's values, with all that was made for the Plan before.

use super::executor::Executor;
use crate::base::Error;
use crate::prepare::{ParamBlock, PreparedStep, Refusals, check_alone};
use ash::vk;
use framewright_graph::plan::Plan;

/// A block of parameters with other values, and the pass that gets it: the number of its step, and its own in there.
struct ChangedParams {
    step: usize,
    pass: usize,
    filled: ParamBlock,
}

/// The pipeline of a pass in a scope that has another size: the numbers of the step and of the pass in there.
struct ChangedPipeline {
    step: usize,
    pass: usize,
    pipeline: vk::Pipeline,
}

impl Executor {
    /// Executes `plan` from the next frame on. It may differ from the Plan before in values alone: see
    /// [`Plan::differs_beyond_values`]. Two things are made anew on the device:
    ///
    /// - Blocks of parameters with other values. Frames in flight are waited for first.
    /// - Pipelines of shaders that ask for `frag_coord()`, if their images hold both eyes' pictures side by side and change their
    ///   size. The device keeps one such pipeline for each size.
    ///
    /// All passes run in the next frame, as in the first one, if a pass that doesn't run in every frame has other values.
    ///
    /// No device memory is allocated when another part of an image is in use.
    ///
    /// # Errors
    /// [`Error::BadPlan`] if the Plan differs in more, and what is to be made anew; [`Error::Violations`] and
    /// [`Error::Mismatch`] as of [`Executor::new`]; [`Error::OutOfMemory`], [`Error::DeviceLost`]. The executor stays with the
    /// Plan that it had.
    pub fn change(&mut self, plan: &Plan) -> Result<(), Error> {
        let bad = |what| Error::BadPlan { what };
        let with_owners = self.with_told_owners(plan).map_err(bad)?;
        let plan = &*with_owners;
        if let Some(what) = self.plan.differs_beyond_values(plan) {
            return Err(Error::BadPlan { what: format!("an executor must be made anew for it: {what}") });
        }
        // The device has what the Plan before needed, and values need no more of it.
        check_alone(plan, Refusals::Violations)?;
        let pipelines = self.changed_pipelines(plan)?;
        let changed = self.changed_params(plan)?;
        let renewed = !changed.is_empty();
        if renewed {
            self.wait_for_all()?;
        }
        for ChangedParams { step, pass, filled } in changed {
            self.prepared.steps[step].sets()[pass].take(filled);
        }
        for ChangedPipeline { step, pass, pipeline } in pipelines {
            if let PreparedStep::Render(made) = &mut self.prepared.steps[step] {
                made[pass].set_pipeline(pipeline);
            }
        }
        if renewed {
            self.prepared.renew_commands(plan);
        } else {
            self.prepared.forget_commands();
        }
        self.runs.change(&self.plan, plan);
        self.plan.clone_from(plan);
        Ok(())
    }

    /// The pipelines that `plan` needs where its scopes have another size.
    fn changed_pipelines(&self, plan: &Plan) -> Result<Vec<ChangedPipeline>, Error> {
        let mut changed = Vec::new();
        for (step, (old, new)) in self.plan.steps.iter().zip(&plan.steps).enumerate() {
            let (Some(old), Some(new)) = (old.work.scope(), new.work.scope()) else { continue };
            let PreparedStep::Render(made) = &self.prepared.steps[step] else { continue };
            if old.extent == new.extent {
                continue;
            }
            for (pass, (planned, made)) in new.passes.iter().zip(made).enumerate() {
                let pipeline = made.resized(&self.gpu, &planned.name, new.extent)?;
                changed.extend(pipeline.map(|pipeline| ChangedPipeline { step, pass, pipeline }));
            }
        }
        Ok(changed)
    }

    /// The blocks of parameters that have other values in `plan`, whose counts of workgroups are checked.
    fn changed_params(&mut self, plan: &Plan) -> Result<Vec<ChangedParams>, Error> {
        let (frames, mut changed) = (self.prepared.frames_in_flight(), Vec::new());
        for (step, (old, new)) in self.plan.steps.iter().zip(&plan.steps).enumerate() {
            let made = &mut self.prepared.steps[step];
            if let (PreparedStep::Dispatch(made), [new]) = (&*made, new.work.passes()) {
                made.groups(&self.gpu, new)?;
            }
            let passes = old.work.passes().iter().zip(new.work.passes()).zip(made.sets()).enumerate();
            for (pass, ((_, new), sets)) in passes.filter(|(_, ((old, new), _))| old.params != new.params) {
                let filled = sets.params_of(&self.gpu, new, frames)?;
                changed.extend(filled.map(|filled| ChangedParams { step, pass, filled }));
            }
        }
        Ok(changed)
    }
}
