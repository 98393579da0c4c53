//! Memory spans: lifetimes that are long enough where steps of several queues run side by side.

use super::number::QUEUES;
use super::state::Queues;
use super::step_uses::uses_of;
use crate::compile::model::{AdaptedFrame, PhysicalIndex};
use crate::compile::scope::ScopedSteps;
use crate::compile::steps::NEVER;

impl Queues {
    /// For each physical resource the first and the last step at which its memory is taken; `None` if these are its
    /// lifetimes, as on one queue.
    ///
    /// If the spans of two are apart, every use of the later one comes after all uses of the other. What other queues use is
    /// taken from before every graphics step that they don't wait for, to behind every step that doesn't wait for them.
    pub(in crate::compile) fn memory_spans(
        &self,
        adapted: &AdaptedFrame,
        scoped: &ScopedSteps,
        lifetimes: &[[u32; 2]],
    ) -> Option<Vec<[u32; 2]>> {
        if self.is_one() {
            return None;
        }
        let mut spans = lifetimes.to_vec();
        let count = scoped.steps.len() as u32;
        let mut on: [Vec<u32>; QUEUES] = Default::default();
        (0..count).for_each(|step| on[self.queue_number(step)].push(step));
        let mut beside = vec![false; spans.len()];
        let used = |step: u32| uses_of(adapted, &scoped.steps[step as usize]).map(|used| used.resource);
        for step in on[1..].iter().flatten() {
            used(*step).for_each(|resource: PhysicalIndex| beside[resource as usize] = true);
        }
        for step in 0..count {
            let queue = self.queue_number(step);
            let known = self.known(step)[0];
            let early = match on[0].get(on[0].partition_point(|graphics| *graphics < known)) {
                Some(graphics) if queue != 0 => (*graphics).min(step),
                _ => step,
            };
            let late = self.last_beside(&on, step, queue);
            for resource in used(step).filter(|resource| beside[*resource as usize]) {
                let [first, last] = &mut spans[resource as usize];
                if *first != NEVER {
                    (*first, *last) = ((*first).min(early), (*last).max(late));
                }
            }
        }
        Some(spans)
    }

    /// The last step of another queue that is submitted later and doesn't know this one to be done; the step itself if there
    /// is none.
    fn last_beside(&self, on: &[Vec<u32>; QUEUES], step: u32, queue: usize) -> u32 {
        let others = on.iter().enumerate().filter(|(other, _)| *other != queue);
        let last = others.filter_map(|(_, steps)| {
            let first_to_know = steps.partition_point(|other| self.known(*other)[queue] <= step);
            steps[..first_to_know].last().copied()
        });
        last.fold(step, u32::max)
    }
}
