//! Other orders of packing, tried while the effort lasts.
//!
//! Blocks are placed one after the other, each at the lowest offset that nothing alive at the same time takes: first in the
//! order of bytes × steps, then of bytes. After that, each block above the live peak moves forward in the order, where it
//! finds a lower offset; the blocks that it displaces move in turn.

use super::block::{Block, Packing, align, changes, peak, steps};
use std::borrow::Cow;
use std::cmp::Reverse;

/// The bound on the pairs of blocks, alive at the same time, that are looked at: this many,
const EFFORT: usize = 1 << 16;
/// and this many more for each block.
const EFFORT_A_BLOCK: usize = 16;

/// The lowest of `swept` and the packings found on the way to `bound`.
pub(super) fn search(blocks: &[Block], bound: u64, swept: Packing) -> Packing {
    let blocks = &*dense(blocks);
    let aim = aligned_peak(blocks).max(bound);
    let most = EFFORT + EFFORT_A_BLOCK * blocks.len();
    if swept.height <= aim || pairs(blocks) > most {
        return swept;
    }
    let mut search = Search { blocks, neighbours: Neighbours::of(blocks), best: swept, taken: Vec::new() };
    let mut order: Vec<u32> = (0..blocks.len() as u32).collect();
    order.sort_by_key(|at| {
        let Block { first, last, bytes, .. } = blocks[*at as usize];
        Reverse(u128::from(bytes) * u128::from(last - first + 1))
    });
    let mut found = search.try_order(&order);
    if found.height > aim {
        order.sort_by_key(|at| Reverse(blocks[*at as usize].bytes));
        found = search.try_order(&order);
    }
    let mut random = 0x9E37_79B9_7F4A_7C15_u64;
    let mut effort = 2 * search.effort();
    while search.best.height > aim && effort < most {
        for at in 1..order.len() {
            let block = order[at] as usize;
            if found.offsets[block] + blocks[block].bytes > aim {
                // The generator of Knuth's MMIX.
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                order[((random >> 33) % at as u64) as usize..=at].rotate_right(1);
            }
        }
        found = search.try_order(&order);
        effort += search.effort();
    }
    search.best
}

/// The blocks over few steps: if there are many more steps than blocks, those at which none begins or ends are left out.
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

/// The live peak where each block but the highest is padded to a multiple of the least alignment: no packing is
/// lower.
fn aligned_peak(blocks: &[Block]) -> u64 {
    let alignment = blocks.iter().map(|block| block.alignment).min().unwrap_or(1);
    let lacking = blocks.iter().map(|block| align(block.bytes, alignment) - block.bytes).max().unwrap_or(0);
    if lacking == 0 {
        return 0;
    }
    let aligned: Vec<Block> =
        blocks.iter().map(|block| Block { bytes: align(block.bytes, alignment), ..*block }).collect();
    peak(&changes(&aligned)).bytes - lacking
}

/// How many pairs of blocks are alive at the same time.
fn pairs(blocks: &[Block]) -> usize {
    // The blocks alive where another begins; the block itself is not counted.
    let mut begin_or_end = vec![(0_u32, 0_u32); steps(blocks)];
    for block in blocks {
        begin_or_end[block.first as usize].0 += 1;
        begin_or_end[block.last as usize].1 += 1;
    }
    let (mut alive, mut pairs) = (0_usize, 0_usize);
    for (begin, end) in begin_or_end {
        let begin = begin as usize;
        pairs += alive * begin + begin * begin.saturating_sub(1) / 2;
        alive = alive + begin - end as usize;
    }
    pairs
}

/// The state of the search.
struct Search<'a> {
    blocks: &'a [Block],
    neighbours: Neighbours,
    best: Packing,
    taken: Vec<(u64, u64)>,
}

impl Search<'_> {
    /// The effort of one order.
    fn effort(&self) -> usize {
        self.neighbours.others.len() / 2 + self.blocks.len()
    }

    /// Places each block at the lowest offset that nothing alive at the same time takes, in the given order.
    fn try_order(&mut self, order: &[u32]) -> Packing {
        const UNPLACED: u64 = u64::MAX;
        let mut packing = Packing { offsets: vec![UNPLACED; self.blocks.len()], height: 0 };
        for at in order {
            let block = &self.blocks[*at as usize];
            self.taken.clear();
            for other in self.neighbours.of_block(*at) {
                let offset = packing.offsets[*other as usize];
                if offset != UNPLACED {
                    self.taken.push((offset, offset + self.blocks[*other as usize].bytes));
                }
            }
            self.taken.sort_unstable();
            let mut offset = 0_u64;
            for (start, end) in &self.taken {
                if offset + block.bytes <= *start {
                    break;
                }
                offset = align(offset.max(*end), block.alignment);
            }
            packing.offsets[*at as usize] = offset;
            packing.height = packing.height.max(offset + block.bytes);
        }
        if packing.height < self.best.height {
            self.best.clone_from(&packing);
        }
        packing
    }
}

/// For each block those that are alive at the same time.
struct Neighbours {
    starts: Vec<u32>,
    others: Vec<u32>,
}

impl Neighbours {
    fn of(blocks: &[Block]) -> Neighbours {
        let mut order: Vec<u32> = (0..blocks.len() as u32).collect();
        order.sort_by_key(|at| blocks[*at as usize].first);
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        let mut alive: Vec<u32> = Vec::new();
        for at in order {
            alive.retain(|other| blocks[*other as usize].last >= blocks[at as usize].first);
            pairs.extend(alive.iter().map(|other| (*other, at)));
            alive.push(at);
        }
        let mut starts = vec![0_u32; blocks.len() + 1];
        for at in pairs.iter().flat_map(|(a, b)| [*a, *b]) {
            starts[at as usize] += 1;
        }
        let mut end = 0;
        for start in &mut starts {
            end += *start;
            *start = end;
        }
        let mut others = vec![0; pairs.len() * 2];
        for (at, other) in pairs.iter().flat_map(|(a, b)| [(*a, *b), (*b, *a)]) {
            starts[at as usize] -= 1;
            others[starts[at as usize] as usize] = other;
        }
        Neighbours { starts, others }
    }

    fn of_block(&self, at: u32) -> &[u32] {
        &self.others[self.starts[at as usize] as usize..self.starts[at as usize + 1] as usize]
    }
}
