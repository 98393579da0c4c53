//! Queues beside graphics: which steps run on them, what they wait for, and how images change hands.
//!
//! `assign` gives each step its queue; on a device with one queue, and where nothing gains, there is nothing to say and
//! nothing else here runs. Then each step, in the order of submission:
//!
//! - waits for steps of other queues (`clocks`), but only for what its queue doesn't know yet to be done;
//! - takes over what another queue used (`synchronise::cross`): a semaphore makes every write available and visible, so what
//!   is left for a barrier is a change of layout, or of the owner of an image that isn't for several queues at once.
//!
//! Steps of different queues run side by side, so memory is shared only between what waits keep apart (`spans`).

mod able;
mod assign;
mod change;
mod clocks;
mod cross_frames;
mod reach;
mod release;
mod spans;

pub(super) use assign::assign;
pub(super) use cross_frames::{find, finish, promise, take};
pub(super) use release::{HandOff, Release, releases};

use super::model::{CellIndex, StoreIndex};
use crate::plan::{Queue, Wait};
use crate::vulkan::{Accesses, Layout, Stages};
use clocks::Clocks;
use cross_frames::Edge;

/// Number of queues.
pub(super) const QUEUES: usize = 3;

/// The number of a queue.
pub(super) const fn number(queue: Queue) -> usize {
    match queue {
        Queue::Graphics => 0,
        Queue::Compute => 1,
        Queue::Transfer => 2,
    }
}

/// For each queue one more than a step on it, 0 for none: that step and all before it.
pub(super) type Steps = [u32; QUEUES];

/// What is known where several queues are used.
#[derive(Debug)]
pub(super) struct Queues {
    /// The queue of each step; the one behind all, which leaves promised states, is on graphics.
    of: Vec<Queue>,
    /// For each store how several queues share it, if they do, be it from frame to frame.
    shared: Vec<Option<Shared>>,
    /// Steps that only change layouts, each with what they change, in order.
    changes: Vec<(u32, Change)>,
    clocks: Clocks,
    /// For each cell how the queues use it, if its store is crossed.
    tracks: Vec<Track>,
    /// Numbers of barriers that stand right before the step that needs them, rising or not.
    held: Vec<bool>,
    hand_offs: Vec<HandOff>,
    /// What crosses frames and queues.
    edges: Vec<Edge>,
}

/// How several queues share a store.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shared {
    /// All at any time: waits alone keep them in order.
    Buffer,
    /// All at any time, in one layout.
    Image,
    /// One hands it over to the next.
    InTurns,
    /// All read it, in one layout, and nothing ever writes it.
    Constant,
}

/// How queues use a cell since its last write or change of layout.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Track {
    pub(super) by: [Seen; QUEUES],
    /// The queue and the step that wrote it or changed its layout, or used it first: whoever reads it comes after that.
    pub(super) begun: (usize, u32),
    /// Whether that step wrote it, and nothing on its queue has read it since.
    pub(super) unread: bool,
}

/// A change of layout by a step of its own, before several queues read.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    pub(super) cell: CellIndex,
    pub(super) store: StoreIndex,
    pub(super) layout: Layout,
}

/// How one queue uses a cell.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Seen {
    pub(super) stages: Stages,
    pub(super) accesses: Accesses,
    /// One more than the last step that does; 0 for none.
    pub(super) until: u32,
    /// The barrier before the first of them, if there is one.
    pub(super) barrier: Option<u32>,
}

impl Queues {
    fn new(of: Vec<Queue>, shared: Vec<Option<Shared>>, changes: Vec<(u32, Change)>, cells: u32) -> Queues {
        let clocks = Clocks::new(of.len() as u32 + 1);
        let tracks = vec![Track::default(); cells as usize];
        let (held, hand_offs, edges) = (Vec::new(), Vec::new(), Vec::new());
        Queues { of, shared, changes, clocks, tracks, held, hand_offs, edges }
    }

    /// The queue of a step.
    pub(super) fn of(&self, step: u32) -> Queue {
        self.of.get(step as usize).copied().unwrap_or(Queue::Graphics)
    }

    /// The number of the queue of a step.
    pub(super) fn at(&self, step: u32) -> usize {
        number(self.of(step))
    }

    /// How several queues share a store; `None` if only one uses it.
    pub(super) fn shared(&self, store: StoreIndex) -> Option<Shared> {
        self.shared[store as usize]
    }

    /// Whether several queues use a store.
    pub(super) fn is_crossed(&self, store: StoreIndex) -> bool {
        self.shared(store).is_some()
    }

    /// What a step changes that does nothing else.
    pub(super) fn changes(&self, step: u32) -> &[(u32, Change)] {
        crate::compile::hand_over::of_step(&self.changes, step, |(at, _)| *at)
    }

    pub(super) fn track(&self, cell: CellIndex) -> &Track {
        &self.tracks[cell as usize]
    }

    pub(super) fn track_mut(&mut self, cell: CellIndex) -> &mut Track {
        &mut self.tracks[cell as usize]
    }

    /// Lets a step wait for these steps of other queues, as far as its queue doesn't know them to be done.
    pub(super) fn require(&mut self, step: u32, required: Steps) {
        let queue = self.at(step);
        self.clocks.require(step, queue, required);
    }

    /// What is known to be done when a step begins, of its own queue too.
    pub(super) fn known(&self, step: u32) -> Steps {
        self.clocks.known(step)
    }

    /// Lets a barrier stand right before the step that needs it, behind that step's waits.
    pub(super) fn hold(&mut self, barrier: u32) {
        let least = barrier as usize + 1;
        if self.held.len() < least {
            self.held.resize(least, false);
        }
        self.held[barrier as usize] = true;
    }

    /// Whether a barrier stands right before the step that needs it.
    pub(super) fn is_held(&self, barrier: u32) -> bool {
        self.held.get(barrier as usize).copied().unwrap_or(false)
    }

    /// Notes that the barrier with this number takes a cell over from another queue.
    pub(super) fn hand_off(&mut self, hand_off: HandOff) {
        self.hand_offs.push(hand_off);
    }

    /// Lets a step wait for a step on the queue number `queue`, so many frames ago, if its queue doesn't know it to be done.
    pub(super) fn require_earlier(&mut self, step: u32, queue: usize, of: u32, frames_ago: u32) {
        self.edges.push(Edge { step, queue, of, frames_ago });
    }

    /// The waits of a step, once all are known.
    pub(super) fn waits(&self, step: u32) -> Vec<Wait> {
        self.clocks.waits(step)
    }
}
