//! Correct Plans, written by hand: every mask holds exactly what is needed, so that every bit can be missed.

mod across_frames;
mod buffers;
pub(crate) mod build;
mod compute_chain;
mod history;
mod local_read;
mod mip_chain;
mod multisampled;
mod read_only_depth;
mod stencil;
mod two_queues;

use framewright_graph::plan::{Placement, Plan, Role, StepId, Totals};
use framewright_graph::verify::Violation;

/// All of them.
pub(crate) fn all() -> [(&'static str, Plan); 10] {
    [
        ("multisampled", multisampled::plan()),
        ("compute chain", compute_chain::plan()),
        ("read-only depth", read_only_depth::plan()),
        ("buffers", buffers::plan()),
        ("history", history::plan()),
        ("stencil", stencil::plan()),
        ("mip chain", mip_chain::plan()),
        ("local read", local_read::plan()),
        ("two queues", two_queues::plan()),
        ("across frames", across_frames::plan()),
    ]
}

/// Makes the totals right again after a change, so that they don't give it away.
pub(crate) fn recount(plan: &mut Plan) {
    let roles = plan.images.iter().map(|image| &image.role).chain(plan.buffers.iter().map(|buffer| &buffer.role));
    let placements: Vec<&Placement> = roles.filter_map(placed).collect();
    let live = |step: u32| {
        let alive = |placement: &&&Placement| (placement.lifetime[0].0..=placement.lifetime[1].0).contains(&step);
        placements.iter().filter(alive).map(|placement| placement.bytes).sum::<u64>()
    };
    plan.totals = Totals {
        transient_bytes: placements.iter().map(|placement| placement.bytes).sum(),
        placed_bytes: plan.heaps.iter().map(|heap| heap.bytes).sum(),
        live_peak_bytes: (0..plan.steps.len() as u32).map(live).max().unwrap_or(0),
        kept_bytes: plan.totals.kept_bytes,
        ..Totals::count(&plan.steps)
    };
}

/// Its place in a heap, if it has one.
pub(crate) fn placed(role: &Role) -> Option<&Placement> {
    match role {
        Role::Transient(placement) => Some(placement),
        Role::External { .. } | Role::Persistent { .. } => None,
    }
}

/// Whether a violation names both steps and the part of an image or the bytes of a buffer, in its data and in its sentence.
pub(crate) fn names_all(violation: &Violation) -> bool {
    let Violation { step: Some(step), other: Some(other), resource: Some(resource), .. } = violation else {
        return false;
    };
    let part = match (violation.range, violation.bytes) {
        (Some(range), _) => range.to_string(),
        (None, Some([start, end])) => format!("bytes {start}–{end}"),
        (None, None) => return false,
    };
    let sentence = violation.to_string();
    [step.to_string(), other.to_string(), format!("`{resource}`"), part].iter().all(|part| sentence.contains(part))
}

pub(crate) fn lifetime(first: u32, last: u32) -> [StepId; 2] {
    [StepId(first), StepId(last)]
}
