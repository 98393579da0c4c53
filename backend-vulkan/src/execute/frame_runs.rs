//! Which steps of the next frame run: those that don't run in every frame have their turn, or are left out.

use crate::base::Error;
use crate::prepare::FrameClock;
use framewright_graph::frame::Cadence;
use framewright_graph::plan::{Plan, Step};
use std::collections::BTreeSet;

/// How many frames make a second, where the program tells no time.
const FRAMES_A_SECOND: f64 = 60.0;

/// Which steps of the next frame run.
#[derive(Debug)]
pub(crate) struct FrameRuns {
    /// Whether all steps run in the next frame, since contents that stay aren't there yet, or any more.
    all: bool,
    /// The names that are dirty.
    dirty: BTreeSet<String>,
    /// By step, whether it is left out of the frame at hand; empty: none is.
    left_out: Vec<bool>,
    /// What is added to a frame's number.
    shift: u64,
    /// The time, if the program tells it.
    seconds: Option<f64>,
}

impl Default for FrameRuns {
    fn default() -> FrameRuns {
        FrameRuns { all: true, dirty: BTreeSet::new(), left_out: Vec::new(), shift: 0, seconds: None }
    }
}

impl FrameRuns {
    /// Decides for the frame that has this number.
    pub(super) fn begin(&mut self, plan: &Plan, frame: u64) {
        let FrameRuns { all, dirty, left_out, shift, .. } = self;
        left_out.clear();
        if !*all && plan.steps.iter().any(|step| !step.run.is_always()) {
            let frame = frame.wrapping_add(*shift);
            left_out.extend(plan.steps.iter().map(|step| !runs(&step.run, frame, dirty)));
        }
    }

    /// The frame at hand was recorded: what it did needs not be done again.
    pub(super) fn recorded(&mut self) {
        self.all = false;
        self.dirty.clear();
    }

    /// All steps run in the next frame.
    pub(super) fn run_all(&mut self) {
        self.all = true;
    }

    /// Steps run in the next frame that wait for this name.
    pub(super) fn set_dirty(&mut self, plan: &Plan, name: &str) -> Result<(), Error> {
        let mut known: Vec<&str> = plan.steps.iter().filter_map(awaited).collect();
        if known.contains(&name) {
            self.dirty.insert(name.to_owned());
            return Ok(());
        }
        known.sort_unstable();
        known.dedup();
        let names: Vec<String> = known.into_iter().map(|name| format!("`{name}`")).collect();
        let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        Err(Error::BadResource { what: format!("no pass runs when `{name}` is dirty; passes wait for {names}") })
    }

    /// Gives the next frame, which is counted as `counted`, another number. Frames are counted on from there.
    pub(super) fn set_number(&mut self, counted: u64, number: u64) {
        self.shift = number.wrapping_sub(counted);
    }

    /// The number of the frame that is counted as `counted`.
    pub(super) fn number(&self, counted: u64) -> u64 {
        counted.wrapping_add(self.shift)
    }

    /// Sets the time of frames from the next one on.
    pub(super) fn set_time(&mut self, seconds: f64) -> Result<(), Error> {
        if !seconds.is_finite() {
            return Err(Error::BadResource { what: format!("a time of {seconds} seconds") });
        }
        self.seconds = Some(seconds);
        Ok(())
    }

    /// What the parameters of the frame may be of that is counted as `counted`.
    pub(super) fn clock(&self, counted: u64) -> FrameClock {
        let frame = self.number(counted);
        #[allow(clippy::cast_precision_loss, reason = "a time is no exact number")]
        let counted = || frame as f64 / FRAMES_A_SECOND;
        FrameClock { frame, seconds: self.seconds.unwrap_or_else(counted) }
    }

    /// Goes on from those of an executor before: frames keep their numbers. All steps run, as in any first frame.
    pub(super) fn go_on(&mut self, before: &FrameRuns) {
        (self.shift, self.seconds) = (before.shift, before.seconds);
    }

    /// Follows a change of values: where a step that may be left out has others, all run.
    pub(super) fn change(&mut self, old: &Plan, new: &Plan) {
        let mut steps = old.steps.iter().zip(&new.steps).filter(|(step, _)| !step.run.is_always());
        self.all |= steps.any(|(old, new)| old.work != new.work);
    }

    /// By step, whether it is left out of the frame at hand; empty: none is.
    pub(super) fn left_out(&self) -> &[bool] {
        &self.left_out
    }
}

fn runs(cadence: &Cadence, frame: u64, dirty: &BTreeSet<String>) -> bool {
    match cadence {
        Cadence::Always => true,
        Cadence::Once => false,
        Cadence::Every { count, at } => frame.checked_rem(u64::from(*count)) == Some(u64::from(*at)),
        Cadence::WhenDirty(name) => dirty.contains(&**name),
    }
}

/// The name that a step waits for.
fn awaited(step: &Step) -> Option<&str> {
    if let Cadence::WhenDirty(name) = &step.run { Some(name) } else { None }
}
