//! Draws that may share a rendering scope are brought together, and from then on stay together.

use super::accesses::{Access, Accesses};
use crate::compile::access_chain::AccessChain;
use crate::compile::model::{AdaptedFrame, InitialContents, PhysicalIndex, Role, Use};

/// Operations in an order that is valid, in runs: draws into the same attachments, or one operation.
#[derive(Debug)]
pub(super) struct Runs {
    /// Empty, as `starts` is, if the runs were made by [`Runs::of_one`].
    ops: Vec<u32>,
    /// For each run its first place in `ops`, and where the last one ends.
    starts: Vec<u32>,
    /// The accesses of the operations, by place.
    accesses: Accesses,
}

impl Runs {
    /// Each operation by itself, in the order of the frame.
    pub(super) fn of_one(adapted: &AdaptedFrame) -> Runs {
        Runs { ops: Vec::new(), starts: Vec::new(), accesses: Accesses::of(adapted) }
    }

    /// Draws that may share a scope in one run.
    pub(super) fn gather(adapted: &AdaptedFrame) -> Runs {
        if !adapted.ops.iter().any(|op| op.kind.draws()) {
            return Runs::of_one(adapted);
        }
        let accesses = &Accesses::of(adapted);
        let mut gatherer = Gatherer {
            adapted,
            accesses,
            runs: Vec::new(),
            run_of: Vec::with_capacity(adapted.ops.len()),
            chains: vec![AccessChain::new(); accesses.subresources],
            places: 0,
        };
        for op in 0..adapted.ops.len() as u32 {
            gatherer.op(op);
        }
        let Gatherer { runs, run_of, .. } = gatherer;
        let place = |op: &u32| runs[run_of[*op as usize] as usize].place;
        let mut ops: Vec<u32> = (0..adapted.ops.len() as u32).collect();
        ops.sort_by_key(place);
        let mut starts: Vec<u32> = vec![0];
        starts.extend((1..ops.len()).filter(|at| place(&ops[at - 1]) != place(&ops[*at])).map(|at| at as u32));
        starts.push(ops.len() as u32);
        let accesses = accesses.in_order(&ops);
        Runs { ops, starts, accesses }
    }

    pub(super) fn len(&self) -> u32 {
        if self.starts.is_empty() { self.accesses.ops() } else { self.starts.len() as u32 - 1 }
    }

    /// Number of subresources.
    pub(super) fn subresources(&self) -> usize {
        self.accesses.subresources
    }

    /// The resource that accesses name which begin no use.
    pub(super) fn no_resource(&self) -> PhysicalIndex {
        self.accesses.no_resource
    }

    /// Number of resources that accesses name, with the one that stands for none.
    pub(super) fn resources(&self) -> usize {
        self.no_resource() as usize + 1
    }

    /// Whether any of them has an effect that nothing shows.
    pub(super) fn has_effects(&self) -> bool {
        self.accesses.has_effects
    }

    /// The first place of one run, and the place behind its last one.
    #[inline]
    fn places(&self, run: u32) -> [u32; 2] {
        if self.starts.is_empty() {
            return [run, run + 1];
        }
        [self.starts[run as usize], self.starts[run as usize + 1]]
    }

    /// The accesses of one run.
    #[inline]
    pub(super) fn accesses(&self, run: u32) -> &[Access] {
        let [first, end] = self.places(run);
        self.accesses.between(first, end)
    }

    /// Calls `visit` with the accesses of one run, from its last operation to the first.
    #[inline]
    pub(super) fn for_each_backwards(&self, run: u32, mut visit: impl FnMut(&Access)) {
        if self.starts.is_empty() {
            return self.accesses.op(run).iter().for_each(visit);
        }
        let [first, end] = self.places(run);
        (first..end).rev().for_each(|place| self.accesses.op(place).iter().for_each(&mut visit));
    }

    /// The operations of all runs.
    pub(super) fn into_operations(self) -> Vec<u32> {
        if self.starts.is_empty() { (0..self.len()).collect() } else { self.ops }
    }

    /// The operations of all runs, in the given order of runs.
    pub(super) fn operations(&self, order: Vec<u32>) -> Vec<u32> {
        if self.starts.is_empty() {
            return order;
        }
        let mut ops = Vec::with_capacity(self.ops.len());
        for run in order {
            let [first, end] = self.places(run);
            ops.extend_from_slice(&self.ops[first as usize..end as usize]);
        }
        ops
    }
}

