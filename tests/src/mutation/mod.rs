//! Plans with one mistake each, and who notices.
//!
//! Every mistake of the kinds in [`Kind`] is planted in a Plan, one at a time. Either `verify` reports it, or the
//! brute-force judge ([`crate::happens_before`]) shows that it does no harm; a mistake that harms and isn't reported is
//! *missed*.

mod edits;

use crate::happens_before::{Harm, Verdict, judge};
use framewright_graph::plan::{Plan, Totals};
use framewright_graph::verify::verify;
use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

/// A change of a Plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// An image barrier is left out.
    ImageBarrierDropped,
    /// A memory barrier is left out.
    MemoryBarrierDropped,
    /// One stage is taken out of a barrier's mask.
    StageDropped,
    /// One access is taken out of a barrier's mask.
    AccessDropped,
    /// The old or the new layout of a barrier is another one.
    LayoutChanged,
    /// The work of a step names an image in another layout.
    UsedInOtherLayout,
    /// A barrier leaves out one mip level, layer or plane.
    RangeShrunk,
    /// A transient image or buffer is placed on another one that lives at the same time.
    AllocationShifted,
    /// An attachment is no longer loaded or cleared.
    LoadLost,
    /// An attachment is no longer stored.
    StoreLost,
    /// A resolve is left out.
    ResolveDropped,
    /// A resolve runs before what it resolves is drawn.
    ResolveMoved,
    /// A wait for another queue is left out.
    WaitDropped,
    /// One stage is taken out of a wait, or it waits for the frame before.
    WaitWeakened,
    /// An image isn't released to the queue that takes it over.
    ReleaseDropped,
    /// A by-region barrier within a rendering scope is left out.
    LocalBarrierDropped,
}

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 16] = [
        Kind::ImageBarrierDropped,
        Kind::MemoryBarrierDropped,
        Kind::StageDropped,
        Kind::AccessDropped,
        Kind::LayoutChanged,
        Kind::UsedInOtherLayout,
        Kind::RangeShrunk,
        Kind::AllocationShifted,
        Kind::LoadLost,
        Kind::StoreLost,
        Kind::ResolveDropped,
        Kind::ResolveMoved,
        Kind::WaitDropped,
        Kind::WaitWeakened,
        Kind::ReleaseDropped,
        Kind::LocalBarrierDropped,
    ];
}

/// A Plan with a mistake.
#[derive(Debug, Clone)]
pub struct Mutant {
    /// The kind of mistake.
    pub kind: Kind,
    /// Its place.
    pub change: String,
    /// The Plan.
    pub plan: Plan,
}

/// Every mutant of `plan`, made one after the other. Sums are counted anew: a wrong sum gives none of them away.
pub fn mutants(plan: &Plan) -> impl Iterator<Item = Mutant> + '_ {
    edits::all(plan).into_iter().map(|edit| {
        let mut mutant = plan.clone();
        (edit.apply)(&mut mutant);
        let bytes = mutant.totals;
        mutant.totals = Totals {
            transient_bytes: bytes.transient_bytes,
            placed_bytes: mutant.heaps.iter().map(|heap| heap.bytes).sum(),
            live_peak_bytes: bytes.live_peak_bytes,
            kept_bytes: bytes.kept_bytes,
            ..Totals::count(&mutant.steps)
        };
        Mutant { kind: edit.kind, change: edit.change, plan: mutant }
    })
}

/// Who noticed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Noticed {
    /// `verify` reports the mutant.
    Caught,
    /// Nobody could see the difference: no hazard, no wrong layout, nothing undefined is read, the same outcome.
    Harmless,
    /// The mutant does harm, and `verify` says nothing.
    Missed(Vec<Harm>),
}

/// Shows a mutant to `verify`, and if that has nothing to say, to the judge. `original` is the verdict on the Plan without
/// the mistake.
#[must_use]
pub fn shown(mutant: &Plan, original: &Verdict) -> Noticed {
    if !verify(mutant).is_empty() {
        return Noticed::Caught;
    }
    let mut verdict = judge(mutant);
    if verdict.harms.is_empty() && verdict.outcome != original.outcome {
        verdict.harms.push(Harm::Wrong("what leaves the frame is not what it was".to_owned()));
    }
    if verdict.harms.is_empty() { Noticed::Harmless } else { Noticed::Missed(verdict.harms) }
}

/// How many mutants of each kind were caught, were harmless, were missed.
#[derive(Debug, Default)]
pub struct Tally {
    counts: BTreeMap<Kind, [usize; 3]>,
    /// Mistakes that were missed, with their Plan and their harm.
    pub missed: Vec<String>,
    /// Mistakes that do no harm.
    pub harmless: Vec<(Kind, String)>,
}

impl Tally {
    /// Plants every mistake in a Plan and counts who notices.
    ///
    /// # Panics
    /// If the Plan itself harms or is reported.
    pub fn add(&mut self, name: &str, plan: &Plan) {
        assert_eq!(verify(plan), [], "{name}\n{}", plan.tree());
        let original = judge(plan);
        assert_eq!(original.harms, [], "{name}\n{}", plan.tree());
        for mutant in mutants(plan) {
            let counts = self.counts.entry(mutant.kind).or_default();
            match shown(&mutant.plan, &original) {
                Noticed::Caught => counts[0] += 1,
                Noticed::Harmless => {
                    counts[1] += 1;
                    self.harmless.push((mutant.kind, format!("{name}: {}", mutant.change)));
                }
                Noticed::Missed(harms) => {
                    counts[2] += 1;
                    self.missed.push(format!("{name}: {:?} {}: {:?}", mutant.kind, mutant.change, harms[0]));
                }
            }
        }
    }

    /// How many of a kind were caught, were harmless, were missed.
    #[must_use]
    pub fn of(&self, kind: Kind) -> [usize; 3] {
        self.counts.get(&kind).copied().unwrap_or_default()
    }

    /// Harmless ones of each kind that has any.
    #[must_use]
    pub fn harmless_counts(&self) -> Vec<(Kind, usize)> {
        self.counts.iter().filter(|(_, counts)| counts[1] > 0).map(|(kind, counts)| (*kind, counts[1])).collect()
    }
}

impl Display for Tally {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<22}{:>9}{:>10}{:>8}", "kind", "caught", "harmless", "missed")?;
        for (kind, [caught, harmless, missed]) in &self.counts {
            writeln!(f, "{:<22}{caught:>9}{harmless:>10}{missed:>8}", format!("{kind:?}"))?;
        }
        let sum = |at: usize| self.counts.values().map(|counts| counts[at]).sum::<usize>();
        writeln!(f, "{:<22}{:>9}{:>10}{:>8}", "all", sum(0), sum(1), sum(2))
    }
}
