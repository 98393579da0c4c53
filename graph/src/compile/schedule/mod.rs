//! `schedule`: the order in which operations run.
//!
//! An operation depends on an earlier one if both use a subresource and at least one of them writes it, or if both have
//! effects that nothing shows. Each order that keeps every operation behind those that it depends on is valid, and gives the
//! same picture. The default order is scored by these, the most important first:
//!
//! 1. *Merging* (`runs`): draws into the same attachments stand next to each other wherever that is valid. Sharing a
//!    rendering scope saves a store and a load of each attachment, which is more than any barrier costs.
//! 2. *Batching and overlap* (`levels`): an operation is one level above the highest that it depends on, and levels follow
//!    each other. All barriers between two levels fit into one call, no valid order has fewer such calls, and operations
//!    behind a barrier depend on nothing in their own level, so the device overlaps them. Only effects that nothing shows
//!    keep their order within a level: they take no barriers.
//! 3. *Memory*: an operation that begins more bytes than it ends moves up to the last level that leaves the number of levels
//!    as it is, and stands in its level behind operations that end bytes. If the largest number of bytes alive at one time is
//!    still more than a fiftieth above that of the file's order, the file's order stays.
//!
//! Ties keep the file's order.

mod accesses;
mod dependencies;
mod greedy;
mod levels;
mod memory;
mod runs;
mod weighed;

use super::model::Adapted;
use super::options::Order;
use dependencies::Dependencies;
use greedy::Greedy;
use memory::{Lifetimes, Memory};
use runs::Runs;
use weighed::Weighed;

/// An order, and the comparisons of bytes that decided it.
#[derive(Debug)]
pub(super) struct Scheduled {
    /// Indices into [`Adapted::ops`], in execution order.
    pub(super) order: Vec<u32>,
    weighed: Weighed,
}

/// Finds the order of execution. `keeps`: for [`Scheduled::still_holds`], later.
pub(super) fn schedule(adapted: &Adapted, order: Order, keeps: bool) -> Scheduled {
    let mut weighed = Weighed::default();
    let order = match order {
        Order::File => (0..adapted.ops.len() as u32).collect(),
        Order::Default => {
            let runs = Runs::gather(adapted);
            match scored(adapted, &runs, keeps.then_some(&mut weighed)) {
                Some(order) => runs.operations(order),
                None => runs.into_operations(),
            }
        }
        Order::LowMemory => {
            let runs = Runs::gather(adapted);
            let order = small(adapted, &runs);
            runs.operations(order)
        }
        Order::Random(seed) => Dependencies::between(&Runs::of_one(adapted)).random_order(seed),
    };
    Scheduled { order, weighed }
}

impl Scheduled {
    /// Whether the same operations on images and buffers of other sizes come in the same order.
    pub(super) fn still_holds(&self, adapted: &Adapted, order: Order) -> bool {
        match order {
            Order::File | Order::Random(_) => true,
            Order::Default => self.weighed.decide_the_same(|| Memory::of(adapted)),
            // Of which runs come next, whichever is cheapest: too many comparisons to keep.
            Order::LowMemory => schedule(adapted, order, false).order == self.order,
        }
    }
}

/// The runs in the order that scores best; `None`: as they are.
fn scored(adapted: &Adapted, runs: &Runs, mut keep: Option<&mut Weighed>) -> Option<Vec<u32>> {
    let levels = levels::levels(runs)?;
    let memory = Memory::of(adapted);
    let (order, in_file) = levels::by_level(runs, levels, &memory, keep.as_deref_mut());
    if order.iter().zip(0..).all(|(run, place)| *run == place) {
        return None;
    }
    let in_levels = Lifetimes::of(runs, &order);
    let takes_levels = weighed::takes_levels(&memory, &in_file, &in_levels);
    if let Some(weighed) = keep {
        weighed.took(in_file, in_levels, takes_levels);
    }
    takes_levels.then_some(order)
}

/// The runs in that of several orders in which the least memory is alive at one time.
fn small(adapted: &Adapted, runs: &Runs) -> Vec<u32> {
    let file: Vec<u32> = (0..runs.len()).collect();
    let scored = scored(adapted, runs, None).unwrap_or_else(|| file.clone());
    let memory = Memory::of(adapted);
    Greedy::new(adapted, runs, &memory, Dependencies::between(runs)).best(vec![file, scored])
}
