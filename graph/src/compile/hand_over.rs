//! Second part of `synchronise`: memory that changes hands after a write.
//!
//! An image barrier's memory scope covers its own image alone, so the write of a previous occupant must be named by a
//! memory barrier. Such a barrier covers *all* memory: one serves every later hand-over of such writes whose image
//! barrier comes after it, be it through others in between.

use super::synchronise::Group;
use crate::plan::{ImageBarrier, ImageId, MemoryBarrier, Resource};
use crate::vocabulary::{Accesses, Stages};

/// A write, and who takes its memory over.
#[derive(Debug, Clone, Copy)]
pub(super) struct HandOver {
    pub(super) images: [ImageId; 2],
    /// The previous occupant's last use.
    pub(super) write: Group,
    /// Whether that was in this frame, or in the one before.
    pub(super) this_frame: bool,
    /// The new occupant's first use.
    pub(super) first: Group,
    /// Stages that the new occupant's first image barrier waits for.
    pub(super) waits_for: Stages,
}

/// The first half of a memory barrier: the writes that it makes available. Nothing more is asked of an earlier one, since the
/// layout change that the new occupant begins with needs the writes before it available, and is made visible by its own
/// barrier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Source {
    stages: Stages,
    accesses: Accesses,
}

impl Source {
    fn of(hand_over: &HandOver) -> Source {
        Source { stages: hand_over.write.stages, accesses: hand_over.write.accesses.writes() }
    }

    fn covers(self, other: Source) -> bool {
        self.stages.contains(other.stages) && self.accesses.contains(other.accesses)
    }
}

/// A memory barrier that was passed on the way through the frame.
struct Passed {
    source: Source,
    /// When, counted over two frames.
    time: usize,
    /// Stages in which everything from here on comes after it.
    reach: Stages,
}

/// The memory barrier of each step, where one is due.
///
/// First those that the frame itself needs; then, in a second frame after the first, those that only the frame before
/// makes necessary.
pub(super) fn memory_barriers(
    mut hand_overs: Vec<HandOver>,
    image_barriers: &[Vec<ImageBarrier>],
) -> Vec<Option<MemoryBarrier>> {
    let steps = image_barriers.len();
    let mut barriers: Vec<Option<MemoryBarrier>> = vec![None; steps];
    if hand_overs.is_empty() {
        return barriers;
    }
    hand_overs.sort_by_key(|hand_over| (hand_over.first.first, hand_over.images));
    let mut passed: Vec<Passed> = Vec::new();
    for time in 0..2 * steps {
        let (step, second_frame) = (time % steps, time >= steps);
        let at_step = hand_overs.partition_point(|it| (it.first.first as usize) < step)
            ..hand_overs.partition_point(|it| it.first.first as usize <= step);
        let due: Vec<&HandOver> =
            hand_overs[at_step].iter().filter(|it| it.this_frame != second_frame && !done(&passed, it)).collect();
        add(&mut barriers[step], &due);
        pass(&mut passed, time, barriers[step].as_ref(), &image_barriers[step]);
    }
    barriers
}

/// Whether a barrier since the write already serves. Each hand-over's write is in the first frame that is walked.
fn done(passed: &[Passed], hand_over: &HandOver) -> bool {
    passed.iter().any(|barrier| {
        barrier.time > hand_over.write.last as usize
            && barrier.source.covers(Source::of(hand_over))
            && and_earlier(hand_over.waits_for).intersects(barrier.reach)
    })
}

fn add(barrier: &mut Option<MemoryBarrier>, due: &[&HandOver]) {
    for hand_over in due {
        let source = Source::of(hand_over);
        let barrier = barrier.get_or_insert_with(|| MemoryBarrier {
            src_stages: Stages::empty(),
            src_accesses: Accesses::empty(),
            dst_stages: Stages::empty(),
            dst_accesses: Accesses::empty(),
            hand_overs: Vec::new(),
            buffers: Vec::new(),
        });
        barrier.src_stages |= source.stages;
        barrier.src_accesses |= source.accesses;
        barrier.dst_stages |= hand_over.first.stages;
        barrier.dst_accesses |= hand_over.first.accesses;
        barrier.hand_overs.push(hand_over.images.map(Resource::Image));
    }
}

/// What comes after each barrier, once those of one step are passed. They don't order each other.
fn pass(passed: &mut Vec<Passed>, time: usize, memory: Option<&MemoryBarrier>, images: &[ImageBarrier]) {
    let memory_scopes = memory.map(|it| (it.src_stages, it.dst_stages));
    let scopes: Vec<(Stages, Stages)> =
        images.iter().map(|it| (it.src_stages, it.dst_stages)).chain(memory_scopes).collect();
    for barrier in passed.iter_mut() {
        let follows = |(src, _): &&(Stages, Stages)| and_earlier(*src).intersects(barrier.reach);
        let next = scopes.iter().filter(follows).fold(barrier.reach, |reach, (_, dst)| reach | and_later(*dst));
        barrier.reach = next;
    }
    let Some(memory) = memory else { return };
    let source = Source { stages: memory.src_stages, accesses: memory.src_accesses };
    // Distinct sources are few: of equal ones the latest serves whatever an earlier one could, once it reaches as far.
    let reach = and_later(memory.dst_stages);
    passed.retain(|barrier| !(source.covers(barrier.source) && reach.contains(barrier.reach)));
    passed.push(Passed { source, time, reach });
}

/// The stages of the graphics pipeline in logical order.
const PIPELINE: [Stages; 7] = [
    Stages::DRAW_INDIRECT,
    Stages::VERTEX_INPUT,
    Stages::VERTEX_SHADER,
    Stages::EARLY_FRAGMENT_TESTS,
    Stages::FRAGMENT_SHADER,
    Stages::LATE_FRAGMENT_TESTS,
    Stages::COLOR_ATTACHMENT_OUTPUT,
];

/// With the logically earlier stages, which a barrier's first scope includes.
fn and_earlier(stages: Stages) -> Stages {
    let last = PIPELINE.iter().rposition(|stage| stages.contains(*stage));
    PIPELINE[..last.map_or(0, |last| last + 1)].iter().fold(stages, |all, stage| all | *stage)
}

/// With the logically later stages, which a barrier's second scope includes.
fn and_later(stages: Stages) -> Stages {
    let first = PIPELINE.iter().position(|stage| stages.contains(*stage)).unwrap_or(PIPELINE.len());
    PIPELINE[first..].iter().fold(stages, |all, stage| all | *stage)
}
