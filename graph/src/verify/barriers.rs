//! Whether the waits and barriers of each step are well formed.

use super::findings::Findings;
use super::parts::overlap;
use super::scopes::impossible;
use crate::plan::{ImageBarrier, Plan, Queue, Step, StepId};
use crate::vulkan::{Accesses, Aspects, Layout, Sharing, Stages, Usage, name_of};

/// Reports malformed waits and barriers before and after the work of a step.
pub(super) fn check(plan: &Plan, id: StepId, step: &Step, found: &mut Findings) {
    check_waits(plan, id, step, found);
    for barrier in &step.memory_barriers {
        for (stages, accesses) in
            [(barrier.src_stages, barrier.src_accesses), (barrier.dst_stages, barrier.dst_accesses)]
        {
            check_scope(id, None, stages, accesses, found);
            check_queue(id, None, step.queue, stages, found);
        }
    }
    for (barriers, own) in [(&step.image_barriers, 1), (&step.releases, 0)] {
        for barrier in barriers {
            let image = Some(barrier.image.0);
            check_scope(id, image, barrier.src_stages, barrier.src_accesses, found);
            check_scope(id, image, barrier.dst_stages, barrier.dst_accesses, found);
            check_ownership(plan, id, step.queue, barrier, own, found);
            check_image_barrier(plan, id, barrier, found);
        }
        check_disjoint(id, barriers, found);
    }
}

fn check_waits(plan: &Plan, id: StepId, step: &Step, found: &mut Findings) {
    for wait in &step.waits {
        let StepId(other) = wait.step;
        if plan.steps[other as usize].queue == step.queue {
            found.structure(Some(id), None, format!("waits for step {other} on its own queue"));
        }
        if wait.frames_ago == 0 && wait.step >= id {
            found.structure(Some(id), None, format!("waits for step {other}, which is not submitted before it"));
        }
        check_scope(id, None, wait.stages, Accesses::empty(), found);
        check_queue(id, None, step.queue, wait.stages, found);
    }
}

/// The stages that a queue supports.
pub(super) const fn possible(queue: Queue) -> Stages {
    let transfer = Stages::COPY.union(Stages::CLEAR).union(Stages::HOST).union(Stages::ALL_COMMANDS);
    match queue {
        Queue::Graphics => Stages::all(),
        Queue::Compute => transfer.union(Stages::COMPUTE_SHADER).union(Stages::DRAW_INDIRECT),
        Queue::Transfer => transfer,
    }
}

fn check_queue(id: StepId, image: Option<u32>, queue: Queue, stages: Stages, found: &mut Findings) {
    let impossible = stages.difference(possible(queue));
    if !impossible.is_empty() {
        let what = format!("names {}, which {} doesn't have", name_of(&impossible), name_of(&queue));
        found.structure(Some(id), image, what);
    }
}

/// `own`: which of the two queues of a transfer the step must be on.
fn check_ownership(plan: &Plan, id: StepId, queue: Queue, barrier: &ImageBarrier, own: usize, found: &mut Findings) {
    let image = Some(barrier.image.0);
    // Stages on the other queue are checked with the other half.
    let ours = match (barrier.ownership, own) {
        (None, _) => [true, true],
        (Some(_), 0) => [true, false],
        (Some(_), _) => [false, true],
    };
    for (stages, _) in [barrier.src_stages, barrier.dst_stages].into_iter().zip(ours).filter(|(_, ours)| *ours) {
        check_queue(id, image, queue, stages, found);
    }
    let Some(queues) = barrier.ownership else {
        if own == 0 {
            found.structure(Some(id), image, "a release must say between which queues");
        }
        return;
    };
    if queues[0] == queues[1] || queues[own] != queue {
        let [from, to] = queues.map(|queue| name_of(&queue));
        found.structure(Some(id), image, format!("a barrier on {} can't hand it from {from} to {to}", name_of(&queue)));
    }
    if barrier.old_layout == Layout::Undefined {
        found.structure(Some(id), image, "a barrier hands over contents that it forgets");
    }
    if plan.image(barrier.image).sharing == Sharing::Concurrent {
        found.structure(Some(id), image, "a barrier hands over what all queues may use");
    }
}

