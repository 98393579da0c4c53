//! Queues by number.

use crate::plan::Queue;

/// Number of queues.
pub(in crate::compile) const QUEUES: usize = 3;

/// For each queue one more than a step on it: that step and all before it; 0 for none.
pub(in crate::compile) type Steps = [u32; QUEUES];

/// The number of a queue.
pub(super) const fn number(queue: Queue) -> usize {
    match queue {
        Queue::Graphics => 0,
        Queue::Compute => 1,
        Queue::Transfer => 2,
    }
}
