//! Last accesses, without duplicates over subresources: so an image of many subresources can take over the memory of another
//! one without looking at each pair of them.

use crate::vulkan::{Accesses, Stages};

/// Last accesses on one queue that have stages and writes in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct LastAccess {
    /// The number of the queue.
    pub(super) queue: usize,
    pub(super) stages: Stages,
    pub(super) writes: Accesses,
    /// The latest step.
    pub(super) last: u32,
}

/// The last accesses to some subresources.
#[derive(Debug, Clone, Default)]
pub(super) struct LastAccesses {
    list: Vec<LastAccess>,
}

impl LastAccesses {
    /// Adds the last accesses to a subresource, in `step` on queue number `queue`.
    #[inline]
    pub(super) fn add(&mut self, queue: usize, stages: Stages, accesses: Accesses, step: u32) {
        let writes = accesses.writes();
        let same = |it: &&mut LastAccess| (it.queue, it.stages, it.writes) == (queue, stages, writes);
        match self.list.iter_mut().find(same) {
            Some(same) => same.last = same.last.max(step),
            None => self.list.push(LastAccess { queue, stages, writes, last: step }),
        }
    }

    pub(super) fn clear(&mut self) {
        self.list.clear();
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &LastAccess> {
        self.list.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accesses_alike_are_one_with_the_latest_step() {
        let mut accesses = LastAccesses::default();
        for last in [3, 7, 5] {
            accesses.add(0, Stages::CLEAR, Accesses::TRANSFER_WRITE, last);
        }
        accesses.add(0, Stages::COPY, Accesses::TRANSFER_READ, 9);
        let [cleared, read] = accesses.iter().collect::<Vec<_>>()[..] else { panic!("two kinds of accesses") };
        assert_eq!((cleared.writes, cleared.last), (Accesses::TRANSFER_WRITE, 7));
        assert_eq!((read.writes, read.last), (Accesses::empty(), 9));
    }
}
