//! Orders that keep little memory alive: the next run is always the one that adds fewest bytes. A run adds the bytes that begin to
//! live in it, less the bytes that end.
//!
//! The rule works in both directions: from the last run to the first, the last reader of a resource begins it. The choice
//! among equal runs matters much. A good one is the order that was found in the other direction, so the directions take
//! turns, and each ranks equal runs by their places in the order before.

use super::dependencies::Dependencies;
use super::memory::{Lifetimes, Memory, lists};
use super::runs::Runs;
use crate::compile::model::AdaptedFrame;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// How often the directions take turns.
const TURNS: u32 = 8;

/// The runs, their dependencies, and the memory that they use.
pub(super) struct GreedyOrder<'a> {
    runs: &'a Runs,
    memory: &'a Memory,
    /// The dependencies of the runs, from the first to the last and from the last to the first.
    forwards: Dependencies,
    backwards: Dependencies,
    /// For each resource the runs that use it, and for each run the resources: where each list starts, and the lists.
    users: (Vec<u32>, Vec<u32>),
    resources: (Vec<u32>, Vec<u32>),
}

impl<'a> GreedyOrder<'a> {
    pub(super) fn new(
        adapted: &AdaptedFrame,
        runs: &'a Runs,
        memory: &'a Memory,
        forwards: Dependencies,
    ) -> GreedyOrder<'a> {
        let mut uses: Vec<(u32, u32)> = Vec::with_capacity(adapted.uses.len());
        for run in 0..runs.len() {
            let used = runs.accesses(run).iter().map(|access| access.resource);
            uses.extend(used.filter(|resource| memory.bytes(*resource) > 0).map(|resource| (resource, run)));
        }
        uses.sort_unstable();
        uses.dedup();
        let users = lists(&uses, runs.resources() as u32);
        uses.iter_mut().for_each(|(resource, run)| std::mem::swap(resource, run));
        let resources = lists(&uses, runs.len());
        let backwards = forwards.reversed();
        GreedyOrder { runs, memory, forwards, backwards, users, resources }
    }

    /// The order that keeps the least memory alive at one time, among several and `others`.
    pub(super) fn best(&self, others: Vec<Vec<u32>>) -> Vec<u32> {
        let mut orders = others;
        orders.push(self.order(&self.forwards, levels_behind(&self.forwards)));
        orders.push(turned(self.order(&self.backwards, levels_behind(&self.backwards))));
        let mut order: Vec<u32> = (0..self.runs.len()).collect();
        for turn in 0..TURNS {
            order = match turn % 2 {
                0 => self.order(&self.forwards, ranks(order.iter().rev())),
                _ => turned(self.order(&self.backwards, ranks(order.iter()))),
            };
            orders.push(order.clone());
        }
        let peak = |order: &Vec<u32>| self.memory.peak(&Lifetimes::of(self.runs, order));
        orders.into_iter().min_by_key(peak).unwrap_or_default()
    }

    /// The order that always takes the run that adds fewest bytes, among all that may come next. Among equal runs it takes the one
    /// with the highest rank.
    fn order(&self, dependencies: &Dependencies, ranks: Vec<u32>) -> Vec<u32> {
        let count = self.runs.len() as usize;
        let mut queue = Queue {
            costs: vec![0; count],
            waits_for: dependencies.counts(),
            done: vec![false; count],
            ranks,
            heap: BinaryHeap::new(),
        };
        // For each resource, how many runs are still to use it, and the sum of their numbers. If one is left, the sum is its number.
        let mut remaining: Vec<(u32, u32)> = Vec::with_capacity(self.runs.resources());
        for resource in 0..self.runs.resources() as u32 {
            let (users, bytes) = (of(&self.users, resource), i128::from(self.memory.bytes(resource)));
            users.iter().for_each(|user| queue.costs[*user as usize] += bytes);
            if let [user] = users {
                queue.costs[*user as usize] -= bytes;
            }
            remaining.push((users.len() as u32, users.iter().fold(0, |sum, user| sum.wrapping_add(*user))));
        }
        (0..self.runs.len()).for_each(|run| queue.offer(run));
        let mut begun = vec![false; remaining.len()];
        let mut order = Vec::with_capacity(count);
        while let Some(run) = queue.next() {
            order.push(run);
            for resource in of(&self.resources, run) {
                let bytes = i128::from(self.memory.bytes(*resource));
                if !std::mem::replace(&mut begun[*resource as usize], true) {
                    of(&self.users, *resource).iter().for_each(|user| queue.cheaper(*user, bytes));
                }
                let (count, sum) = &mut remaining[*resource as usize];
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

/// One of several lists.
fn of(lists: &(Vec<u32>, Vec<u32>), at: u32) -> &[u32] {
    &lists.1[lists.0[at as usize] as usize..lists.0[at as usize + 1] as usize]
}

/// An order from its end.
fn turned(mut order: Vec<u32>) -> Vec<u32> {
    order.reverse();
    order
}

/// The place of each run in an order.
fn ranks<'o>(order: impl ExactSizeIterator<Item = &'o u32>) -> Vec<u32> {
    let mut ranks = vec![0; order.len()];
    order.zip(0..).for_each(|(run, place)| ranks[*run as usize] = place);
    ranks
}

/// Runs that may come next.
struct Queue {
    /// For each run the bytes that it begins less those that it ends.
    costs: Vec<i128>,
    waits_for: Vec<u32>,
    done: Vec<bool>,
    ranks: Vec<u32>,
    /// The cheapest first. Costs only fall, so that of several entries of one run the first that comes out is the right one.
    heap: BinaryHeap<(Reverse<i128>, u32, Reverse<u32>)>,
}

impl Queue {
    /// Enters a run, if it may come next.
    fn offer(&mut self, run: u32) {
        let at = run as usize;
        if self.waits_for[at] == 0 && !self.done[at] {
            self.heap.push((Reverse(self.costs[at]), self.ranks[at], Reverse(run)));
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
