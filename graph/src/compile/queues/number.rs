//! Queues by number: graphics is 0, compute 1, transfer 2, as [`Queue`](crate::plan::Queue) lists them.

/// Number of queues.
pub(in crate::compile) const QUEUES: usize = 3;

/// For each queue one more than a step on it: that step and all before it; 0 for none.
pub(in crate::compile) type Steps = [u32; QUEUES];
