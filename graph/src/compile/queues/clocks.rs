//! What each queue knows of the others, and the waits that it takes.
//!
//! A step that waits for another one knows whatever that one knew, and that it and all before it on its queue are done. So
//! a wait is left out where an earlier wait of the queue, or another one of the same step, brings as much already: what
//! remains is the transitive reduction.

use super::{QUEUES, Steps};
use crate::plan::{StepId, Wait};
use crate::vulkan::Stages;

/// What queues know, step by step. Steps of several frames are numbered in one row.
#[derive(Debug, Clone)]
pub(super) struct Clocks {
    /// Steps of one frame.
    frame: u32,
    /// What each queue knows so far.
    now: [Steps; QUEUES],
    /// What each step knows when it begins.
    known: Vec<Steps>,
    /// What those know who wait for each step.
    signals: Vec<Steps>,
    /// Each step and a wait of it, in the order of steps.
    waits: Vec<(u32, Awaited)>,
}

/// A step that another one waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Awaited {
    queue: usize,
    step: u32,
    frames_ago: u32,
}

impl Clocks {
    /// Nothing is known yet. A frame has so many steps.
    pub(super) fn new(frame: u32) -> Clocks {
        Clocks { frame, now: Default::default(), known: Vec::new(), signals: Vec::new(), waits: Vec::new() }
    }

    /// Lets a step wait, once the steps before it are through.
    pub(super) fn require(&mut self, step: u32, queue: usize, required: Steps) {
        let missing: Vec<Awaited> = (0..QUEUES)
            .filter(|other| *other != queue && required[*other] > self.now[queue][*other])
            .map(|other| Awaited { queue: other, step: required[other] - 1, frames_ago: 0 })
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
        let mut here: Vec<Awaited> = self.waits.drain(start..).map(|(_, awaited)| awaited).collect();
        here.extend(missing);
        here.sort_by_key(|awaited| awaited.queue);
        let signals = &self.signals;
        self.waits.extend(needed(&here, |awaited| signals[awaited.step as usize]).map(|awaited| (step, awaited)));
    }

    /// The number of steps that are known of.
    pub(super) fn len(&self) -> u32 {
        self.known.len() as u32
    }

    /// What a step knows when it begins.
    pub(super) fn known(&self, step: u32) -> Steps {
        self.known[step as usize]
    }

    /// What those know who wait for a step.
    pub(super) fn signal(&self, step: u32) -> Steps {
        self.signals[step as usize]
    }

    /// The waits of a step.
    pub(super) fn waits(&self, step: u32) -> Vec<Wait> {
        let start = self.waits.partition_point(|(of, _)| *of < step);
        let here = self.waits[start..].iter().take_while(|(of, _)| *of == step);
        here.map(|(_, awaited)| Wait {
            step: StepId(awaited.step),
            frames_ago: awaited.frames_ago,
            stages: Stages::ALL_COMMANDS,
        })
        .collect()
    }

    /// Adds the waits that `required` asks for: steps, each with another one that it comes after, `frames_ago` frames back.
    /// `queues` says where each step runs. The waits for later frames than that one must be known.
    pub(super) fn require_earlier(&mut self, queues: &[usize], required: &[(u32, usize, u32)], frames_ago: u32) {
        let mut frames = Clocks::new(self.frame);
        let mut added: Vec<(u32, Awaited)> = Vec::new();
        let time = |frame: u32, step: u32| frame * self.frame + step;
        for frame in 0..=frames_ago {
            for (step, queue) in (0..self.frame).zip(queues) {
                let mut here: Vec<Awaited> = Vec::new();
                let start = self.waits.partition_point(|(of, _)| *of < step);
                let known = self.waits[start..].iter().take_while(|(of, _)| *of == step).map(|(_, awaited)| *awaited);
                let mut before = Steps::default();
                for awaited in known {
                    if let Some(frame) = frame.checked_sub(awaited.frames_ago) {
                        before[awaited.queue] = before[awaited.queue].max(time(frame, awaited.step) + 1);
                    }
                }
                if frame == frames_ago {
                    frames.require(time(frame, step), *queue, before);
                    let now = frames.known(time(frame, step));
                    let start = required.partition_point(|(of, ..)| *of < step);
                    for (_, other, awaited) in required[start..].iter().take_while(|(of, ..)| *of == step) {
                        if now[*other] <= *awaited && !here.iter().any(|it| it.queue == *other && it.step >= *awaited) {
                            here.retain(|it| it.queue != *other);
                            here.push(Awaited { queue: *other, step: *awaited, frames_ago });
                        }
                    }
                    let here: Vec<Awaited> = needed(&here, |it| frames.signals[it.step as usize]).collect();
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

/// Those of several waits of one step that no other one makes needless. Of each queue there is one of each frame.
fn needed(waits: &[Awaited], signal: impl Fn(&Awaited) -> Steps) -> impl Iterator<Item = Awaited> {
    let is_implied = |wait: &Awaited| {
        let mut others = waits.iter().filter(|other| *other != wait);
        others.any(|other| {
            let brings = signal(other)[wait.queue];
            // Of two that bring each other neither could be left out; that can't be, since each comes after what it brings.
            brings > wait.step
        })
    };
    waits.iter().filter(|wait| !is_implied(wait)).copied().collect::<Vec<_>>().into_iter()
}
