//! Second part of `synchronise`: memory that changes hands after a write.
//!
//! An image barrier's memory scope covers its own image alone, so the write of a previous occupant must be named by a
//! memory barrier, in a call before that of the image barrier (docs/synchronization.md). Such a barrier covers *all*
//! memory: one serves every later hand-over of such writes whose image barrier comes after it, be it through others in
//! between.

use super::batch::Batched;
use super::model::StoreIndex;
use super::queues::{QUEUES, Queues};
use super::synchronise::Pending;
use crate::vulkan::{Accesses, Stages};

/// A write, and who takes its memory over.
#[derive(Debug, Clone, Copy)]
pub(super) struct HandOver {
    /// Previous and next occupant.
    pub(super) stores: [StoreIndex; 2],
    /// Stages and accesses of the previous occupant's last use.
    pub(super) write: (Stages, Accesses),
    /// The step of that use.
    pub(super) written: u32,
    /// Whether that was in this frame, or in the one before.
    pub(super) this_frame: bool,
    /// The new occupant's first barrier.
    pub(super) barrier: u32,
}

/// A memory barrier for hand-overs.
#[derive(Debug, Clone, Default)]
pub(super) struct MemoryScopes {
    pub(super) src_stages: Stages,
    pub(super) src_accesses: Accesses,
    pub(super) dst_stages: Stages,
    pub(super) hand_overs: Vec<[StoreIndex; 2]>,
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

/// A hand-over with the step at which it happens.
#[derive(Clone, Copy)]
struct Due {
    at: u32,
    source: Source,
    written: u32,
    this_frame: bool,
    /// The new occupant's first barrier.
    barrier: Pending,
    stores: [StoreIndex; 2],
}

/// The memory barriers that hand-overs take, each with its step, in the order of steps.
///
/// First those that the frame itself needs; then, in a second frame after the first, those that only the frame before
/// makes necessary.
pub(super) fn memory_barriers(
    hand_overs: &[HandOver],
    pending: &[Pending],
    batched: &[Batched],
    steps: usize,
) -> Vec<(u32, MemoryScopes)> {
    if hand_overs.is_empty() {
        return Vec::new();
    }
    let mut due = due(hand_overs, pending, batched);
    due.sort_by_key(|due| (due.at, due.stores));
    let mut barriers: Vec<Option<MemoryScopes>> = vec![None; steps];
    let mut passed: Vec<Passed> = Vec::new();
    for time in 0..2 * steps {
        let (step, second_frame) = (time % steps, time >= steps);
        let here = of_step(&due, step as u32, |due| due.at);
        let now: Vec<&Due> = here.iter().filter(|due| due.this_frame != second_frame && !done(&passed, due)).collect();
        add(&mut barriers[step], &now);
        let images = of_step(batched, step as u32, |it| it.at).iter().map(|it| &pending[it.barrier as usize]);
        pass(&mut passed, time, barriers[step].as_ref(), images);
    }
    (0..).zip(barriers).filter_map(|(step, barrier)| Some((step, barrier?))).collect()
}

/// The same on several queues: each has barriers of its own.
pub(super) fn memory_barriers_on(
    queues: &Queues,
    hand_overs: &[HandOver],
    pending: &[Pending],
    batched: &[Batched],
    steps: usize,
) -> Vec<(u32, MemoryScopes)> {
    let on = |queue: usize| {
        let due = hand_overs.iter().filter(|it| queues.at(pending[it.barrier as usize].step) == queue);
        let due: Vec<HandOver> = due.copied().collect();
        let batched: Vec<Batched> = batched.iter().filter(|it| queues.at(it.at) == queue).copied().collect();
        memory_barriers(&due, pending, &batched, steps)
    };
    let mut all: Vec<(u32, MemoryScopes)> = (0..QUEUES).flat_map(on).collect();
    all.sort_by_key(|(step, _)| *step);
    all
}

/// The entries of one step of a list in the order of steps.
pub(super) fn of_step<T>(list: &[T], step: u32, at: impl Fn(&T) -> u32) -> &[T] {
    let start = list.partition_point(|it| at(it) < step);
    let rest = &list[start..];
    &rest[..rest.partition_point(|it| at(it) <= step)]
}

fn due(hand_overs: &[HandOver], pending: &[Pending], batched: &[Batched]) -> Vec<Due> {
    let mut at = vec![0_u32; pending.len()];
    batched.iter().for_each(|it| at[it.barrier as usize] = it.at);
    let due = |it: &HandOver| Due {
        at: at[it.barrier as usize],
        source: Source { stages: it.write.0, accesses: it.write.1 },
        written: it.written,
        this_frame: it.this_frame,
        barrier: pending[it.barrier as usize],
        stores: it.stores,
    };
    hand_overs.iter().map(due).collect()
}

/// Whether a barrier since the write already serves. Each hand-over's write is in the first frame that is walked.
fn done(passed: &[Passed], due: &Due) -> bool {
    passed.iter().any(|barrier| {
        barrier.time > due.written as usize
            && barrier.source.covers(due.source)
            && and_earlier(due.barrier.src_stages).intersects(barrier.reach)
    })
}

fn add(barrier: &mut Option<MemoryScopes>, due: &[&Due]) {
    for due in due {
        let barrier = barrier.get_or_insert_default();
        barrier.src_stages |= due.source.stages;
        barrier.src_accesses |= due.source.accesses;
        // The image barrier, a call later, goes on from there: it waits for the same stages.
        barrier.dst_stages |= due.source.stages;
        if !barrier.hand_overs.contains(&due.stores) {
            barrier.hand_overs.push(due.stores);
        }
    }
}

/// What comes after each barrier, once those of one step are passed: its memory barrier, then its image barriers, which
/// don't order each other.
fn pass<'p>(
    passed: &mut Vec<Passed>,
    time: usize,
    memory: Option<&MemoryScopes>,
    images: impl Iterator<Item = &'p Pending>,
) {
    if let Some(memory) = memory {
        lead_on(passed, &[(memory.src_stages, memory.dst_stages)]);
        let source = Source { stages: memory.src_stages, accesses: memory.src_accesses };
        // Distinct sources are few: of equal ones the latest serves whatever an earlier one could, once it reaches as far.
        let reach = and_later(memory.dst_stages);
        passed.retain(|barrier| !(source.covers(barrier.source) && reach.contains(barrier.reach)));
        passed.push(Passed { source, time, reach });
    }
    let scopes: Vec<(Stages, Stages)> = images.map(|it| (it.src_stages, it.dst_stages)).collect();
    lead_on(passed, &scopes);
}

/// Lets the barriers of one call lead on from what they wait for.
fn lead_on(passed: &mut [Passed], scopes: &[(Stages, Stages)]) {
    for barrier in passed {
        let follows = |(src, _): &&(Stages, Stages)| and_earlier(*src).intersects(barrier.reach);
        let next = scopes.iter().filter(follows).fold(barrier.reach, |reach, (_, dst)| reach | and_later(*dst));
        barrier.reach = next;
    }
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
pub(super) fn and_earlier(stages: Stages) -> Stages {
    let last = PIPELINE.iter().rposition(|stage| stages.contains(*stage));
    PIPELINE[..last.map_or(0, |last| last + 1)].iter().fold(stages, |all, stage| all | *stage)
}

/// With the logically later stages, which a barrier's second scope includes.
pub(super) fn and_later(stages: Stages) -> Stages {
    let first = PIPELINE.iter().position(|stage| stages.contains(*stage)).unwrap_or(PIPELINE.len());
    PIPELINE[first..].iter().fold(stages, |all, stage| all | *stage)
}
