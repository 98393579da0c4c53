//! The known state of each part of each image, and of each buffer, while the walk goes on.

use super::clocks::{Availability, Time};
use super::scopes::{PairSet, STAGES, StageSet};
use crate::vulkan::Layout;

/// Accesses, layout, owner and contents of one part of an image, or of a buffer.
#[derive(Debug, Clone)]
pub(super) struct SubresourceState<const Q: usize> {
    /// The layout it is in; of buffers always `UNDEFINED`.
    pub(super) layout: Layout,
    /// A mistake was reported that concerns the last writes: its consequences aren't reported again.
    pub(super) excused: bool,
    /// The queue that may use it.
    pub(super) owner: Owner,
    /// The last write, or layout change.
    pub(super) write: Write,
    /// Reads since then: the last one of each stage.
    pub(super) reads: Reads<Q>,
    /// Whether there is something to read.
    pub(super) contents: Contents,
    /// When contents were last written; 0 for never.
    pub(super) filled: Time,
    /// The last scope that wrote it as an attachment: that scope's other accesses to it follow in rasterisation order.
    pub(super) rasterised: Time,
    /// How often its memory had changed hands when it got it; 0 for none yet.
    pub(super) generation: u32,
}

impl<const Q: usize> SubresourceState<Q> {
    /// Nothing has happened yet.
    pub(super) const FRESH: SubresourceState<Q> = SubresourceState {
        layout: Layout::Undefined,
        excused: false,
        owner: Owner::Anyone,
        write: Write::NONE,
        reads: Reads { stages: [StageSet(0); Q], times: [[0; STAGES]; Q] },
        contents: Contents::Unwritten,
        filled: 0,
        rasterised: 0,
        generation: 0,
    };

    /// An access by `pairs` of `queue`. A write replaces accesses of earlier steps; the pairs of one step stand side by side.
    pub(super) fn record(&mut self, queue: u8, pairs: PairSet, now: Time) {
        let writes = pairs.writes();
        if !writes.is_empty() {
            if self.write.time == now && !self.write.pairs.is_empty() {
                self.write.pairs = self.write.pairs.union(writes);
                self.write.stages = self.write.stages.union(writes.stages());
            } else {
                self.write = Write { time: now, queue, pairs: writes, stages: writes.stages(), ..Write::NONE };
                self.reads.clear();
                self.excused = false;
            }
        }
        let reads = pairs.reads();
        if !reads.is_empty() {
            self.reads.insert(queue, reads.stages(), now);
        }
    }

    /// When it was last accessed.
    pub(super) fn last(&self) -> Time {
        self.reads.iter().map(|read| read.time).fold(self.write.time, Time::max)
    }
}

/// The last write, or the layout change since: all the accesses of one step, of which no two are told apart afterwards.
/// A barrier must speak for all of them, or for those that no earlier memory barrier has spoken for.
#[derive(Debug, Clone)]
pub(super) struct Write {
    /// The time of the write.
    pub(super) time: Time,
    /// The queue that wrote.
    pub(super) queue: u8,
    count: u8,
    /// The stages that wrote.
    pub(super) stages: StageSet,
    /// The pairs of stage and access; none for a layout change.
    pub(super) pairs: PairSet,
    /// Pairs, on the queue of the last image barrier, that image barriers have made it visible to.
    pub(super) visible: PairSet,
    /// Image barriers that it became available by.
    barriers: [Availability; Write::BARRIERS],
}

impl Write {
    /// More image barriers than these on one unchanged write are forgotten: the checker then asks for a barrier more
    /// than Vulkan would, and never for one less.
    const BARRIERS: usize = 4;

    /// No write yet.
    const NONE: Write = Write {
        time: 0,
        queue: 0,
        count: 0,
        stages: StageSet(0),
        pairs: PairSet(0),
        visible: PairSet(0),
        barriers: [Availability { time: 0, stages: StageSet(0), queue: 0 }; Write::BARRIERS],
    };

    /// The last write before the frame: by the writes among `pairs`, on `queue`.
    pub(super) fn before_frame(queue: u8, pairs: PairSet, time: Time) -> Write {
        let pairs = pairs.writes();
        Write { time, queue, pairs, stages: pairs.stages(), ..Write::NONE }
    }

