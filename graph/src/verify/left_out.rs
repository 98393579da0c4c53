//! Steps that don't run in each frame: a Plan must hold where they are left out.

use crate::frame::Cadence;
use crate::plan::Plan;

/// Steps that are left out between the first frame and the last one; empty: none.
#[derive(Debug, Default)]
pub(super) struct LeftOut(Vec<bool>);

/// The most cadences of which each is tried alone: its steps left out, and the steps of all others left out.
const MOST_ALONE: usize = 16;

impl LeftOut {
    /// The choices of steps that are tried: all that may be left out, and of the first cadences the steps of each alone, and all but
    /// those.
    pub(super) fn choices(plan: &Plan) -> Vec<LeftOut> {
        let mut cadences: Vec<&Cadence> = Vec::new();
        for step in plan.steps.iter().filter(|step| step.run != Cadence::Always) {
            if !cadences.contains(&&step.run) {
                cadences.push(&step.run);
            }
        }
        let choice = |is_out: &dyn Fn(&Cadence) -> bool| {
            LeftOut(plan.steps.iter().map(|step| step.run != Cadence::Always && is_out(&step.run)).collect())
        };
        let mut choices = Vec::new();
        if !cadences.is_empty() {
            choices.push(choice(&|_| true));
        }
        if cadences.len() > 1 {
            for cadence in cadences.into_iter().take(MOST_ALONE) {
                choices.push(choice(&|other| other == cadence));
                choices.push(choice(&|other| other != cadence));
            }
        }
        choices
    }

    /// Whether a step runs in the frame of this number, of so many.
    pub(super) fn runs(&self, step: u32, frame: u32, frames: u32) -> bool {
        frame == 0 || frame + 1 == frames || !self.0.get(step as usize).is_some_and(|out| *out)
    }
}
