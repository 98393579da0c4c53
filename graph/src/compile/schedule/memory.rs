//! How much memory an order keeps alive, and an order that keeps little.

use super::dependencies::Dependencies;
use super::runs::Runs;
use crate::compile::model::{Adapted, Kind, StoreIndex};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Bytes of what lives in shared memory, as its texels say: alignments and padding are the device's, and not known here.
#[derive(Debug)]
pub(super) struct Memory {
    bytes: Vec<u64>,
}

/// When an order uses what.
#[derive(Debug)]
pub(super) struct Lifetimes {
    /// Number of places in the order.
    places: u32,
    /// For each store the first and the last place that use it.
    of: Vec<[u32; 2]>,
}

impl Lifetimes {
    /// In an order of runs.
    pub(super) fn of(adapted: &Adapted, runs: &Runs, order: &[u32]) -> Lifetimes {
        let mut of = vec![[u32::MAX, 0]; adapted.stores.len()];
        for (run, place) in order.iter().zip(0_u32..) {
            runs.for_each_use(adapted, *run, |used| {
                let [first, last] = &mut of[used.store as usize];
                (*first, *last) = (place.min(*first), place);
            });
        }
        Lifetimes { places: order.len() as u32, of }
    }
}

impl Memory {
    pub(super) fn of(adapted: &Adapted) -> Memory {
        let bytes = adapted.stores.iter().map(|store| match &store.kind {
            _ if !store.is_transient() => 0,
            Kind::Buffer(buffer) => buffer.bytes,
            Kind::Image(image) => {
                let sides = image.extent.iter().map(|side| u64::from(*side));
                let texels = sides.fold(u64::from(image.layers), u64::saturating_mul);
                // Each mip level takes a quarter of the one before it: a third together.
                let texels = if image.mips > 1 { texels.saturating_add(texels / 3) } else { texels };
                texels.saturating_mul(image.format.texel_bytes()).saturating_mul(u64::from(image.samples))
            }
        });
        Memory { bytes: bytes.collect() }
    }

    /// Bytes of one store, 0 if it has memory of its own.
    pub(super) fn bytes(&self, store: StoreIndex) -> u64 {
        self.bytes[store as usize]
    }

    /// The most bytes that are alive at one place of an order.
    pub(super) fn peak(&self, lifetimes: &Lifetimes) -> u64 {
        let mut changes = vec![0_i128; lifetimes.places as usize + 1];
        for ([first, last], bytes) in lifetimes.of.iter().zip(&self.bytes) {
            if *first != u32::MAX {
                changes[*first as usize] += i128::from(*bytes);
                changes[*last as usize + 1] -= i128::from(*bytes);
            }
        }
        let (mut alive, mut peak) = (0, 0);
        for change in changes {
            alive += change;
            peak = peak.max(alive);
        }
        u64::try_from(peak).unwrap_or(u64::MAX)
    }

