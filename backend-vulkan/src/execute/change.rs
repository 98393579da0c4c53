//! Change of a Plan's values, with all that was made for the Plan before.

use super::executor::Executor;
use crate::base::Error;
use crate::gpu::Gpu;
use crate::memory::RawBuffer;
use crate::prepare::{
    PassSet, PreparedPlan, PreparedStep, Refuse, RingCache, SetTemplate, WorkgroupCount, check, groups,
};
use framewright_graph::plan::{Pass, Plan, Work};
use std::sync::Arc;

/// What a pass gets anew.
enum ChangedValue {
    Params(Arc<RawBuffer>),
    Groups(WorkgroupCount),
}

impl Executor {
    /// Executes `plan` from the next frame on, which may differ from the one before in values alone: see
    /// [`Plan::differs_beyond_values`]. Nothing is made anew but the blocks of parameters that have other values; for those,
    /// frames in flight are waited for. Whichever part of an image is in use, no memory is allocated for it.
    ///
    /// # Errors
    /// [`Error::BadPlan`] if the Plan differs in more, and what is to be made anew; [`Error::Violations`] and
    /// [`Error::Mismatch`] as of [`Executor::new`]; [`Error::OutOfMemory`], [`Error::DeviceLost`]. The executor stays with the
    /// Plan that it had.
    pub fn change(&mut self, plan: &Plan) -> Result<(), Error> {
        if let Some(what) = self.plan.differs_beyond_values(plan) {
            return Err(Error::BadPlan { what: format!("an executor must be made anew for it: {what}") });
        }
        check(&self.gpu, plan, Refuse::Violations, self.poisons())?;
        let renewed = renewed(&self.gpu, &self.prepared, &self.plan, plan)?;
        if renewed.iter().any(|(_, renewed)| matches!(renewed, ChangedValue::Params(_))) {
            self.frames.wait_for_all()?;
        }
        for (at, renewed) in renewed {
            take(&mut self.prepared, at, renewed);
        }
        self.plan.clone_from(plan);
        Ok(())
    }
}

/// Step and pass of what has other values now, and what it gets.
fn renewed(
    gpu: &Arc<Gpu>,
    prepared: &PreparedPlan,
    before: &Plan,
    after: &Plan,
) -> Result<Vec<([usize; 2], ChangedValue)>, Error> {
    let mut renewed = Vec::new();
    for (step, (old, new)) in before.steps.iter().zip(&after.steps).enumerate() {
        let mut params = |number: usize, old: &Pass, new: &Pass, template: &SetTemplate| {
            if old.params != new.params
                && let Some(filled) = template.params_of(gpu, new)?
            {
                renewed.push(([step, number], ChangedValue::Params(filled)));
            }
            Ok::<_, Error>(())
        };
        match (&old.work, &new.work, &prepared.steps[step]) {
            (Work::Render(old), Work::Render(new), PreparedStep::Render(made)) => {
                for (number, ((old, new), made)) in old.passes.iter().zip(&new.passes).zip(&made.passes).enumerate() {
                    params(number, old, new, &made.template)?;
                }
            }
            (Work::Dispatch(old), Work::Dispatch(new), PreparedStep::Dispatch(made)) => {
                params(0, old, new, &made.template)?;
                if old.groups != new.groups {
                    let mismatch = |what| Error::Mismatch { pass: new.name.to_string(), what };
                    let count = groups(gpu, after, new, made.size).map_err(mismatch)?;
                    renewed.push(([step, 0], ChangedValue::Groups(count)));
                }
            }
            _ => {}
        }
    }
    Ok(renewed)
}

/// Gives it to a pass. Nothing that was filled with other parameters may be in use.
fn take(prepared: &mut PreparedPlan, [step, pass]: [usize; 2], renewed: ChangedValue) {
    let put_in = |template: &mut SetTemplate, sets: &mut RingCache<PassSet>, params| {
        template.take(params);
        sets.forget();
    };
    match (&mut prepared.steps[step], renewed) {
        (PreparedStep::Render(scope), ChangedValue::Params(params)) => {
            let pass = &mut scope.passes[pass];
            put_in(&mut pass.template, &mut pass.sets, params);
        }
        (PreparedStep::Dispatch(made), ChangedValue::Params(params)) => {
            put_in(&mut made.template, &mut made.sets, params)
        }
        (PreparedStep::Dispatch(made), ChangedValue::Groups(count)) => made.groups = count,
        _ => {}
    }
}
