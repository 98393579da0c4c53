//! What crosses frames where several queues are used: memory that is taken over, and what persists.

use super::{QUEUES, Queues, Seen};
use crate::compile::hand_over::HandOver;
use crate::compile::last_uses::LastUses;
use crate::compile::model::{Adapted, CellIndex, Kind, StoreIndex};
use crate::compile::outlive::{States, cells, last_of_cycle, of_all_planes};
use crate::compile::parts::Grids;
use crate::compile::synchronise::{NEVER, Pending, Walked};
use crate::vulkan::{Accesses, Layout, Stages, State};

/// A step that comes after a step of another queue, in this frame or so many frames ago.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub(super) step: u32,
    pub(super) queue: usize,
    pub(super) of: u32,
    pub(super) frames_ago: u32,
}

/// The state in which something is left that several queues use: semaphores alone lead on from it.
const fn somehow(layout: Layout) -> State {
    State { stages: Stages::empty(), accesses: Accesses::empty(), layout }
}

/// The states of stores that several queues use and that become each other from `first` on; the last of them.
pub(in crate::compile) fn promise(
    grids: &Grids,
    adapted: &Adapted,
    walked: &mut Walked,
    first: StoreIndex,
    export: u32,
    states: &mut [Option<States>],
) -> StoreIndex {
    let last = last_of_cycle(adapted, first);
    let count = (last - first + 1) as usize;
    // Going around twice, whoever is touched by nothing learns what the touched one before it is left in.
    let mut left = vec![Layout::General; count];
    let mut known = Layout::General;
    for at in (0..count).chain(0..count) {
        let store = &adapted.stores[first as usize + at];
        let touched = cells(grids, store).map(|cell| walked.cells[cell as usize]);
        let latest = touched.filter(|cell| cell.is_touched()).max_by_key(|cell| cell.last);
        known = latest.map_or(known, |cell| of_all_planes(store, cell.layout));
        left[at] = known;
    }
    for (store, at) in (first..=last).zip(0..) {
        let before = left[(at + count - 1) % count];
        for cell in cells(grids, &adapted.stores[store as usize]) {
            let known = walked.cells[cell as usize];
            let layout = if known.is_touched() { known.layout } else { before };
            if layout != left[at] {
                let (stages, accesses) = (Stages::ALL_COMMANDS, Accesses::MEMORY_READ);
                let read = State { stages, accesses, layout: left[at] };
                walked.promise(store, cell, export, read);
            }
        }
        states[store as usize] = Some(States { before: somehow(before), after: somehow(left[at]) });
    }
    last
}

/// Finds out what the first uses of a store that several queues use wait for: what earlier frames did to it last.
pub(in crate::compile) fn find(
    grids: &Grids,
    adapted: &Adapted,
    walked: &mut Walked,
    store: StoreIndex,
    states: &States,
) {
    let Some(mut queues) = walked.queues.take() else { return };
    let described = &adapted.stores[store as usize];
    for cell in cells(grids, described) {
        let Some(barrier) = walked.barriers.get_mut(walked.cells[cell as usize].first_barrier as usize) else {
            continue;
        };
        let (frames_ago, seen) = before(adapted, &walked.cells, &queues, store, cell - described.first_cell);
        let queue = queues.at(barrier.step);
        for (other, seen) in seen.iter().enumerate().filter(|(other, seen)| *other != queue && seen.until > 0) {
            queues.require_earlier(barrier.step, other, seen.until - 1, frames_ago);
        }
        // What the queue did itself may be known to be done to whomever it waits for.
        let until = seen[queue].until;
        let knows = |(other, seen): (usize, &Seen)| {
            other != queue && seen.until > 0 && queues.clocks.signal(seen.until - 1)[queue] >= until
        };
        let own = if seen.iter().enumerate().any(knows) { Seen::default() } else { seen[queue] };
        (barrier.src_stages, barrier.src_accesses) = (own.stages, own.accesses.writes());
        if barrier.keeps {
            barrier.old_layout = states.before.layout;
        }
        queues.hold(walked.cells[cell as usize].first_barrier);
        if own.until == 0 && barrier.old_layout == barrier.new_layout {
            barrier.step = NEVER;
        }
    }
    walked.queues = Some(queues);
}

/// How a part was used in the last frame that did, and how many frames ago that was.
fn before(
    adapted: &Adapted,
    known: &[crate::compile::synchronise::Cell],
    queues: &Queues,
    store: StoreIndex,
    part: u32,
) -> (u32, [Seen; QUEUES]) {
    let first = (0..=store).rev().take_while(|first| last_of_cycle(adapted, *first) >= store).last().unwrap_or(store);
    let last = last_of_cycle(adapted, first);
    let mut from = store;
    for frames_ago in 1..=last - first + 1 {
        from = if from == first { last } else { from - 1 };
        let cell = adapted.stores[from as usize].first_cell + part;
        if known[cell as usize].is_touched() {
            return (frames_ago, queues.track(cell).by);
        }
    }
    (1, [Seen::default(); QUEUES])
}

