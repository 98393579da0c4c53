//! Packing in the plane lifetime × offset: the least height found within a bound on the effort.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

/// A block that needs `bytes` from step `first` to step `last`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    pub(super) first: u32,
    pub(super) last: u32,
    pub(super) bytes: u64,
    pub(super) alignment: u64,
}

/// An offset for each block, and the height of them all.
#[derive(Debug, Clone)]
pub(super) struct Packing {
    pub(super) offsets: Vec<u64>,
    pub(super) height: u64,
}

/// Above this many blocks only the sweep is tried: it takes `n log n`.
const EXHAUSTIVE_BLOCKS: usize = 512;
/// Orders tried for few blocks.
const SHUFFLES: u32 = 256;

/// The largest total alive at one step: no packing is lower.
pub(super) fn live_peak(blocks: &[Block]) -> u64 {
    let mut changes: Vec<(u32, bool, u64)> = Vec::with_capacity(blocks.len() * 2);
    for block in blocks {
        changes.push((block.first, true, block.bytes));
        changes.push((block.last + 1, false, block.bytes));
    }
    changes.sort_unstable();
    let (mut live, mut peak) = (0_u64, 0);
    for (_, begins, bytes) in changes {
        live = if begins { live.saturating_add(bytes) } else { live.saturating_sub(bytes) };
        peak = peak.max(live);
    }
    peak
}

/// The lowest of several packings; `bound` is the blocks' [`live_peak`].
pub(super) fn pack(blocks: &[Block], bound: u64) -> Packing {
    let mut best = sweep(blocks);
    if best.height <= bound || blocks.len() > EXHAUSTIVE_BLOCKS {
        return best;
    }
    let mut order: Vec<usize> = (0..blocks.len()).collect();
    order.sort_by_key(|at| (Reverse(blocks[*at].bytes), blocks[*at].first, *at));
    let mut keep = |packing: Packing| {
        if packing.height < best.height {
            best = packing;
        }
        best.height <= bound
    };
    if keep(lowest_fit(blocks, &order)) {
        return best;
    }
    order.sort_by_key(|at| {
        (Reverse(u128::from(blocks[*at].bytes) * u128::from(blocks[*at].last - blocks[*at].first + 1)), *at)
    });
    if keep(lowest_fit(blocks, &order)) {
        return best;
    }
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    for _ in 0..SHUFFLES {
        let mut next = |below: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % below.max(1) as u64) as usize
        };
        let (a, b) = (next(order.len()), next(order.len()));
        order.swap(a, b);
        if keep(lowest_fit(blocks, &order)) {
            break;
        }
    }
    best
}

/// Places each block at the lowest offset that nothing alive at the same time takes, in the given order.
fn lowest_fit(blocks: &[Block], order: &[usize]) -> Packing {
    let mut packing = Packing { offsets: vec![0; blocks.len()], height: 0 };
    let mut placed: Vec<usize> = Vec::with_capacity(blocks.len());
    let mut taken: Vec<(u64, u64)> = Vec::new();
    for at in order {
        let block = &blocks[*at];
        taken.clear();
        taken.extend(
            placed
                .iter()
                .filter(|other| blocks[**other].first <= block.last && block.first <= blocks[**other].last)
                .map(|other| (packing.offsets[*other], packing.offsets[*other].saturating_add(blocks[*other].bytes))),
        );
        taken.sort_unstable();
        let mut offset = 0_u64;
        for (start, end) in &taken {
            if offset.saturating_add(block.bytes) <= *start {
                break;
            }
            offset = align(offset.max(*end), block.alignment);
        }
        packing.offsets[*at] = offset;
        packing.height = packing.height.max(offset.saturating_add(block.bytes));
        placed.push(*at);
    }
    packing
}

/// Walks through time; each block takes the smallest gap that fits, or grows the top.
fn sweep(blocks: &[Block]) -> Packing {
    let mut order: Vec<usize> = (0..blocks.len()).collect();
    order.sort_by_key(|at| (blocks[*at].first, Reverse(blocks[*at].bytes), *at));
    let mut packing = Packing { offsets: vec![0; blocks.len()], height: 0 };
    let mut alive: BinaryHeap<Reverse<(u32, usize)>> = BinaryHeap::new();
    let mut gaps = Gaps::default();
    for at in order {
        let block = &blocks[at];
        while let Some(Reverse((last, ended))) = alive.peek().copied() {
            if last >= block.first {
                break;
            }
            alive.pop();
            gaps.free(packing.offsets[ended], blocks[ended].bytes);
        }
        let offset = gaps.take(block.bytes, block.alignment).unwrap_or_else(|| {
            let base = gaps.take_top(packing.height);
            let offset = align(base, block.alignment);
            gaps.free(base, offset - base);
            packing.height = offset.saturating_add(block.bytes);
            offset
        });
        packing.offsets[at] = offset;
        alive.push(Reverse((block.last, at)));
    }
    packing
}

