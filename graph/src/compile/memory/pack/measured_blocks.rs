//! Blocks with their peak, and their packing.

use super::block::{Block, Change, Packing, Peak, changes, peak};
use super::free_list::FreeList;
use super::{search, sweep};

/// Blocks with their changes from step to step, and their peak.
pub(in crate::compile::memory) struct MeasuredBlocks<'b> {
    pub(super) blocks: &'b [Block],
    /// For each step, up to the last one that a block needs.
    pub(in crate::compile::memory) changes: Vec<Change>,
    pub(super) peak: Peak,
}

impl MeasuredBlocks<'_> {
    /// The bytes and alignments of all blocks together must be at most `i64::MAX`: a packing takes at most twice as much.
    pub(in crate::compile::memory) fn of(blocks: &[Block]) -> MeasuredBlocks<'_> {
        let changes = changes(blocks);
        MeasuredBlocks { peak: peak(&changes), changes, blocks }
    }

    /// The largest total alive at one step: no packing is lower.
    pub(in crate::compile::memory) fn live_peak(&self) -> u64 {
        self.peak.bytes
    }

    /// The lowest packing found; the search ends at the live peak.
    ///
    /// Takes time in proportion to the blocks and steps if the blocks stand in the order of their first steps; else they are
    /// sorted.
    pub(in crate::compile::memory) fn pack(&self) -> Packing {
        let MeasuredBlocks { blocks, peak, .. } = *self;
        let bound = peak.bytes;
        let spread = sweep::sweep(self, &mut FreeList::spread(bound.max(1), blocks.len()));
        if spread.height <= bound {
            return spread;
        }
        let tight = sweep::sweep(self, &mut FreeList::tight(bound.max(1), blocks.len()));
        if tight.height <= bound { tight } else { search::search(blocks, bound, tight) }
    }
}
