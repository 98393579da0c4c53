//! `schedule`: the order in which operations run. The order of the file is legal by construction, and is kept.

use super::model::Adapted;

/// Indices into [`Adapted::ops`], in execution order.
pub(super) fn schedule(adapted: &Adapted) -> Vec<u32> {
    (0..adapted.ops.len() as u32).collect()
}
