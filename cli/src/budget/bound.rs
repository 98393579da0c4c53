//! What a bound is on, and how much of it each step of a Plan adds.

use framewright_graph::hints::{Hint, HintKind, hints};
use framewright_graph::plan::{MovedBytes, Plan, Role, Step, Totals};
use std::borrow::Cow;

/// A quantity that a budget bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bound {
    Passes,
    InsertedPasses,
    Scopes,
    Resolves,
    Copies,
    Barriers,
    BarrierCalls,
    Waits,
    MemoryMib,
    LoadedMib,
    StoredMib,
    ResolvedMib,
    CopiedMib,
    MovedMib,
    /// Those of a kind, or of all.
    Hints(Option<HintKind>),
}

/// Bytes of a MiB.
const MIB: f64 = (1 << 20) as f64;

impl Bound {
    /// The quantity in words, and its unit.
    pub(super) fn words(self) -> (Cow<'static, str>, &'static str) {
        let (words, unit) = match self {
            Bound::Passes => ("passes", ""),
            Bound::InsertedPasses => ("inserted passes", ""),
            Bound::Scopes => ("rendering scopes", ""),
            Bound::Resolves => ("resolves", ""),
            Bound::Copies => ("copies", ""),
            Bound::Barriers => ("barriers", ""),
            Bound::BarrierCalls => ("barrier calls", ""),
            Bound::Waits => ("waits", ""),
            Bound::MemoryMib => ("transient memory", " MiB"),
            Bound::LoadedMib => ("loaded", " MiB"),
            Bound::StoredMib => ("stored", " MiB"),
            Bound::ResolvedMib => ("resolved", " MiB"),
            Bound::CopiedMib => ("copied", " MiB"),
            Bound::MovedMib => ("moved", " MiB"),
            Bound::Hints(None) => ("hints", ""),
            Bound::Hints(Some(kind)) => return (format!("hints {}", kind.code()).into(), ""),
        };
        (words.into(), unit)
    }

    /// All of it in a Plan.
    pub(super) fn of(self, plan: &Plan) -> f64 {
        match self {
            Bound::MemoryMib => plan.totals.placed_bytes as f64 / MIB,
            Bound::Hints(_) => self.hints(plan).len() as f64,
            _ => plan.steps.iter().map(|step| self.of_step(plan, step)).sum(),
        }
    }

    /// The hints that it is on, the most bytes first. Other bounds are on none.
    pub(super) fn hints(self, plan: &Plan) -> Vec<Hint> {
        let Bound::Hints(kind) = self else { return Vec::new() };
        hints(plan).into_iter().filter(|hint| kind.is_none_or(|kind| kind == hint.kind)).collect()
    }

    /// The step that breaks it: the one that goes beyond `most`, or for memory the first in which most is alive.
    pub(super) fn broken_by(self, plan: &Plan, most: f64) -> Option<usize> {
        if self == Bound::MemoryMib {
            let alive = alive(plan);
            return (0..alive.len()).rev().max_by_key(|at| alive[*at]);
        }
        let mut sum = 0.0;
        plan.steps.iter().position(|step| {
            sum += self.of_step(plan, step);
            sum > most
        })
    }

    fn of_step(self, plan: &Plan, step: &Step) -> f64 {
        let totals = Totals::count(std::slice::from_ref(step));
        let MovedBytes { loaded, stored, resolved, copied } = plan.moved_by(step);
        match self {
            Bound::Passes => totals.passes.into(),
            Bound::InsertedPasses => totals.inserted_passes.into(),
            Bound::Scopes => totals.scopes.into(),
            Bound::Resolves => totals.resolves.into(),
            Bound::Copies => totals.copies.into(),
            Bound::Barriers => f64::from(totals.image_barriers) + f64::from(totals.memory_barriers),
            Bound::BarrierCalls => totals.barrier_calls.into(),
            Bound::Waits => totals.waits.into(),
            Bound::MemoryMib | Bound::Hints(_) => 0.0,
            Bound::LoadedMib => loaded as f64 / MIB,
            Bound::StoredMib => stored as f64 / MIB,
            Bound::ResolvedMib => resolved as f64 / MIB,
            Bound::CopiedMib => copied as f64 / MIB,
            Bound::MovedMib => plan.moved_by(step).sum() as f64 / MIB,
        }
    }
}

/// Transient bytes that are alive at each step.
fn alive(plan: &Plan) -> Vec<u64> {
    let mut alive = vec![0_u64; plan.steps.len()];
    let roles = plan.images.iter().map(|image| &image.role).chain(plan.buffers.iter().map(|buffer| &buffer.role));
    for placement in roles.filter_map(Role::placement) {
        let [first, last] = placement.lifetime.map(|step| step.0 as usize);
        for at in alive.iter_mut().take(last + 1).skip(first) {
            *at = at.saturating_add(placement.bytes);
        }
    }
    alive
}
