//! Last accesses, without duplicates over subresources: so an image of many subresources can take over the memory of another
//! one without looking at each pair of them.

use super::subresource::SubresourceState;
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

impl LastAccess {
    /// That of a subresource, if it is accessed at all, on this queue.
    #[inline]
    pub(super) fn of_state(state: &SubresourceState, queue: usize) -> Option<LastAccess> {
        let SubresourceState { stages, accesses, last, .. } = *state;
        state.is_used().then(|| LastAccess { queue, stages, writes: accesses.writes(), last })
    }

    /// Adds it to a list, in which accesses that are alike are one with the latest step.
    #[inline]
    pub(super) fn add_to(self, list: &mut Vec<LastAccess>) {
        let same = |it: &&mut LastAccess| (it.queue, it.stages, it.writes) == (self.queue, self.stages, self.writes);
        match list.iter_mut().find(same) {
            Some(same) => same.last = same.last.max(self.last),
            None => list.push(self),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accesses_alike_are_one_with_the_latest_step() {
        let mut list = Vec::new();
        let access = |stages, writes, last| LastAccess { queue: 0, stages, writes, last };
        for last in [3, 7, 5] {
            access(Stages::CLEAR, Accesses::TRANSFER_WRITE, last).add_to(&mut list);
        }
        access(Stages::COPY, Accesses::empty(), 9).add_to(&mut list);
        let [cleared, read] = list[..] else { panic!("two kinds of accesses") };
        assert_eq!((cleared.writes, cleared.last), (Accesses::TRANSFER_WRITE, 7));
        assert_eq!((read.writes, read.last), (Accesses::empty(), 9));
    }
}