/// A run so far.
#[derive(Debug)]
struct Run {
    /// Runs are put in the order of their places.
    place: u32,
    /// Whether another run has to come behind it, or might.
    fixed: bool,
    last: u32,
}

struct Gatherer<'a> {
    adapted: &'a AdaptedFrame,
    accesses: &'a Accesses,
    runs: Vec<Run>,
    run_of: Vec<u32>,
    /// For each subresource the runs of its last accesses. If several runs read it, the rearmost stands for all.
    chains: Vec<AccessChain<Option<u32>>>,
    places: u32,
}

impl Gatherer<'_> {
    fn op(&mut self, op: u32) {
        let Gatherer { adapted, accesses, runs, chains, .. } = self;
        let candidate = candidate(adapted, chains, op).filter(|run| meet(adapted, runs[*run as usize].last, op));
        // The place of the rearmost run that it depends on besides the candidate.
        let mut behind = None;
        for Access { subresource, writes, layout, .. } in accesses.op(op) {
            let before = chains[*subresource as usize].behind(*writes, *layout).into_iter().flatten();
            for run in before.filter(|run| Some(*run) != candidate) {
                runs[run as usize].fixed = true;
                behind = behind.max(Some(runs[run as usize].place));
            }
        }
        let joined = candidate.filter(|candidate| {
            let run = &mut runs[*candidate as usize];
            if behind > Some(run.place) && !run.fixed {
                // Nothing depends on the run yet: all of it moves behind the runs that this operation waits for.
                run.place = self.places;
                self.places += 1;
            }
            behind < Some(run.place)
        });
        let run = joined.unwrap_or_else(|| {
            if let Some(candidate) = candidate {
                runs[candidate as usize].fixed = true;
            }
            runs.push(Run { place: self.places, fixed: false, last: op });
            self.places += 1;
            runs.len() as u32 - 1
        });
        runs[run as usize].last = op;
        self.run_of.push(run);
        for Access { subresource, writes, layout, .. } in accesses.op(op) {
            chains[*subresource as usize].add(*writes, *layout, |reader| match reader {
                Some(reader) if reader != run => Some(rearmost(runs, reader, run)),
                _ => Some(run),
            });
        }
    }
}

/// The rearmost of two runs that read a subresource. Only this one is known from here on, so none of them may move any more.
fn rearmost(runs: &mut [Run], one: u32, other: u32) -> u32 {
    runs[one as usize].fixed = true;
    runs[other as usize].fixed = true;
    if runs[other as usize].place > runs[one as usize].place { other } else { one }
}

/// The run whose last write an operation draws on top of.
fn candidate(adapted: &AdaptedFrame, chains: &[AccessChain<Option<u32>>], op: u32) -> Option<u32> {
    if !adapted.ops[op as usize].kind.draws() {
        return None;
    }
    let uses = adapted.uses(op);
    let attached = |used: &&Use| used.role.is_attachment();
    let run_before = |used: &Use| {
        let mut run = None;
        adapted.for_each_subresource(used, |subresource| run = chains[subresource as usize].before());
        run
    };
    let run = run_before(uses.iter().find(attached)?)?;
    // A scope neither clears nor samples its own drawing.
    let forbids = |used: &Use| !used.role.is_attachment() || used.contents != InitialContents::Keep;
    let apart = uses.iter().any(|used| forbids(used) && run_before(used) == Some(run));
    (!apart).then_some(run)
}

/// Whether two draws run in the same frames and have the same colour attachments, and depth and stencil attachments where both have them.
fn meet(adapted: &AdaptedFrame, one: u32, other: u32) -> bool {
    let all = |op, role| {
        let uses = adapted.uses(op).iter().filter(move |used| used.role == role);
        uses.map(|used| (used.resource, adapted.range(used)))
    };
    let same = |role| match (all(one, role).next(), all(other, role).next()) {
        (Some(one), Some(other)) => one == other,
        _ => true,
    };
    let draws = adapted.ops[one as usize].kind.draws();
    let draws = draws && adapted.cadence(one) == adapted.cadence(other);
    draws && all(one, Role::Color).eq(all(other, Role::Color)) && same(Role::Depth) && same(Role::Stencil)
}
