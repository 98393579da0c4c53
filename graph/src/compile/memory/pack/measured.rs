//! Blocks with their peak, and their packing.

use super::block::{Block, Packing, Peak, dense, peak};
use super::free_list::FreeList;
use super::{search, sweep};
use std::borrow::Cow;

/// Blocks with their peak.
pub(in crate::compile::memory) struct Measured<'b> {
    pub(super) blocks: Cow<'b, [Block]>,
    pub(super) peak: Peak,
}

impl Measured<'_> {
    /// Takes time in proportion to the blocks, and to their steps if those are not many more.
    pub(in crate::compile::memory) fn of(blocks: &[Block]) -> Measured<'_> {
        let blocks = dense(blocks);
        Measured { peak: peak(&blocks), blocks }
    }

    /// The largest total alive at one step: no packing is lower. At most `u64::MAX`.
    pub(in crate::compile::memory) fn live_peak(&self) -> u64 {
        self.peak.bytes
    }

    /// The lowest packing found; the search ends at the live peak.
    ///
    /// Takes time in proportion to the blocks if they stand in the order of their first steps; else they are sorted. Offsets
    /// and the height end at `u64::MAX` if the bytes and alignments of all blocks together are more than that.
    pub(in crate::compile::memory) fn pack(&self) -> Packing {
        let Measured { blocks, peak } = self;
        let bound = peak.bytes;
        let spread = sweep::sweep(blocks, *peak, &mut FreeList::spread(bound.max(1)));
        if spread.height <= bound {
            return spread;
        }
        let tight = sweep::sweep(blocks, *peak, &mut FreeList::tight(bound.max(1)));
        if tight.height <= bound { tight } else { search::search(blocks, bound, tight) }
    }
}
