//! Whether a Plan's sums add up.

use super::findings::Findings;
use super::violation::{Rule, Violation};
use crate::plan::{Placement, Plan, Role, Totals};

/// Reports the sums that are wrong.
pub(super) fn check(plan: &Plan, found: &mut Findings) {
    let placements = || {
        let roles = plan.images.iter().map(|image| &image.role).chain(plan.buffers.iter().map(|buffer| &buffer.role));
        roles.filter_map(|role| match role {
            Role::Transient(placement) => Some(placement),
            Role::External { .. } | Role::Persistent { .. } => None,
        })
    };
    let stated = plan.totals;
    let counted = Totals {
        transient_bytes: placements().map(|placement| placement.bytes).fold(0, u64::saturating_add),
        placed_bytes: plan.heaps.iter().map(|heap| heap.bytes).fold(0, u64::saturating_add),
        live_peak_bytes: live_peak(plan.steps.len(), placements()),
        // Sizes of memory outside all heaps are known only to the program that made it.
        kept_bytes: stated.kept_bytes,
        ..Totals::count(&plan.steps)
    };
    for ((field, stated), (_, counted)) in fields(&stated).into_iter().zip(fields(&counted)) {
        if stated != counted {
            let rule = Rule::Total { field, stated, counted };
            found.violations.push(Violation {
                rule,
                step: None,
                other: None,
                resource: None,
                range: None,
                bytes: None,
            });
        }
    }
}

fn fields(totals: &Totals) -> [(&'static str, u64); 14] {
    [
        ("passes", totals.passes.into()),
        ("inserted_passes", totals.inserted_passes.into()),
        ("scopes", totals.scopes.into()),
        ("resolves", totals.resolves.into()),
        ("folded_resolves", totals.folded_resolves.into()),
        ("copies", totals.copies.into()),
        ("fills", totals.fills.into()),
        ("waits", totals.waits.into()),
        ("barrier_calls", totals.barrier_calls.into()),
        ("image_barriers", totals.image_barriers.into()),
        ("memory_barriers", totals.memory_barriers.into()),
        ("transient_bytes", totals.transient_bytes),
        ("placed_bytes", totals.placed_bytes),
        ("live_peak_bytes", totals.live_peak_bytes),
    ]
}

/// The largest total of images and buffers alive at one step.
fn live_peak<'p>(steps: usize, placements: impl Iterator<Item = &'p Placement>) -> u64 {
    let mut changes = vec![[0_u64; 2]; steps];
    for placement in placements {
        let [first, last] = placement.lifetime.map(|step| step.0 as usize);
        changes[first][0] = changes[first][0].saturating_add(placement.bytes);
        changes[last][1] = changes[last][1].saturating_add(placement.bytes);
    }
    let mut live = 0_u64;
    let mut peak = 0;
    for [begun, ended] in changes {
        live = live.saturating_add(begun);
        peak = peak.max(live);
        live = live.saturating_sub(ended);
    }
    peak
}
