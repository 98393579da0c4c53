//! Blocks of memory over time, and their peak.

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

/// Bytes of the blocks that begin and end with a step.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::compile::memory) struct Change {
    pub(in crate::compile::memory) begun: u64,
    pub(in crate::compile::memory) ended: u64,
}

/// The change of each step, up to the last one that a block needs.
pub(super) fn changes(blocks: &[Block]) -> Vec<Change> {
    let mut changes = vec![Change::default(); steps(blocks)];
    for block in blocks {
        changes[block.first as usize].begun += block.bytes;
        changes[block.last as usize].ended += block.bytes;
    }
    changes
}

pub(super) fn peak(changes: &[Change]) -> Peak {
    let mut live = 0;
    let mut peak = Peak { step: 0, bytes: 0 };
    for (Change { begun, ended }, step) in changes.iter().zip(0_u32..) {
        live += begun;
        if live > peak.bytes {
            peak = Peak { step, bytes: live };
        }
        live -= ended;
    }
    peak
}

/// Steps up to the last one that a block needs.
pub(super) fn steps(blocks: &[Block]) -> usize {
    blocks.iter().fold(0, |steps, block| steps.max(block.last + 1)) as usize
}

/// The first aligned offset from `offset` on.
pub(super) fn align(offset: u64, alignment: u64) -> u64 {
    if alignment.is_power_of_two() {
        // Without a division.
        return (offset + (alignment - 1)) & !(alignment - 1);
    }
    offset.next_multiple_of(alignment.max(1))
}
