//! One walk through time: each block takes a free range that fits, or grows the top.

use super::block::Packing;
use super::free_list::{End, FreeList, NONE};
use super::measured_blocks::MeasuredBlocks;
use std::cmp::Reverse;

/// Packs the blocks in the order of their first steps, of one step the largest first.
///
/// Blocks that end before the step of the live peak go to the high ends of free ranges. So those that are alive at the peak
/// lie close together at the low ends, with no free range between them at the step where memory is scarcest.
pub(super) fn sweep(MeasuredBlocks { blocks, changes, peak }: &MeasuredBlocks<'_>, memory: &mut FreeList) -> Packing {
    let mut packing = Packing { offsets: vec![0; blocks.len()], height: 0 };
    let mut order: Vec<u32> = (0..blocks.len() as u32).collect();
    let first = |at: u32| blocks[at as usize].first;
    if !blocks.is_sorted_by_key(|block| block.first) {
        order.sort_by_key(|at| first(*at));
    }
    for group in order.chunk_by_mut(|one, other| first(*one) == first(*other)) {
        if group.len() > 1 {
            group.sort_by_key(|at| Reverse(blocks[*at as usize].bytes));
        }
    }
    // For each step the ranges of the blocks that end there.
    let mut ended = vec![NONE; changes.len()];
    let mut step = 0;
    for at in order {
        let block = &blocks[at as usize];
        for ranges in &ended[step..block.first as usize] {
            memory.free(*ranges);
        }
        step = block.first as usize;
        if block.bytes == 0 {
            continue;
        }
        let end = if block.last < peak.step { End::High } else { End::Low };
        let range = memory.take(block.bytes, block.alignment, end);
        let offset = memory.offset(range);
        packing.offsets[at as usize] = offset;
        packing.height = packing.height.max(offset + block.bytes);
        memory.free_together(range, &mut ended[block.last as usize]);
    }
    packing
}