    /// The order that takes, of all runs that may come next, one that begins fewest bytes less those that it ends; of equal
    /// ones that with the most levels behind it.
    ///
    /// It works in both directions: from the last run to the first, whatever reads a store last begins it.
    pub(super) fn greedy(&self, adapted: &Adapted, runs: &Runs, dependencies: &Dependencies) -> Vec<u32> {
        let mut uses: Vec<(u32, u32)> = Vec::with_capacity(adapted.uses.len());
        for run in 0..runs.len() {
            let used = runs.run(run).iter().flat_map(|op| adapted.uses(*op)).map(|used| used.store);
            uses.extend(used.filter(|store| self.bytes(*store) > 0).map(|store| (store, run)));
        }
        uses.sort_unstable();
        uses.dedup();
        let (users_at, users) = lists(&uses, self.bytes.len() as u32);
        uses.iter_mut().for_each(|(store, run)| std::mem::swap(store, run));
        let (stores_at, stores) = lists(&uses, runs.len());
        let within = |starts: &[u32], at: u32| starts[at as usize] as usize..starts[at as usize + 1] as usize;
        let mut queue = Queue {
            costs: vec![0; runs.len() as usize],
            waits_for: dependencies.counts(),
            done: vec![false; runs.len() as usize],
            levels: levels_behind(dependencies),
            heap: BinaryHeap::new(),
        };
        // For each store how many runs are still to use it, and the sum of their numbers: of one, it is its number.
        let mut remaining: Vec<(u32, u32)> = vec![(0, 0); self.bytes.len()];
        for (run, store) in &uses {
            let (count, sum) = &mut remaining[*store as usize];
            (*count, *sum) = (*count + 1, sum.wrapping_add(*run));
            queue.costs[*run as usize] += i128::from(self.bytes(*store));
        }
        for (store, (count, last)) in (0_u32..).zip(&remaining) {
            if *count == 1 {
                queue.costs[*last as usize] -= i128::from(self.bytes(store));
            }
        }
        (0..runs.len()).for_each(|run| queue.offer(run));
        let mut begun = vec![false; self.bytes.len()];
        let mut order = Vec::with_capacity(runs.len() as usize);
        while let Some(run) = queue.next() {
            order.push(run);
            for store in &stores[within(&stores_at, run)] {
                let bytes = i128::from(self.bytes(*store));
                if !std::mem::replace(&mut begun[*store as usize], true) {
                    users[within(&users_at, *store)].iter().for_each(|user| queue.cheaper(*user, bytes));
                }
                let (count, sum) = &mut remaining[*store as usize];
                (*count, *sum) = (*count - 1, sum.wrapping_sub(run));
                if *count == 1 {
                    queue.cheaper(*sum, bytes);
                }
            }
            for follower in dependencies.followers(run) {
                queue.waits_for[*follower as usize] -= 1;
                queue.offer(*follower);
            }
        }
        order
    }
}

/// Runs that may come next.
struct Queue {
    /// For each run the bytes that it begins less those that it ends.
    costs: Vec<i128>,
    waits_for: Vec<u32>,
    done: Vec<bool>,
    levels: Vec<u32>,
    /// The cheapest first. Costs only fall, so that of several entries of one run the first that comes out is the right one.
    heap: BinaryHeap<(Reverse<i128>, u32, Reverse<u32>)>,
}

impl Queue {
    /// Enters a run, if it may come next.
    fn offer(&mut self, run: u32) {
        let at = run as usize;
        if self.waits_for[at] == 0 && !self.done[at] {
            self.heap.push((Reverse(self.costs[at]), self.levels[at], Reverse(run)));
        }
    }

    fn cheaper(&mut self, run: u32, bytes: i128) {
        self.costs[run as usize] -= bytes;
        self.offer(run);
    }

    fn next(&mut self) -> Option<u32> {
        loop {
            let (_, _, Reverse(run)) = self.heap.pop()?;
            if !std::mem::replace(&mut self.done[run as usize], true) {
                return Some(run);
            }
        }
    }
}

/// For each run the number of levels that follow it.
fn levels_behind(dependencies: &Dependencies) -> Vec<u32> {
    let mut waits_for = dependencies.counts();
    let mut order: Vec<u32> = (0..dependencies.len()).filter(|run| waits_for[*run as usize] == 0).collect();
    let mut at = 0;
    while let Some(run) = order.get(at).copied() {
        at += 1;
        for follower in dependencies.followers(run) {
            waits_for[*follower as usize] -= 1;
            if waits_for[*follower as usize] == 0 {
                order.push(*follower);
            }
        }
    }
    let mut levels = vec![0; order.len()];
    for run in order.into_iter().rev() {
        let followers = dependencies.followers(run).iter();
        levels[run as usize] = followers.map(|follower| levels[*follower as usize] + 1).max().unwrap_or(0);
    }
    levels
}

/// For each first number of `pairs`, all below `count`, the second ones: where each list starts, and the lists.
pub(super) fn lists(pairs: &[(u32, u32)], count: u32) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; count as usize + 1];
    pairs.iter().for_each(|(first, _)| starts[*first as usize] += 1);
    let mut end = 0;
    for start in &mut starts {
        end += *start;
        *start = end;
    }
    let mut lists = vec![0; pairs.len()];
    for (first, second) in pairs.iter().rev() {
        starts[*first as usize] -= 1;
        lists[starts[*first as usize] as usize] = *second;
    }
    (starts, lists)
}
