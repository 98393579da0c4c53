//! `scope`: neighbouring raster passes become one rendering scope where nothing forbids it and something gains; resolves
//! fold into the scope that wrote last.

mod builder;
mod can_join;
mod gain;
mod local;
mod step;
mod trace;

use super::model::AdaptedFrame;
use crate::device::Profile;
use crate::frame::Frame;
use crate::plan::{Note, Reason};
use builder::Builder;
use gain::Gain;

pub(super) use step::{Scope, Step, Target, op_name, resource_name};

/// Steps in execution order.
#[derive(Debug)]
pub(super) struct ScopedSteps {
    pub(super) steps: Vec<Step>,
    /// The gain of a pass that shares its scope with the pass before it, for each operation; empty if nothing is drawn.
    gains: Vec<Option<Gain>>,
}

impl ScopedSteps {
    /// Why operation number `op` shares its scope with the one before it.
    pub(super) fn merged(&self, frame: &Frame, adapted: &AdaptedFrame, op: u32) -> Option<Box<Reason>> {
        Some(Box::new(self.gains.get(op as usize)?.as_ref()?.reason(frame, adapted)))
    }
}

/// The steps that `order` becomes, the operations with the local reads that this makes possible, and notes of what was
/// decided.
pub(super) fn scope(
    frame: &Frame,
    mut adapted: AdaptedFrame,
    order: &[u32],
    device: &Profile,
) -> (ScopedSteps, AdaptedFrame, Vec<Note>) {
    if !adapted.ops.iter().any(|op| op.kind.draws()) {
        let mut steps = Vec::with_capacity(order.len() + 1);
        steps.extend(order.iter().map(|op| Step::Single(*op)));
        return (ScopedSteps { steps, gains: Vec::new() }, adapted, Vec::new());
    }
    let mut builder = Builder::new(frame, &adapted, device);
    for op in order {
        builder.op(*op);
    }
    let Builder { steps, gains, notes, local, .. } = builder;
    local::read_locally(&mut adapted.uses, &local);
    (ScopedSteps { steps, gains }, adapted, notes)
}
