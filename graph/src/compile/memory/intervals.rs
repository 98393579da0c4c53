//! Intervals: the steps between two barrier calls.
//!
//! A resource waits for the previous owner of its memory in a call behind that owner's last step. If the accesses need no call
//! there, the hand-over adds one. It adds none if the memory was free when the interval began. So each resource takes its
//! memory for the whole interval in which it begins, where a little more memory saves calls.

use super::pack::{Block, Change};

/// The share of the live peak that may be spent on fewer calls.
const SHARE: u64 = 50;

/// For each step the one with which its interval begins.
pub(super) struct Intervals {
    starts: Vec<u32>,
    /// The most bytes that all packings together may take.
    pub(super) most_bytes: u64,
}

impl Intervals {
    /// The fewest intervals in which, with each resource alive from the start of its interval on, at most a fiftieth more
    /// than `live_peak` is alive; `None` if the live peak alone allows as few intervals.
    ///
    /// `waits`: for each step one more than the last step that the accesses of this one wait for. `changes`: those of all blocks
    /// together.
    ///
    /// An interval ends before the first step that waits for a step in it, or with which it would take too much memory. Each
    /// interval reaches as far as it can, which gives the fewest.
    pub(super) fn of(waits: &[u32], changes: &[Change], live_peak: u64) -> Option<Intervals> {
        let most_bytes = live_peak + live_peak / SHARE;
        let (mut tight, mut wide) = (Walk::new(live_peak), Walk::new(most_bytes));
        let mut starts = Vec::with_capacity(waits.len());
        for (waits, step) in waits.iter().zip(0_u32..) {
            let change = changes.get(step as usize).copied().unwrap_or_default();
            tight.step(step, *waits, change);
            wide.step(step, *waits, change);
            starts.push(wide.start);
        }
        (wide.count < tight.count).then_some(Intervals { starts, most_bytes })
    }

    /// Blocks that begin with their intervals.
    pub(super) fn widen(&self, blocks: &[Block]) -> Vec<Block> {
        blocks.iter().map(|block| Block { first: self.starts[block.first as usize], ..*block }).collect()
    }
}

/// A walk through the steps that makes the fewest intervals with at most `most` bytes in each.
struct Walk {
    most: u64,
    /// Where the current interval begins.
    start: u32,
    /// Bytes that it takes, and those of them that no later one needs.
    taken: u64,
    ended: u64,
    count: u32,
}

impl Walk {
    fn new(most: u64) -> Walk {
        Walk { most, start: 0, taken: 0, ended: 0, count: 1 }
    }

    fn step(&mut self, step: u32, waits: u32, change: Change) {
        if waits > self.start || self.taken + change.begun > self.most {
            self.taken -= self.ended;
            (self.start, self.ended) = (step, 0);
            self.count += 1;
        }
        self.taken += change.begun;
        self.ended += change.ended;
    }
}

#[cfg(test)]
mod tests {
    use super::super::pack::MeasuredBlocks;
    use super::*;

    const MIB: u64 = 1 << 20;

    fn block(first: u32, last: u32, bytes: u64) -> Block {
        Block { first, last, bytes, alignment: 1 }
    }

    /// Where intervals start in four steps whose blocks take 100 MiB together at most, and `extra` more in step 1.
    fn starts(waits: &[u32], extra: u64) -> Option<Vec<u32>> {
        let blocks = [block(0, 0, 50 * MIB), block(1, 1, 50 * MIB + extra), block(2, 3, 100 * MIB), block(3, 3, 0)];
        Intervals::of(waits, &MeasuredBlocks::of(&blocks).changes, 100 * MIB).map(|intervals| intervals.starts)
    }

    #[test]
    fn a_fiftieth_more_than_the_live_peak_is_taken_where_it_saves_an_interval() {
        assert_eq!(starts(&[0; 4], 2 * MIB), Some(vec![0, 0, 2, 2]));
        // One byte more is too much.
        assert_eq!(starts(&[0; 4], 2 * MIB + 1), None);
    }

    #[test]
    fn what_saves_no_interval_is_left() {
        assert_eq!(starts(&[0; 4], 0), None);
        // The accesses need a call before step 1 anyway.
        assert_eq!(starts(&[0, 1, 0, 0], 2 * MIB), None);
    }
}
