//! Records of the judge about an execution: sets of nodes, touches of memory, and operations that make writes available or
//! visible.

use super::uses::Use;
use framewright_graph::plan::Queue;
use framewright_graph::vulkan::{Accesses, Stages};

/// A set of nodes.
#[derive(Debug, Clone, Default)]
pub(super) struct Nodes(Vec<u64>);

impl Nodes {
    pub(super) fn insert(&mut self, node: usize) {
        if self.0.len() <= node / 64 {
            self.0.resize(node / 64 + 1, 0);
        }
        self.0[node / 64] |= 1 << (node % 64);
    }

    pub(super) fn extend(&mut self, other: &Nodes) {
        if self.0.len() < other.0.len() {
            self.0.resize(other.0.len(), 0);
        }
        self.0.iter_mut().zip(&other.0).for_each(|(own, other)| *own |= other);
    }

    pub(super) fn contains(&self, node: usize) -> bool {
        self.0.get(node / 64).is_some_and(|word| word >> (node % 64) & 1 == 1)
    }
}

/// One access by one stage, a layout transition, or what stands for either at the borders of a frame.
#[derive(Debug, Clone)]
pub(super) struct Touch {
    pub(super) node: usize,
    pub(super) queue: Queue,
    /// Counts steps over all frames.
    pub(super) time: usize,
    pub(super) physical: usize,
    pub(super) cells: Vec<usize>,
    pub(super) what: What,
    /// The use that it is part of, and which one of its step.
    pub(super) of: Option<(usize, Use)>,
}

/// The kind of a touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum What {
    /// One access in one stage.
    Access(Stages, Accesses),
    /// A layout transition: reads and writes; waits for what is available, leaves its own writes available.
    Transition,
    /// The contents when the resource first appears: written and available.
    Initial,
    /// Work after the frame that relies on the promised state: reads and writes.
    After,
}

impl What {
    pub(super) fn writes(self) -> bool {
        match self {
            What::Access(_, access) => Accesses::WRITES.contains(access),
            What::Transition | What::Initial | What::After => true,
        }
    }
}

/// An availability operation, a visibility operation, or both: a barrier, a signal, a wait.
#[derive(Debug)]
pub(super) struct MemoryOperation {
    pub(super) queue: Queue,
    /// Writes become available: masks and node.
    pub(super) from: Option<(Stages, Accesses, usize)>,
    /// Writes become visible: masks and node.
    pub(super) to: Option<(Stages, Accesses, usize)>,
    /// `None`: all memory; else one image or buffer, in these parts.
    pub(super) part: Option<(usize, Vec<usize>)>,
}
