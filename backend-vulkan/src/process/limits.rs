//! Limits on a helper process: time, memory and stack.

use std::time::Duration;

/// Limits of the GLSL compiler in a helper process, and on the time of a driver's self-test.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Limits {
    /// Time for one stage of one shader. A usual one takes some milliseconds, and the first one of a process a third of a second.
    pub time: Duration,
    /// Bytes of address space, all of the process counted; `None`: as much as there is. Only Linux keeps to it.
    pub memory: Option<u64>,
    /// Bytes of stack.
    pub stack: usize,
    /// Time for one self-test of a driver; a device has two. One takes about a second where nothing is wrong.
    pub self_test: Duration,
}

impl Default for Limits {
    /// Ten seconds, 1 GiB of memory, 8 MiB of stack; a minute for a self-test.
    fn default() -> Limits {
        let [time, self_test] = [10, 60].map(Duration::from_secs);
        Limits { time, memory: Some(1 << 30), stack: 8 << 20, self_test }
    }
}
