//! The steps of a Plan in a dense form that is walked frame after frame: what they wait for, their barriers, their
//! accesses, as numbers and sets of bits.
//!
//! A Plan is read once to build it. On the way uses and lifetimes that the Plan doesn't state are reported, and ranges
//! that no image has: with those, nothing can be followed.

use super::accesses::{self, BufferAccess, ImageAccess, Kind};
use super::findings::{Finding, Findings, role};
use super::parts::{RangeId, Ranges, fits};
use super::scopes::{PairSet, StageSet};
use super::violation::{Rule, StepName};
use crate::plan::{ImageBarrier, ImageId, Plan, Queue, Role, Step, StepId};
use crate::vulkan::{Layout, Sharing, Subresources, name_of};

/// The steps of a Plan.
#[derive(Debug, Default)]
pub(super) struct Program {
    steps: Vec<Ends>,
    pub(super) waits: Vec<Wait>,
    pub(super) memory_barriers: Vec<MemoryScopes>,
    /// Those before the work of a step, then its releases.
    pub(super) barriers: Vec<Barrier>,
    pub(super) accesses: Vec<Access>,
    /// For each image and buffer: its users.
    pub(super) used: Vec<Used>,
    pub(super) ranges: Ranges,
    /// Steps that others wait for, rising.
    pub(super) signals: Vec<u32>,
    /// Whether more than the graphics queue is used.
    pub(super) several_queues: bool,
}

/// Where the entries of a step end in each list.
#[derive(Debug, Clone, Copy, Default)]
struct Ends {
    queue: u8,
    waits: u32,
    memory_barriers: u32,
    barriers: u32,
    releases: u32,
    accesses: u32,
}

/// Where the entries of a step stand in each list.
#[derive(Debug, Clone)]
pub(super) struct Span {
    pub(super) queue: u8,
    pub(super) waits: std::ops::Range<usize>,
    pub(super) memory_barriers: std::ops::Range<usize>,
    pub(super) barriers: std::ops::Range<usize>,
    pub(super) releases: std::ops::Range<usize>,
    pub(super) accesses: std::ops::Range<usize>,
}

/// A wait for another queue.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wait {
    pub(super) step: u32,
    pub(super) frames_ago: u32,
    pub(super) stages: StageSet,
}

/// A memory barrier: source stages with earlier ones, destination stages with later ones.
#[derive(Debug, Clone, Copy)]
pub(super) struct MemoryScopes {
    pub(super) from: StageSet,
    pub(super) to: StageSet,
    pub(super) source: PairSet,
    pub(super) shown: PairSet,
}

/// An image barrier.
#[derive(Debug, Clone, Copy)]
pub(super) struct Barrier {
    pub(super) image: u32,
    pub(super) range: RangeId,
    pub(super) scopes: MemoryScopes,
    pub(super) old: Layout,
    pub(super) new: Layout,
    /// The two queues of an ownership transfer.
    pub(super) ownership: Option<[u8; 2]>,
}

/// An access of a step's work.
#[derive(Debug, Clone, Copy)]
pub(super) struct Access {
    pub(super) resource: u32,
    pub(super) range: RangeId,
    pub(super) pairs: PairSet,
    pub(super) stages: StageSet,
    pub(super) layout: Layout,
    pub(super) kind: Kind,
    /// The effects on contents, see [`accesses::does`].
    pub(super) contents: u8,
}

/// The steps and queues that use an image or buffer, by barriers too.
#[derive(Debug, Clone, Copy)]
pub(super) struct Used {
    /// The first step that uses it; after `last` if there is none.
    pub(super) first: u32,
    /// The last step that uses it.
    pub(super) last: u32,
    /// The queue of the first step.
    pub(super) queue: u8,
    /// The queue of the last step.
    pub(super) last_queue: u8,
    /// Whether the work of the last step uses it, not only the step's barriers.
    worked: bool,
    /// Whether only one queue at a time may use it.
    pub(super) exclusive: bool,
}

impl Used {
    /// The first and last step.
    pub(super) fn steps(&self) -> Option<[StepId; 2]> {
        (self.first <= self.last).then_some([StepId(self.first), StepId(self.last)])
    }
}

impl Program {
    /// Number of steps.
    pub(super) fn steps(&self) -> u32 {
        self.steps.len() as u32
    }

    /// Where the entries of a step stand.
    pub(super) fn span(&self, step: u32) -> Span {
        let start = step.checked_sub(1).map_or(Ends::default(), |before| self.steps[before as usize]);
        let end = self.steps[step as usize];
        let range = |start: u32, end: u32| start as usize..end as usize;
        Span {
            queue: end.queue,
            waits: range(start.waits, end.waits),
            memory_barriers: range(start.memory_barriers, end.memory_barriers),
            barriers: range(start.releases, end.barriers),
            releases: range(end.barriers, end.releases),
            accesses: range(start.accesses, end.accesses),
        }
    }
}

/// The number of a queue.
pub(super) const fn number(queue: Queue) -> u8 {
    match queue {
        Queue::Graphics => 0,
        Queue::Compute => 1,
        Queue::Transfer => 2,
    }
}

/// Builds a [`Program`] step by step.
pub(super) struct Builder<'b, 'p> {
    pub(super) plan: &'p Plan,
    pub(super) found: &'b mut Findings<'p>,
    program: Program,
    step: StepId,
    queue: u8,
    /// Whether every range so far is one that its image has.
    fits: bool,
    /// Parts of attachments that the scope at hand has drawn to; only kept where passes may read them in it.
    pub(super) drawn: Vec<(ImageId, Subresources)>,
}

