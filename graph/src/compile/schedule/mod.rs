//! `schedule`: the order in which operations run.
//!
//! An operation depends on an earlier one if both use a subresource and at least one of them writes it, or if both have
//! effects that nothing shows. An order is valid if it keeps every operation behind all that it depends on. All valid
//! orders give the same picture. The default order is scored by these, the most important first:
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
mod greedy_order;
mod levels;
mod memory;
mod runs;

use super::model::AdaptedFrame;
use super::options::Order;
use dependencies::Dependencies;
use greedy_order::GreedyOrder;
use memory::{Lifetimes, Memory};
use runs::Runs;

/// Finds the order of execution: indices into [`AdaptedFrame::ops`].
pub(super) fn schedule(adapted: &AdaptedFrame, order: Order) -> Vec<u32> {
    match order {
        Order::File => (0..adapted.ops.len() as u32).collect(),
        Order::Default => {
            let runs = Runs::gather(adapted);
            match scored(adapted, &runs) {
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
    }
}

/// The runs in the order that scores best; `None`: as they are.
fn scored(adapted: &AdaptedFrame, runs: &Runs) -> Option<Vec<u32>> {
    let levels = levels::levels(runs)?;
    let memory = Memory::of(adapted);
    let (order, in_file) = levels::by_level(runs, levels, &memory);
    if order.iter().zip(0..).all(|(run, place)| *run == place) {
        return None;
    }
    let peak = memory.peak(&in_file);
    let most = peak.saturating_add(peak / 50);
    (memory.peak(&Lifetimes::of(runs, &order)) <= most).then_some(order)
}

/// The runs in that of several orders in which the least memory is alive at one time.
fn small(adapted: &AdaptedFrame, runs: &Runs) -> Vec<u32> {
    let file: Vec<u32> = (0..runs.len()).collect();
    let scored = scored(adapted, runs).unwrap_or_else(|| file.clone());
    let memory = Memory::of(adapted);
    GreedyOrder::new(adapted, runs, &memory, Dependencies::between(runs)).best(vec![file, scored])
}
