//! Blocks of memory over time, and their peak.

use std::borrow::Cow;

/// A block that needs `bytes` from step `first` to step `last`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::compile::memory) struct Block {
    pub(in crate::compile::memory) first: u32,
    pub(in crate::compile::memory) last: u32,
    pub(in crate::compile::memory) bytes: u64,
    pub(in crate::compile::memory) alignment: u64,
}

/// An offset for each block, and the height of them all.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::compile::memory) struct Packing {
    pub(in crate::compile::memory) offsets: Vec<u64>,
    pub(in crate::compile::memory) height: u64,
}

/// The first of the steps at which the most is alive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Peak {
    pub(super) step: u32,
    pub(super) bytes: u64,
}

pub(super) fn peak(blocks: &[Block]) -> Peak {
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
pub(super) fn steps(blocks: &[Block]) -> usize {
    blocks.iter().map(|block| block.last as usize + 1).max().unwrap_or(0)
}

/// The blocks over few steps: if there are many more steps than blocks, those at which none begins or ends are left out.
pub(super) fn dense(blocks: &[Block]) -> Cow<'_, [Block]> {
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
pub(super) fn align(offset: u64, alignment: u64) -> u64 {
    if alignment.is_power_of_two() {
        // Without a division.
        return offset.checked_add(alignment - 1).map_or(u64::MAX, |above| above & !(alignment - 1));
    }
    offset.checked_next_multiple_of(alignment.max(1)).unwrap_or(u64::MAX)
}