fn check_image_barrier(plan: &Plan, id: StepId, barrier: &ImageBarrier, found: &mut Findings) {
    let image = plan.image(barrier.image);
    if barrier.new_layout == Layout::Undefined {
        found.structure(Some(id), Some(barrier.image.0), "a barrier can't make a layout UNDEFINED");
    }
    for layout in [barrier.old_layout, barrier.new_layout] {
        let of_both = matches!(layout, Layout::DepthStencilAttachmentOptimal | Layout::DepthStencilReadOnlyOptimal);
        // Work outside of the frame may name both planes at once.
        let both = of_both && image.format.is_depth();
        if !both && !planes(layout, image.format.aspects()).contains(barrier.range.aspects) {
            let what = format!("a barrier names {}, which not all of its planes can be in", name_of(&layout));
            found.structure(Some(id), Some(barrier.image.0), what);
        }
    }
    if !image.usage.intersects(usage_for(barrier.new_layout)) {
        let what = format!("a barrier brings it to {}, for which it has no usage", name_of(&barrier.new_layout));
        found.structure(Some(id), Some(barrier.image.0), what);
    }
}

/// The planes, of an image that has `planes`, that can be in a layout: where there are depth and stencil each has its own.
pub(super) fn planes(layout: Layout, planes: Aspects) -> Aspects {
    let both = Aspects::DEPTH | Aspects::STENCIL;
    match layout {
        Layout::ColorAttachmentOptimal | Layout::PresentSrcKhr => planes & Aspects::COLOR,
        Layout::DepthStencilAttachmentOptimal | Layout::DepthStencilReadOnlyOptimal if planes == both => {
            Aspects::empty()
        }
        Layout::DepthStencilAttachmentOptimal | Layout::DepthStencilReadOnlyOptimal => planes & both,
        Layout::DepthAttachmentOptimal | Layout::DepthReadOnlyOptimal if planes != both => Aspects::empty(),
        Layout::StencilAttachmentOptimal | Layout::StencilReadOnlyOptimal if planes != both => Aspects::empty(),
        Layout::DepthAttachmentOptimal | Layout::DepthReadOnlyOptimal => Aspects::DEPTH,
        Layout::StencilAttachmentOptimal | Layout::StencilReadOnlyOptimal => Aspects::STENCIL,
        Layout::Undefined
        | Layout::General
        | Layout::ShaderReadOnlyOptimal
        | Layout::TransferSrcOptimal
        | Layout::TransferDstOptimal
        | Layout::RenderingLocalReadKhr => planes,
    }
}

/// The usages of which an image must have one to be in a layout.
fn usage_for(layout: Layout) -> Usage {
    match layout {
        Layout::ColorAttachmentOptimal => Usage::COLOR_ATTACHMENT,
        Layout::DepthStencilAttachmentOptimal | Layout::DepthAttachmentOptimal | Layout::StencilAttachmentOptimal => {
            Usage::DEPTH_STENCIL_ATTACHMENT
        }
        Layout::DepthStencilReadOnlyOptimal | Layout::DepthReadOnlyOptimal | Layout::StencilReadOnlyOptimal => {
            Usage::DEPTH_STENCIL_ATTACHMENT
        }
        Layout::ShaderReadOnlyOptimal => Usage::SAMPLED | Usage::INPUT_ATTACHMENT,
        Layout::TransferSrcOptimal => Usage::TRANSFER_SRC,
        Layout::TransferDstOptimal => Usage::TRANSFER_DST,
        Layout::RenderingLocalReadKhr => Usage::INPUT_ATTACHMENT,
        Layout::Undefined | Layout::General | Layout::PresentSrcKhr => Usage::all(),
    }
}

/// Barriers of one call aren't ordered, so no two may concern the same part.
fn check_disjoint(id: StepId, barriers: &[ImageBarrier], found: &mut Findings) {
    // Up to here looking at all pairs is quicker than sorting.
    const FEW: usize = 8;
    let mut clash = |one: &ImageBarrier, other: &ImageBarrier| {
        let clashes = one.image == other.image && overlap(one.range, other.range);
        if clashes {
            found.structure(Some(id), Some(one.image.0), "two barriers of one call concern the same part");
        }
        clashes
    };
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
        pairs.any(|(one, other)| clash(one, other));
    }
}

/// Whether flags are known, and each access belongs to one of the stages.
pub(super) fn check_scope(id: StepId, resource: Option<u32>, stages: Stages, accesses: Accesses, found: &mut Findings) {
    let unknown = Stages::from_bits(stages.bits()).is_none() || Accesses::from_bits(accesses.bits()).is_none();
    if unknown {
        found.structure(Some(id), resource, "names stages or accesses that are not known");
        return;
    }
    let impossible = impossible(stages, accesses);
    if !impossible.is_empty() {
        let what = format!("{} doesn't happen in {}", name_of(&impossible), name_of(&stages));
        found.structure(Some(id), resource, what);
    }
}
