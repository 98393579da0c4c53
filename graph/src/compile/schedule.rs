//! `schedule`: the order in which operations run. The order of the file is legal by construction, and is kept.

use super::Order;
use super::model::Adapted;
use super::parts::Grids;

/// Indices into [`Adapted::ops`], in execution order.
///
/// An operation depends on an earlier one if both use a cell ([`Adapted::for_each_cell`]) and at least one of them writes it.
/// Every order that keeps each operation behind those that it depends on is legal.
pub(super) fn schedule(_: &Grids, adapted: &Adapted, _: Order) -> Vec<u32> {
    (0..adapted.ops.len() as u32).collect()
}