    /// A layout change by an image barrier: available by itself, visible to the pairs `visible`.
    pub(super) fn layout_change(barrier: Availability, visible: PairSet) -> Write {
        let mut write = Write { time: barrier.time, queue: barrier.queue, visible, ..Write::NONE };
        write.became_available(barrier);
        write
    }

    /// Whether there is anything to wait for.
    pub(super) fn exists(&self) -> bool {
        !self.pairs.is_empty() || self.count > 0
    }

    /// An image barrier made it available and visible to `pairs`.
    pub(super) fn shown(&mut self, barrier: Availability, pairs: PairSet) {
        let same_queue = self.barriers().last().is_none_or(|last| last.queue == barrier.queue);
        self.visible = if same_queue { self.visible.union(pairs) } else { pairs };
        self.became_available(barrier);
    }

    fn became_available(&mut self, barrier: Availability) {
        if let Some(place) = self.barriers.get_mut(usize::from(self.count)) {
            *place = barrier;
            self.count += 1;
        }
    }

    /// The image barriers that it became available by.
    pub(super) fn barriers(&self) -> &[Availability] {
        &self.barriers[..usize::from(self.count)]
    }

    /// Whether it is a layout change that its own barrier puts before `stages` of `queue`, and makes visible to `pairs`.
    pub(super) fn is_layout_change_for(&self, queue: u8, stages: StageSet, pairs: PairSet) -> bool {
        let last = &self.barriers[usize::from(self.count.saturating_sub(1))];
        self.pairs.is_empty()
            && last.queue == queue
            && last.stages.contains_all(stages)
            && self.visible.contains_all(pairs)
            && self.count > 0
    }

    /// Whether image barriers on `queue` have made it visible to all of `pairs`.
    pub(super) fn is_shown(&self, queue: u8, pairs: PairSet) -> bool {
        self.visible.contains_all(pairs)
            && (pairs.is_empty() || self.barriers().last().is_some_and(|last| last.queue == queue))
    }
}

/// The last read of each stage of each queue.
#[derive(Debug, Clone)]
pub(super) struct Reads<const Q: usize> {
    stages: [StageSet; Q],
    times: [[Time; STAGES]; Q],
}

/// A read.
#[derive(Debug, Clone, Copy)]
pub(super) struct Read {
    pub(super) queue: u8,
    pub(super) stage: usize,
    pub(super) time: Time,
}

impl<const Q: usize> Reads<Q> {
    pub(super) fn insert(&mut self, queue: u8, stages: StageSet, time: Time) {
        let queue = usize::from(queue);
        self.stages[queue] = self.stages[queue].union(stages);
        stages.iter().for_each(|stage| self.times[queue][stage] = time);
    }

    /// The last read of each stage.
    pub(super) fn iter(&self) -> impl Iterator<Item = Read> {
        (0..Q).flat_map(move |queue| {
            let times = &self.times[queue];
            self.stages[queue].iter().map(move |stage| Read { queue: queue as u8, stage, time: times[stage] })
        })
    }

    pub(super) fn is_empty(&self) -> bool {
        self.stages.iter().all(|stages| stages.is_empty())
    }

    pub(super) fn clear(&mut self) {
        self.stages = [StageSet(0); Q];
    }
}

/// The queue that may use a part of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Owner {
    /// The first that does, or all of them.
    Anyone,
    /// This one.
    Queue(u8),
    /// None: it was released by the barrier with this number, and not acquired.
    Released(u32),
}

/// Whether there is something to read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contents {
    /// Yes.
    Defined,
    /// Nothing in this frame has written it.
    Unwritten,
    /// Then the frame has written it, but nothing that is sure to have written all of it.
    InPart(Time),
    /// It was written, then lost.
    Lost(LostContents, Time),
}

/// How contents were lost, see [`super::Loss`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LostContents {
    Forgotten,
    NotLoaded,
    NotStored,
    /// By the image or buffer with this number.
    Taken(u32),
}