fn align(offset: u64, alignment: u64) -> u64 {
    offset.checked_next_multiple_of(alignment.max(1)).unwrap_or(u64::MAX)
}

/// Free ranges below the top, by place and by size.
#[derive(Default)]
struct Gaps {
    by_offset: BTreeMap<u64, u64>,
    by_size: BTreeSet<(u64, u64)>,
}

impl Gaps {
    /// Gives a range back, joined with its free neighbours.
    fn free(&mut self, mut offset: u64, mut bytes: u64) {
        if bytes == 0 {
            return;
        }
        if let Some((before, size)) = self.by_offset.range(..offset).next_back().map(|(at, size)| (*at, *size))
            && before + size == offset
        {
            self.remove(before, size);
            (offset, bytes) = (before, bytes + size);
        }
        if let Some(size) = self.by_offset.get(&(offset + bytes)).copied() {
            self.remove(offset + bytes, size);
            bytes += size;
        }
        self.by_offset.insert(offset, bytes);
        self.by_size.insert((bytes, offset));
    }

    fn remove(&mut self, offset: u64, size: u64) {
        self.by_offset.remove(&offset);
        self.by_size.remove(&(size, offset));
    }

    /// Takes `bytes` out of the smallest range that fits.
    fn take(&mut self, bytes: u64, alignment: u64) -> Option<u64> {
        let fits = |(size, offset): &(u64, u64)| {
            let start = align(*offset, alignment);
            start.saturating_add(bytes) <= offset + size
        };
        let (size, offset) = self.by_size.range((bytes, 0)..).copied().find(fits)?;
        self.remove(offset, size);
        let start = align(offset, alignment);
        self.free(offset, start - offset);
        self.free(start + bytes, offset + size - start - bytes);
        Some(start)
    }

    /// Takes the range that ends at the top, if one does, and returns where the top then is.
    fn take_top(&mut self, top: u64) -> u64 {
        match self.by_offset.range(..top).next_back().map(|(at, size)| (*at, *size)) {
            Some((offset, size)) if offset + size == top => {
                self.remove(offset, size);
                offset
            }
            _ => top,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocks(list: &[(u32, u32, u64)]) -> Vec<Block> {
        list.iter()
            .map(|(first, last, bytes)| Block { first: *first, last: *last, bytes: *bytes, alignment: 1 })
            .collect()
    }

    fn assert_disjoint(blocks: &[Block], packing: &Packing) {
        for (a, x) in blocks.iter().enumerate() {
            assert!(packing.offsets[a] + x.bytes <= packing.height);
            assert_eq!(packing.offsets[a] % x.alignment, 0);
            for (b, y) in blocks.iter().enumerate().skip(a + 1) {
                let together = x.first <= y.last && y.first <= x.last;
                let overlap = packing.offsets[a] < packing.offsets[b] + y.bytes
                    && packing.offsets[b] < packing.offsets[a] + x.bytes;
                assert!(!(together && overlap), "{a} and {b} share bytes while both are alive");
            }
        }
    }

    #[test]
    fn a_chain_needs_two_blocks() {
        let chain: Vec<Block> = blocks(&(0..1000).map(|step| (step, step + 1, 64)).collect::<Vec<_>>());
        let packing = pack(&chain, live_peak(&chain));
        assert_disjoint(&chain, &packing);
        assert_eq!(packing.height, 128);
    }

    #[test]
    fn random_blocks_are_disjoint_and_near_the_live_peak() {
        let mut state = 12345_u64;
        let mut next = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        for _ in 0..50 {
            let list: Vec<Block> = (0..40)
                .map(|_| {
                    let first = next(60) as u32;
                    let alignment = 1 << next(9);
                    Block { first, last: first + next(12) as u32, bytes: (1 + next(50)) * alignment, alignment }
                })
                .collect();
            let packing = pack(&list, live_peak(&list));
            assert_disjoint(&list, &packing);
            assert!(packing.height <= live_peak(&list) * 3 / 2, "{} over {}", packing.height, live_peak(&list));
        }
    }
}
