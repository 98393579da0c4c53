//! Vector clocks: what each queue knows of the others, and the waits between them.
//!
//! A step that waits for another one learns that the other one, and all before it on its queue, are done. It also learns all that
//! the other one knew. So a wait is left out where an earlier wait of the queue, or another wait of the same step, implies it.
//! The rest is the transitive reduction of all waits.

use super::number::{QUEUES, Steps};
use crate::compile::steps::of_step;
use crate::plan::{StepId, Wait};
use crate::vulkan::Stages;

/// The clocks of all queues, step by step. Steps of several frames are numbered in one row.
#[derive(Debug, Clone, Default)]
pub(super) struct Clocks {
    /// Steps of one frame.
    frame: u32,
    /// The steps that each queue knows to be done.
    now: [Steps; QUEUES],
    /// The steps that are known to be done when each step begins.
    known: Vec<Steps>,
    /// The steps that are known to be done after a wait for each step.
    signals: Vec<Steps>,
    /// Each step and a wait of it, in the order of steps.
    waits: Vec<(u32, AwaitedStep)>,
}

/// A step that another one waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct AwaitedStep {
    queue: usize,
    step: u32,
    frames_ago: u32,
}

/// A step that comes after a step of another queue, some frames ago.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct EarlierStep {
    pub(super) frames_ago: u32,
    pub(super) step: u32,
    /// The other step's queue.
    pub(super) queue: usize,
    /// The other step.
    pub(super) of: u32,
}

impl Clocks {
    /// Clocks of frames of `frame` steps. Nothing is known yet.
    pub(super) fn new(frame: u32) -> Clocks {
        Clocks { frame, ..Clocks::default() }
    }

    /// Lets a step wait. The waits of the steps before it must be known.
    pub(super) fn require(&mut self, step: u32, queue: usize, required: Steps) {
        let missing: Vec<AwaitedStep> = (0..QUEUES)
            .filter(|other| *other != queue && required[*other] > self.now[queue][*other])
            .map(|other| AwaitedStep { queue: other, step: required[other] - 1, frames_ago: 0 })
            .collect();
        for awaited in &missing {
            join(&mut self.now[queue], &self.signals[awaited.step as usize]);
        }
        self.known.resize(step as usize + 1, Steps::default());
        self.signals.resize(step as usize + 1, Steps::default());
        let now = self.now[queue];
        self.known[step as usize] = now;
        self.signals[step as usize] = now;
        self.signals[step as usize][queue] = step + 1;
        if missing.is_empty() {
            return;
        }
        let start = self.waits.partition_point(|(of, _)| *of < step);
        let mut here: Vec<AwaitedStep> = self.waits.drain(start..).map(|(_, awaited)| awaited).collect();
        here.extend(missing);
        here.sort_by_key(|awaited| awaited.queue);
        let signals = &self.signals;
        self.waits.extend(needed(&here, |awaited| signals[awaited.step as usize]).map(|awaited| (step, awaited)));
    }

    /// The number of steps so far.
    pub(super) fn len(&self) -> u32 {
        self.known.len() as u32
    }

    /// The steps that are known to be done when a step begins.
    pub(super) fn known(&self, step: u32) -> Steps {
        self.known[step as usize]
    }

    /// The steps that are known to be done after a wait for `step`.
    pub(super) fn signal(&self, step: u32) -> Steps {
        self.signals[step as usize]
    }

    /// The waits of a step.
    pub(super) fn waits(&self, step: u32) -> Vec<Wait> {
        let wait = |(_, awaited): &(u32, AwaitedStep)| Wait {
            step: StepId(awaited.step),
            frames_ago: awaited.frames_ago,
            stages: Stages::ALL_COMMANDS,
        };
        of_step(&self.waits, step, |(of, _)| *of).iter().map(wait).collect()
    }

    /// Adds the waits that `required` asks for, which are all the same number of frames ago, in the order of steps.
    /// `queues` says where each step runs. The waits for later frames than that one must be known.
    pub(super) fn require_earlier(&mut self, queues: &[usize], required: &[EarlierStep]) {
        let frames_ago = required.first().map_or(0, |first| first.frames_ago);
        let mut frames = Clocks::new(self.frame);
        let mut added: Vec<(u32, AwaitedStep)> = Vec::new();
        let time = |frame: u32, step: u32| frame * self.frame + step;
        for frame in 0..=frames_ago {
            for (step, queue) in (0..self.frame).zip(queues) {
                let mut here: Vec<AwaitedStep> = Vec::new();
                let mut before = Steps::default();
                for (_, awaited) in of_step(&self.waits, step, |(of, _)| *of) {
                    if let Some(frame) = frame.checked_sub(awaited.frames_ago) {
                        before[awaited.queue] = before[awaited.queue].max(time(frame, awaited.step) + 1);
                    }
                }
                if frame == frames_ago {
                    frames.require(time(frame, step), *queue, before);
                    let now = frames.known(time(frame, step));
                    for EarlierStep { queue, of, .. } in of_step(required, step, |it| it.step).iter().copied() {
                        if now[queue] <= of && !here.iter().any(|it| it.queue == queue && it.step >= of) {
                            here.retain(|it| it.queue != queue);
                            here.push(AwaitedStep { queue, step: of, frames_ago });
                        }
                    }
                    let here: Vec<AwaitedStep> = needed(&here, |it| frames.signals[it.step as usize]).collect();
                    here.iter().for_each(|it| before[it.queue] = before[it.queue].max(it.step + 1));
                    added.extend(here.into_iter().map(|it| (step, it)));
                }
                frames.require(time(frame, step), *queue, before);
            }
        }
        self.waits.extend(added);
        self.waits.sort_by_key(|(step, awaited)| (*step, awaited.queue, awaited.frames_ago));
    }
}

fn join(known: &mut Steps, more: &Steps) {
    known.iter_mut().zip(more).for_each(|(known, more)| *known = (*known).max(*more));
}

/// The waits of one step that no other of them implies. There is at most one for each queue and frame.
fn needed(waits: &[AwaitedStep], signal: impl Fn(&AwaitedStep) -> Steps) -> impl Iterator<Item = AwaitedStep> {
    let is_implied = |wait: &AwaitedStep| {
        let mut others = waits.iter().filter(|other| *other != wait);
        // No two imply each other, since each step comes after those that it knows.
        others.any(|other| signal(other)[wait.queue] > wait.step)
    };
    waits.iter().filter(|wait| !is_implied(wait)).copied().collect::<Vec<_>>().into_iter()
}