/// How the queues used a cell last.
fn seen(adapted: &Adapted, walked: &Walked, queues: &Queues, store: StoreIndex, cell: CellIndex) -> [Seen; QUEUES] {
    debug_assert!(adapted.stores[store as usize].first_cell <= cell);
    if queues.is_crossed(store) {
        return queues.track(cell).by;
    }
    let known = &walked.cells[cell as usize];
    let mut by = [Seen::default(); QUEUES];
    by[queues.at(known.last)] =
        Seen { stages: known.stages, accesses: known.accesses, until: known.last + 1, barrier: None };
    by
}

/// `store` takes bytes of `from`, in this frame or from the frame before.
pub(in crate::compile) fn take(
    grids: &Grids,
    adapted: &Adapted,
    walked: &mut Walked,
    [from, store]: [StoreIndex; 2],
    this_frame: bool,
    hand_overs: &mut Vec<HandOver>,
) {
    let Some(mut queues) = walked.queues.take() else { return };
    let (taker, holder) = (&adapted.stores[store as usize], &adapted.stores[from as usize]);
    let touched = |cell: &CellIndex| walked.cells[*cell as usize].is_touched();
    let last_uses = |held: &mut dyn Iterator<Item = CellIndex>| {
        let mut uses: [LastUses; QUEUES] = Default::default();
        for held in held {
            for (uses, seen) in uses.iter_mut().zip(seen(adapted, walked, &queues, from, held)) {
                if seen.until > 0 {
                    uses.add(seen.stages, seen.accesses, seen.until - 1);
                }
            }
        }
        uses
    };
    // Each part of what takes its own memory again waits for what was done to itself.
    let all = if store == from { Vec::new() } else { vec![last_uses(&mut cells(grids, holder).filter(touched))] };
    let own = |cell| last_uses(&mut std::iter::once(cell).filter(touched));
    let taken: Vec<_> =
        cells(grids, taker).map(|cell| (cell, all.first().cloned().unwrap_or_else(|| own(cell)))).collect();
    for (cell, uses) in taken {
        let first = walked.cells[cell as usize].first_barrier;
        let Some(barrier) = walked.barriers.get_mut(first as usize) else { continue };
        let queue = queues.at(barrier.step);
        for (other, last) in (0..).zip(&uses).flat_map(|(other, uses)| uses.iter().map(move |last| (other, last))) {
            if this_frame {
                barrier.after = if barrier.after == NEVER { last.last } else { barrier.after.max(last.last) };
            }
            if other != queue {
                queues.require_earlier(barrier.step, other, last.last, u32::from(!this_frame));
                queues.hold(first);
                continue;
            }
            barrier.src_stages |= last.stages;
            if last.writes.is_empty() {
                continue;
            }
            if taker.image().is_none() || store == from {
                barrier.src_accesses |= last.writes;
            } else {
                let (write, written) = ((last.stages, last.writes), last.last);
                hand_overs.push(HandOver { stores: [from, store], write, written, this_frame, barrier: first });
            }
        }
    }
    walked.queues = Some(queues);
}

/// Adds the waits that what crosses frames takes, and lets barriers behind waits come after them.
pub(in crate::compile) fn finish(adapted: &Adapted, walked: &mut Walked) {
    let Walked { queues: Some(queues), barriers, .. } = walked else { return };
    for (barrier, number) in barriers.iter_mut().zip(0..).filter(|(barrier, _)| barrier.src_stages.is_empty()) {
        if queues.is_held(number) {
            chain(adapted, barrier);
        }
    }
    queues.finish();
}

/// A barrier without a first scope wouldn't come after the semaphore that its step waits for: it names the stages that it
/// holds up, which the wait holds up too. A buffer takes no barrier beside the wait.
fn chain(adapted: &Adapted, barrier: &mut Pending) {
    match adapted.stores[barrier.store as usize].kind {
        Kind::Image(_) => barrier.src_stages = barrier.dst_stages,
        Kind::Buffer(_) => barrier.step = NEVER,
    }
}

impl Queues {
    fn finish(&mut self) {
        let steps = self.of.len() as u32;
        if self.clocks.len() <= steps {
            self.require(steps, super::Steps::default());
        }
        self.edges.sort_unstable_by_key(|edge| (edge.frames_ago, edge.step, edge.queue, edge.of));
        let queues: Vec<usize> = (0..=steps).map(|step| self.at(step)).collect();
        let edges = std::mem::take(&mut self.edges);
        for same in edges.chunk_by(|one, other| one.frames_ago == other.frames_ago) {
            let required: Vec<(u32, usize, u32)> = same.iter().map(|edge| (edge.step, edge.queue, edge.of)).collect();
            let Some(first) = same.first().filter(|first| first.frames_ago > 0) else { continue };
            self.clocks.require_earlier(&queues, &required, first.frames_ago);
        }
    }
}
