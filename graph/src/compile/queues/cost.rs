//! The cost model: whether steps gain by leaving the graphics queue.
//!
//! A frame doesn't say how long its passes take. The bytes that a step reads and writes stand for its time, and a wait for as
//! many bytes as the device's profile says ([`wait_bytes`](crate::device::Queues::wait_bytes)).
//!
//! - Steps of one queue follow each other. Neighbours that can begin and have to end between the same graphics steps are a run:
//!   all of them need the same waits.
//! - A run takes one wait for its beginning, unless the run before it begins there too, and one for its end, unless the run
//!   behind it ends there too.
//! - It saves at most the work that goes on side by side: its own, or that of the graphics steps beside it, if that is less.
//!   What one run has beside it, the next run of its queue doesn't have.

use super::step_uses::uses_of;
use crate::compile::model::AdaptedFrame;
use crate::compile::scope::Step;
use crate::plan::Queue;

/// The work of all steps.
pub(super) struct Work {
    /// Bytes that each step reads and writes.
    of: Vec<u64>,
    /// The graphics steps that may have others beside them.
    graphics: Vec<u32>,
    /// For each step, and behind all of them: how many of those stand before it, and their work.
    before: Vec<(u32, u64)>,
    /// What a wait costs.
    wait: u64,
}

/// Work that can go on side by side.
#[derive(Debug, Clone, Copy)]
pub(super) struct Overlap {
    pub(super) bytes: u64,
    /// The first graphics step of it, and how many more there are.
    pub(super) beside: Option<(u32, u32)>,
}

/// What a step's run would save on its queue, and what its waits would cost.
#[derive(Debug, Clone, Copy)]
pub(super) struct Balance {
    /// Number of steps.
    pub(super) steps: u32,
    pub(super) waits: u32,
    pub(super) cost: u64,
    /// What it saves beside the other runs of its queue.
    pub(super) saved: Overlap,
    /// What it would save if nothing but the window of this one of its steps held it back.
    pub(super) alone: Overlap,
}

impl Balance {
    pub(super) fn gains(&self) -> bool {
        self.saved.bytes > self.cost
    }

    /// Whether it wouldn't gain even if nothing but its own window held it back: as far as its run goes now.
    pub(super) fn is_hopeless(&self) -> bool {
        self.alone.bytes <= self.cost
    }
}

impl Work {
    /// `beside`: whether a step is one of the graphics steps that may have others beside them.
    pub(super) fn new(adapted: &AdaptedFrame, steps: &[Step], beside: impl Fn(u32) -> bool, wait: u64) -> Work {
        let of: Vec<u64> = steps.iter().map(|step| work(adapted, step)).collect();
        let graphics: Vec<u32> = (0..of.len() as u32).filter(|step| beside(*step) && of[*step as usize] > 0).collect();
        let mut before = Vec::with_capacity(of.len() + 1);
        let (mut steps, mut bytes) = (0, 0_u64);
        for (at, work) in (0..).zip(&of) {
            before.push((steps, bytes));
            if graphics.get(steps as usize) == Some(&at) {
                (steps, bytes) = (steps + 1, bytes.saturating_add(*work));
            }
        }
        before.push((steps, bytes));
        Work { of, graphics, before, wait }
    }

    /// The balance of each step's run; `None` of steps on graphics. `windows`: the graphics steps that can run beside each.
    pub(super) fn balances(&self, queues: &[Queue], windows: &[[u32; 2]]) -> Vec<Option<Balance>> {
        let mut balances = vec![None; queues.len()];
        for queue in [Queue::Compute, Queue::Transfer] {
            let mut run_of: Vec<(u32, [u32; 2])> = (0..).zip(windows).map(|(at, window)| (at, *window)).collect();
            run_of.retain(|(step, _)| queues[*step as usize] == queue);
            follow_each_other(&mut run_of);
            let runs: Vec<_> = run_of.chunk_by(|(_, one), (_, other)| one == other).collect();
            let mut taken = 0;
            for (at, run) in runs.iter().enumerate() {
                let [from, to] = run[0].1;
                let begins = at.checked_sub(1).is_none_or(|before| runs[before][0].1[0] < from);
                let ends = runs.get(at + 1).is_none_or(|next| to < next[0].1[1]);
                let waits = u32::from(begins) + u32::from(ends);
                let own = run.iter().map(|(step, _)| self.of[*step as usize]).fold(0, u64::saturating_add);
                let saved = self.overlap(own, [from, to], taken);
                taken = taken.max(self.before[from as usize].1).saturating_add(saved.bytes);
                let (steps, cost) = (run.len() as u32, u64::from(waits).saturating_mul(self.wait));
                for (step, _) in *run {
                    let alone = self.overlap(own, windows[*step as usize], 0);
                    balances[*step as usize] = Some(Balance { steps, waits, cost, saved, alone });
                }
            }
        }
        balances
    }

    /// The time that is saved by running `own` bytes beside a window of graphics steps. `taken` bytes of it, from the first graphics
    /// step on, are in use.
    fn overlap(&self, own: u64, [from, to]: [u32; 2], taken: u64) -> Overlap {
        let [(first, start), (last, end)] = [from, to.max(from)].map(|step| self.before[step as usize]);
        let beside = (last > first).then(|| (self.graphics[first as usize], last - first - 1));
        Overlap { bytes: own.min(end.saturating_sub(start.max(taken))), beside }
    }
}

/// Steps of one queue follow each other: none begins before the one before it can begin, and each has to end before the one
/// behind it has to end.
fn follow_each_other(steps: &mut [(u32, [u32; 2])]) {
    let mut latest = 0;
    for (_, [from, _]) in steps.iter_mut() {
        latest = latest.max(*from);
        *from = latest;
    }
    let mut earliest = u32::MAX;
    for (_, [_, to]) in steps.iter_mut().rev() {
        earliest = earliest.min(*to);
        *to = earliest;
    }
}

/// Bytes that a step reads and writes. Images whose size changes count as allocated, so that no other size moves a step to another
/// queue. An attachment counts once, however many passes of the scope draw into it.
fn work(adapted: &AdaptedFrame, step: &Step) -> u64 {
    let attachments = if let Step::Scope(scope) = step { Some(scope.targets()) } else { None };
    let attachments = attachments.into_iter().flatten().map(|target| adapted.most_bytes(target.resource, target.range));
    let in_memory = uses_of(adapted, step).filter(|used| !used.role.is_attachment() && !used.role.is_input());
    let others = in_memory.map(|used| {
        let times = u64::from(used.reads) + u64::from(used.writes);
        adapted.most_bytes(used.resource, adapted.range(used)).saturating_mul(times)
    });
    attachments.chain(others).fold(0, u64::saturating_add)
}
