//! Whether the waits and barriers of each step are well formed.

use super::layouts;
use super::parts::overlap;
use super::scopes::impossible;
use super::work::Check;
use crate::plan::{ImageBarrier, Queue, Step, StepId};
use crate::vulkan::{Accesses, Layout, Sharing, Stages, name_of};

/// No image has more parts than this that barriers of one call keep apart.
const MOST_PARTS: usize = 1 << 12;

const CLASH: &str = "two barriers of one call concern the same part";

impl Check<'_, '_> {
    /// Reports malformed waits and barriers before and after the work of a step.
    pub(super) fn waits_and_barriers(&mut self, step: &Step) {
        self.waits(step);
        for barrier in &step.memory_barriers {
            self.stages_and_accesses(None, barrier.src_stages, barrier.src_accesses);
            self.of_queue(None, barrier.src_stages);
            self.stages_and_accesses(None, barrier.dst_stages, barrier.dst_accesses);
            self.of_queue(None, barrier.dst_stages);
        }
        for (barriers, own) in [(&step.image_barriers, 1), (&step.releases, 0)] {
            for barrier in barriers {
                let image = Some(barrier.image.0);
                self.stages_and_accesses(image, barrier.src_stages, barrier.src_accesses);
                self.stages_and_accesses(image, barrier.dst_stages, barrier.dst_accesses);
                self.ownership(barrier, own);
                self.image_barrier(barrier);
            }
            self.disjoint(barriers, own);
        }
    }

    fn waits(&mut self, step: &Step) {
        for wait in &step.waits {
            let StepId(other) = wait.step;
            if self.plan.steps[other as usize].queue == step.queue {
                self.wrong_step(format!("waits for step {other} on its own queue"));
            }
            if wait.frames_ago == 0 && wait.step >= self.id {
                self.wrong_step(format!("waits for step {other}, which is not submitted before it"));
            }
            self.stages_and_accesses(None, wait.stages, Accesses::empty());
            self.of_queue(None, wait.stages);
        }
    }

    fn of_queue(&mut self, image: Option<u32>, stages: Stages) {
        let impossible = stages.difference(possible(self.queue));
        if !impossible.is_empty() {
            let what = format!("names {}, which {} doesn't have", name_of(&impossible), name_of(&self.queue));
            self.found.structure(Some(self.id), image, what);
        }
    }

    /// `own`: which of the two queues of a transfer the step must be on.
    fn ownership(&mut self, barrier: &ImageBarrier, own: usize) {
        let image = Some(barrier.image.0);
        // Stages on the other queue are checked with the other half.
        if barrier.ownership.is_none() || own == 0 {
            self.of_queue(image, barrier.src_stages);
        }
        if barrier.ownership.is_none() || own == 1 {
            self.of_queue(image, barrier.dst_stages);
        }
        let Some(queues) = barrier.ownership else {
            if own == 0 {
                self.wrong(barrier.image, "a release must say between which queues");
            }
            return;
        };
        if queues[0] == queues[1] || queues[own] != self.queue {
            let [on, from, to] = [self.queue, queues[0], queues[1]].map(|queue| name_of(&queue));
            self.wrong(barrier.image, format!("a barrier on {on} can't hand it from {from} to {to}"));
        }
        if barrier.old_layout == Layout::Undefined {
            self.wrong(barrier.image, "a barrier hands over contents that it forgets");
        }
        if self.plan.image(barrier.image).sharing == Sharing::Concurrent {
            self.wrong(barrier.image, "a barrier hands over what all queues may use");
        }
    }

    fn image_barrier(&mut self, barrier: &ImageBarrier) {
        let image = self.plan.image(barrier.image);
        if barrier.new_layout == Layout::Undefined {
            self.wrong(barrier.image, "a barrier can't make a layout UNDEFINED");
        }
        for layout in [barrier.old_layout, barrier.new_layout] {
            if let Some(problem) = layouts::problem(image, barrier.range.aspects, layout) {
                self.wrong(barrier.image, format!("a barrier names {problem}"));
            }
        }
    }

    /// Barriers of one call aren't ordered, so no two may concern the same part.
    fn disjoint(&mut self, barriers: &[ImageBarrier], own: usize) {
        let call = 2 * self.id.0 + own as u32 + 1;
        let named_before =
            |barrier: &ImageBarrier| std::mem::replace(&mut self.calls[barrier.image.0 as usize], call) == call;
        if !barriers.iter().any(named_before) {
            return;
        }
        let mut clash = |one: &ImageBarrier, other: &ImageBarrier| {
            let clashes = one.image == other.image && overlap(one.range, other.range);
            if clashes {
                self.wrong(one.image, CLASH);
            }
            clashes
        };
        // Few barriers are compared in pairs, which is quicker than sorting them. Pairs give one mistake, sorted barriers one for
        // each image.
        const FEW: usize = 8;
        if barriers.len() <= FEW {
            for (at, one) in barriers.iter().enumerate() {
                if barriers[at + 1..].iter().any(|other| clash(one, other)) {
                    return;
                }
            }
            return;
        }
        let mut sorted: Vec<&ImageBarrier> = barriers.iter().collect();
        sorted.sort_by_key(|barrier| barrier.image);
        for same in sorted.chunk_by(|one, other| one.image == other.image) {
            let mut pairs =
                same.iter().enumerate().flat_map(|(at, one)| same[at + 1..].iter().map(move |other| (one, other)));
            if same.len() > MOST_PARTS || pairs.any(|(one, other)| overlap(one.range, other.range)) {
                self.wrong(same[0].image, CLASH);
            }
        }
    }

    /// Whether flags are known, and each access belongs to one of the stages.
    #[inline]
    pub(super) fn stages_and_accesses(&mut self, resource: Option<u32>, stages: Stages, accesses: Accesses) {
        if !self.scopes.of(stages, accesses).sound {
            self.unsound(resource, stages, accesses);
        }
    }

    #[cold]
    fn unsound(&mut self, resource: Option<u32>, stages: Stages, accesses: Accesses) {
        let known = Stages::from_bits(stages.bits()).is_some() && Accesses::from_bits(accesses.bits()).is_some();
        let what = if known {
            format!("{} doesn't happen in {}", name_of(&impossible(stages, accesses)), name_of(&stages))
        } else {
            "names stages or accesses that are not known".to_owned()
        };
        self.found.structure(Some(self.id), resource, what);
    }
}

/// The stages that a queue supports.
pub(super) const fn possible(queue: Queue) -> Stages {
    let transfer = Stages::COPY.union(Stages::CLEAR).union(Stages::HOST).union(Stages::ALL_COMMANDS);
    match queue {
        Queue::Graphics => Stages::all(),
        Queue::Compute => transfer
            .union(Stages::COMPUTE_SHADER)
            .union(Stages::DRAW_INDIRECT)
            .union(Stages::RAY_TRACING_SHADER_KHR)
            .union(Stages::ACCELERATION_STRUCTURE_BUILD_KHR)
            .union(Stages::ACCELERATION_STRUCTURE_COPY_KHR),
        Queue::Transfer => transfer,
    }
}
