//! Passes that run in a frame, and those that are off.

use crate::frame::Pass;

/// A pass as it runs in this frame, or doesn't.
pub(in crate::expand) enum State {
    /// The pass runs.
    On(Pass),
    /// The pass is off.
    Off {
        /// The pass as it would run.
        would: Pass,
        /// The passes that run instead.
        stand_ins: Vec<Pass>,
        /// Why the pass is off.
        because: String,
    },
}

impl State {
    /// All passes that run, in their order.
    pub(in crate::expand) fn into_passes(states: Vec<State>) -> Vec<Pass> {
        let mut passes = Vec::with_capacity(states.len());
        for state in states {
            match state {
                State::On(pass) => passes.push(pass),
                State::Off { stand_ins, .. } => passes.extend(stand_ins),
            }
        }
        passes
    }

    /// The passes that run here: itself or its stand-ins.
    pub(in crate::expand) fn runs(&self) -> &[Pass] {
        match self {
            State::On(pass) => std::slice::from_ref(pass),
            State::Off { stand_ins, .. } => stand_ins,
        }
    }
}
