//! One walk through time: each block takes a free range that fits, or grows the top.

use super::block::{Block, Packing, Peak, steps};
use super::free_list::{End, FreeList};
use std::cmp::Reverse;

/// No block.
const NONE: u32 = u32::MAX;

/// Packs the blocks in the order of their first steps, of one step the largest first.
///
/// Blocks that end before the step of the live peak go to the high ends of free ranges. So those that are alive at the peak
/// lie close together at the low ends, with no free range between them at the step where memory is scarcest.
pub(super) fn sweep(blocks: &[Block], peak: Peak, memory: &mut FreeList) -> Packing {
    memory.reserve(blocks.len());
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
    let mut ranges = vec![NONE; blocks.len()];
    // For each step the blocks that end there, as linked lists.
    let mut heads = vec![NONE; steps(blocks)];
    let mut next = vec![NONE; blocks.len()];
    let mut step = 0;
    for at in order {
        let block = &blocks[at as usize];
        for head in &heads[step..block.first as usize] {
            let mut ended = *head;
            while ended != NONE {
                memory.free(ranges[ended as usize]);
                ended = next[ended as usize];
            }
        }
        step = block.first as usize;
        if block.bytes == 0 {
            continue;
        }
        let end = if block.last < peak.step { End::High } else { End::Low };
        let range = memory.take(block.bytes, block.alignment, end);
        let offset = memory.offset(range);
        ranges[at as usize] = range;
        packing.offsets[at as usize] = offset;
        packing.height = packing.height.max(offset.saturating_add(block.bytes));
        next[at as usize] = std::mem::replace(&mut heads[block.last as usize], at);
    }
    packing
}