impl<'b, 'p> Builder<'b, 'p> {
    pub(super) fn new(plan: &'p Plan, found: &'b mut Findings<'p>) -> Builder<'b, 'p> {
        let used = |sharing| {
            let exclusive = sharing == Sharing::Exclusive;
            Used { first: u32::MAX, last: 0, queue: 0, last_queue: 0, worked: false, exclusive }
        };
        let sharing = plan.images.iter().map(|image| image.sharing).chain(plan.buffers.iter().map(|it| it.sharing));
        let program = Program {
            steps: Vec::with_capacity(plan.steps.len()),
            used: sharing.map(used).collect(),
            ..Program::default()
        };
        Builder { plan, found, program, step: StepId(0), queue: 0, fits: true, drawn: Vec::new() }
    }

    /// Adds the next step.
    pub(super) fn add(&mut self, id: StepId, step: &Step) {
        (self.step, self.queue) = (id, number(step.queue));
        self.program.several_queues |= self.queue != 0;
        for wait in &step.waits {
            let stages = StageSet::of(wait.stages);
            self.program.waits.push(Wait { step: wait.step.0, frames_ago: wait.frames_ago, stages });
            self.program.signals.push(wait.step.0);
        }
        for barrier in &step.memory_barriers {
            self.program.memory_barriers.push(MemoryScopes {
                from: StageSet::of(barrier.src_stages).and_earlier(),
                to: StageSet::of(barrier.dst_stages).and_later(),
                source: PairSet::of(barrier.src_stages, barrier.src_accesses),
                shown: PairSet::of(barrier.dst_stages, barrier.dst_accesses),
            });
        }
        step.image_barriers.iter().for_each(|barrier| self.barrier(barrier));
        let barriers = self.program.barriers.len() as u32;
        accesses::list(&step.work, self);
        step.releases.iter().for_each(|barrier| self.barrier(barrier));
        self.program.steps.push(Ends {
            queue: self.queue,
            waits: self.program.waits.len() as u32,
            memory_barriers: self.program.memory_barriers.len() as u32,
            barriers,
            releases: self.program.barriers.len() as u32,
            accesses: self.program.accesses.len() as u32,
        });
    }

    /// The steps, unless some range is none that its image has.
    pub(super) fn finish(mut self) -> Option<Program> {
        self.program.signals.sort_unstable();
        self.program.signals.dedup();
        self.fits.then_some(self.program)
    }

    fn barrier(&mut self, barrier: &ImageBarrier) {
        let Some(range) = self.range(barrier.image, barrier.range) else { return };
        self.note(barrier.image.0, Some(barrier.range), true);
        self.program.barriers.push(Barrier {
            image: barrier.image.0,
            range,
            scopes: MemoryScopes {
                from: StageSet::of(barrier.src_stages).and_earlier(),
                to: StageSet::of(barrier.dst_stages).and_later(),
                source: PairSet::of(barrier.src_stages, barrier.src_accesses),
                shown: PairSet::of(barrier.dst_stages, barrier.dst_accesses),
            },
            old: barrier.old_layout,
            new: barrier.new_layout,
            ownership: barrier.ownership.map(|queues| queues.map(number)),
        });
    }

    /// Adds an access to an image.
    pub(super) fn image(&mut self, access: ImageAccess) {
        let ImageAccess { image, range, layout, stages, pairs, kind, contents, usage } = access;
        let Some(number) = self.range(image, range) else { return };
        self.note(image.0, Some(range), false);
        let missing = usage.difference(self.plan.image(image).usage);
        if !missing.is_empty() {
            let what = format!("is used as {}, which its usage leaves out", name_of(&missing));
            self.found.structure(Some(self.step), Some(image.0), what);
        }
        self.program.accesses.push(Access { resource: image.0, range: number, pairs, stages, layout, kind, contents });
    }

    /// Adds an access to a buffer.
    pub(super) fn buffer(&mut self, access: BufferAccess) {
        let BufferAccess { buffer, stages, pairs, contents, usage } = access;
        let resource = self.plan.images.len() as u32 + buffer.0;
        self.note(resource, None, false);
        let missing = usage.difference(self.plan.buffers[buffer.0 as usize].usage);
        if !missing.is_empty() {
            let what = format!("is used as {}, which its usage leaves out", name_of(&missing));
            self.found.structure(Some(self.step), Some(resource), what);
        }
        let (range, layout, kind) = (RangeId::WHOLE, Layout::Undefined, Kind::Plain);
        self.program.accesses.push(Access { resource, range, pairs, stages, layout, kind, contents });
    }

    fn range(&mut self, image: ImageId, range: Subresources) -> Option<RangeId> {
        let described = self.plan.image(image);
        if fits(described, range) {
            return Some(self.program.ranges.number(described, range));
        }
        self.found.structure(Some(self.step), Some(image.0), format!("has no part {range}"));
        self.fits = false;
        None
    }

    /// Barriers may stand before the stated lifetime: whether the memory is free by then is found out on the way.
    fn note(&mut self, resource: u32, range: Option<Subresources>, barrier: bool) {
        let used = &mut self.program.used[resource as usize];
        if used.steps().is_none() {
            *used = Used { first: self.step.0, queue: self.queue, ..*used };
        } else if used.last == self.step.0 && used.worked {
            return;
        }
        (used.last, used.last_queue, used.worked) = (self.step.0, self.queue, !barrier);
        if let Role::Transient(placement) = role(self.plan, resource)
            && (self.step > placement.lifetime[1] || !barrier && self.step < placement.lifetime[0])
        {
            let nearest = placement.lifetime[usize::from(self.step > placement.lifetime[1])];
            self.found.push(Finding {
                rule: Rule::Lifetime { stated: placement.lifetime },
                step: self.step,
                other: Some(StepName::new(self.plan, nearest, 0)),
                resource,
                range,
                bytes: Some([placement.offset, placement.offset.saturating_add(placement.bytes)]),
            });
        }
    }
}
