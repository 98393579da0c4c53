//! Packing in the plane lifetime × offset: the least height found within a bound on the effort.
//!
//! ```text
//! spread ─► (height above the live peak?) ─► tight ─► (above?) ─► search
//! ```
//! The first of them takes memory that nobody had before, and then that which was given back first: whoever takes memory
//! over waits for the one before, and the longer ago that was, the more passes share a barrier or need none.

mod gaps;
mod search;
mod sweep;
#[cfg(test)]
mod tests;

use gaps::Gaps;
use std::borrow::Cow;

/// A block that needs `bytes` from step `first` to step `last`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Block {
    pub(super) first: u32,
    pub(super) last: u32,
    pub(super) bytes: u64,
    pub(super) alignment: u64,
}

/// An offset for each block, and the height of them all.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Packing {
    pub(super) offsets: Vec<u64>,
    pub(super) height: u64,
}

/// Blocks with the step at which the most is alive.
pub(super) struct Measured<'b> {
    blocks: Cow<'b, [Block]>,
    peak: Peak,
}

impl Measured<'_> {
    /// Takes time in proportion to the blocks, and to their steps if those are not many more.
    pub(super) fn of(blocks: &[Block]) -> Measured<'_> {
        let blocks = dense(blocks);
        Measured { peak: peak(&blocks), blocks }
    }

    /// The largest total alive at one step: no packing is lower. At most `u64::MAX`.
    pub(super) fn live_peak(&self) -> u64 {
        self.peak.bytes
    }

    /// The lowest packing found; the search ends at the live peak.
    ///
    /// Takes time in proportion to the blocks if they stand in the order of their first steps; else they are sorted. Offsets
    /// and the height end at `u64::MAX` if the bytes and alignments of all blocks together are more than that.
    pub(super) fn pack(&self) -> Packing {
        let Measured { blocks, peak } = self;
        let bound = peak.bytes;
        let spread = sweep::sweep(blocks, *peak, Gaps::spread(bound.max(1)));
        if spread.height <= bound {
            return spread;
        }
        let tight = sweep::sweep(blocks, *peak, Gaps::tight(bound.max(1)));
        if tight.height <= bound { tight } else { search::search(blocks, bound, tight) }
    }
}

/// The first of the steps at which the most is alive.
#[derive(Debug, Clone, Copy)]
struct Peak {
    step: u32,
    bytes: u64,
}

fn peak(blocks: &[Block]) -> Peak {
    let mut changes = vec![0_i128; steps(blocks) + 1];
    for block in blocks {
        changes[block.first as usize] += i128::from(block.bytes);
        changes[block.last as usize + 1] -= i128::from(block.bytes);
    }
    let (mut live, mut most, mut at) = (0, 0, 0);
    for (change, step) in changes.into_iter().zip(0_u32..) {
        live += change;
        if live > most {
            (most, at) = (live, step);
        }
    }
    Peak { step: at, bytes: u64::try_from(most).unwrap_or(u64::MAX) }
}

/// Steps up to the last one that a block needs.
fn steps(blocks: &[Block]) -> usize {
    blocks.iter().map(|block| block.last as usize + 1).max().unwrap_or(0)
}

/// The blocks over steps so few that a table has room for them: if there are many more steps than blocks, those at which
/// none begins or ends are left out.
fn dense(blocks: &[Block]) -> Cow<'_, [Block]> {
    const STEPS_A_BLOCK: usize = 16;
    if steps(blocks) <= STEPS_A_BLOCK * blocks.len().max(64) {
        return Cow::Borrowed(blocks);
    }
    let mut times: Vec<u32> = blocks.iter().flat_map(|block| [block.first, block.last]).collect();
    times.sort_unstable();
    times.dedup();
    let rank = |step| times.partition_point(|time| *time < step) as u32;
    blocks.iter().map(|block| Block { first: rank(block.first), last: rank(block.last), ..*block }).collect()
}

/// The first aligned offset from `offset` on.
fn align(offset: u64, alignment: u64) -> u64 {
    offset.checked_next_multiple_of(alignment.max(1)).unwrap_or(u64::MAX)
}
