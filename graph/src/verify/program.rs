//! The steps of a Plan in a dense form that is walked frame after frame: what they wait for, their barriers, their
//! accesses, as numbers and sets of bits.
//!
//! A Plan is read once to build it. On the way uses and lifetimes that the Plan doesn't state are reported, and ranges
//! that no image has: with those, nothing can be followed.

use super::accesses::{self, BufferAccess, ImageAccess, Kind};
use super::findings::{Finding, Findings, role};
use super::lookup::Scopes;
use super::parts::{RangeId, Ranges, fits, is_whole};
use super::scopes::{PairSet, StageSet};
use super::violation::{Rule, StepName};
use crate::plan::{Image, ImageBarrier, ImageId, Plan, Queue, Role, Step, StepId};
use crate::vulkan::{Accesses, Layout, Sharing, Stages, Subresources, name_of};
use serde::Serialize;

/// The steps of a Plan.
#[derive(Debug, Default)]
pub(super) struct Program {
    steps: Vec<StepEnds>,
    pub(super) waits: Vec<Wait>,
    pub(super) memory_barriers: Vec<MemoryScopes>,
    /// Those before the work of a step, then its releases.
    pub(super) barriers: Vec<Barrier>,
    pub(super) accesses: Vec<Access>,
    /// For each image and buffer: its users.
    pub(super) used: Vec<UseSpan>,
    pub(super) ranges: Ranges,
    /// Steps that others wait for, rising.
    pub(super) signals: Vec<u32>,
    /// Whether more than the graphics queue is used.
    pub(super) several_queues: bool,
}

/// Where the entries of a step end in each list.
#[derive(Debug, Clone, Copy, Default)]
struct StepEnds {
    queue: u8,
    has_attachments: bool,
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
    /// Whether some of its accesses are those of attachments.
    pub(super) has_attachments: bool,
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
pub(super) struct UseSpan {
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
    /// Whether the frame has to find or leave it in a stated state.
    pub(super) outlives: bool,
    /// The first and last step that the Plan states.
    stated: [StepId; 2],
}

impl UseSpan {
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
        let start = step.checked_sub(1).map_or(StepEnds::default(), |before| self.steps[before as usize]);
        let end = self.steps[step as usize];
        let range = |start: u32, end: u32| start as usize..end as usize;
        Span {
            queue: end.queue,
            has_attachments: end.has_attachments,
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
    pub(super) scopes: Scopes,
    program: Program,
    step: StepId,
    queue: u8,
    /// Whether the step at hand accesses attachments.
    has_attachments: bool,
    /// Whether every range so far is one that its image has.
    fits: bool,
    /// Parts of attachments that the scope at hand has drawn to; only kept where passes may read them in it.
    pub(super) drawn: Vec<(ImageId, Subresources)>,
}

impl<'b, 'p> Builder<'b, 'p> {
    pub(super) fn new(plan: &'p Plan, found: &'b mut Findings<'p>) -> Builder<'b, 'p> {
        let used = |sharing, role: &Role| {
            let stated = match role {
                Role::Transient(placement) => Some(placement.lifetime),
                Role::Persistent { .. } | Role::External { .. } => None,
            };
            UseSpan {
                first: u32::MAX,
                last: 0,
                queue: 0,
                last_queue: 0,
                worked: false,
                exclusive: sharing == Sharing::Exclusive,
                outlives: stated.is_none(),
                stated: stated.unwrap_or([StepId(0), StepId(u32::MAX)]),
            }
        };
        let images = plan.images.iter().map(|image| used(image.sharing, &image.role));
        let buffers = plan.buffers.iter().map(|buffer| used(buffer.sharing, &buffer.role));
        let barriers = plan.steps.iter().map(|step| step.image_barriers.len() + step.releases.len()).sum();
        let accesses = plan.steps.iter().map(|step| accesses::expected(&step.work)).sum();
        let program = Program {
            steps: Vec::with_capacity(plan.steps.len()),
            barriers: Vec::with_capacity(barriers),
            accesses: Vec::with_capacity(accesses),
            used: images.chain(buffers).collect(),
            ..Program::default()
        };
        Builder {
            plan,
            found,
            scopes: Scopes::new(),
            program,
            step: StepId(0),
            queue: 0,
            has_attachments: false,
            fits: true,
            drawn: Vec::new(),
        }
    }

    /// Adds the next step.
    pub(super) fn add(&mut self, id: StepId, step: &Step) {
        (self.step, self.queue, self.has_attachments) = (id, number(step.queue), false);
        self.program.several_queues |= self.queue != 0;
        for wait in &step.waits {
            let stages = StageSet::of(wait.stages);
            self.program.waits.push(Wait { step: wait.step.0, frames_ago: wait.frames_ago, stages });
            self.program.signals.push(wait.step.0);
        }
        for barrier in &step.memory_barriers {
            let source = (barrier.src_stages, barrier.src_accesses);
            let scopes = self.memory_scopes(source, (barrier.dst_stages, barrier.dst_accesses));
            self.program.memory_barriers.push(scopes);
        }
        step.image_barriers.iter().for_each(|barrier| self.barrier(barrier));
        let barriers = self.program.barriers.len() as u32;
        accesses::list(&step.work, self);
        step.releases.iter().for_each(|barrier| self.barrier(barrier));
        self.program.steps.push(StepEnds {
            queue: self.queue,
            has_attachments: self.has_attachments,
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
        let source = (barrier.src_stages, barrier.src_accesses);
        let scopes = self.memory_scopes(source, (barrier.dst_stages, barrier.dst_accesses));
        self.program.barriers.push(Barrier {
            image: barrier.image.0,
            range,
            scopes,
            old: barrier.old_layout,
            new: barrier.new_layout,
            ownership: barrier.ownership.map(|queues| queues.map(number)),
        });
    }

    fn memory_scopes(&mut self, source: (Stages, Accesses), destination: (Stages, Accesses)) -> MemoryScopes {
        let (source, destination) = (self.scopes.of(source.0, source.1), self.scopes.of(destination.0, destination.1));
        MemoryScopes { from: source.earlier, to: destination.later, source: source.pairs, shown: destination.pairs }
    }

    /// Adds an access to an image.
    pub(super) fn image(&mut self, access: ImageAccess) {
        let ImageAccess { image, range, layout, stages, pairs, kind, contents, usage } = access;
        let Some(number) = self.range(image, range) else { return };
        self.note(image.0, Some(range), false);
        let missing = usage.difference(self.plan.image(image).usage);
        if !missing.is_empty() {
            self.not_made_for(image.0, &missing);
        }
        self.has_attachments |= kind == Kind::Attachment;
        self.program.accesses.push(Access { resource: image.0, range: number, pairs, stages, layout, kind, contents });
    }

    /// Adds an access to a buffer.
    pub(super) fn buffer(&mut self, access: BufferAccess) {
        let BufferAccess { buffer, stages, pairs, contents, usage } = access;
        let resource = self.plan.images.len() as u32 + buffer.0;
        self.note(resource, None, false);
        let missing = usage.difference(self.plan.buffers[buffer.0 as usize].usage);
        if !missing.is_empty() {
            self.not_made_for(resource, &missing);
        }
        let (range, layout, kind) = (RangeId::WHOLE, Layout::Undefined, Kind::Plain);
        self.program.accesses.push(Access { resource, range, pairs, stages, layout, kind, contents });
    }

    #[cold]
    fn not_made_for(&mut self, resource: u32, missing: &impl Serialize) {
        let what = format!("is used as {}, which its usage leaves out", name_of(missing));
        self.found.structure(Some(self.step), Some(resource), what);
    }

    #[inline]
    fn range(&mut self, image: ImageId, range: Subresources) -> Option<RangeId> {
        let described = self.plan.image(image);
        if is_whole(described, range) { Some(RangeId::WHOLE) } else { self.part(image, described, range) }
    }

    #[inline(never)]
    fn part(&mut self, image: ImageId, described: &Image, range: Subresources) -> Option<RangeId> {
        if fits(described, range) {
            return Some(self.program.ranges.number(image.0, range));
        }
        self.found.structure(Some(self.step), Some(image.0), format!("has no part {range}"));
        self.fits = false;
        None
    }

    /// Barriers may stand before the stated lifetime: whether the memory is free by then is found out on the way.
    #[inline]
    fn note(&mut self, resource: u32, range: Option<Subresources>, barrier: bool) {
        let step = self.step;
        let used = &mut self.program.used[resource as usize];
        if used.worked && used.last == step.0 {
            return;
        }
        if used.steps().is_none() {
            (used.first, used.queue) = (step.0, self.queue);
        }
        (used.last, used.last_queue, used.worked) = (step.0, self.queue, !barrier);
        if step > used.stated[1] || !barrier && step < used.stated[0] {
            self.outside_lifetime(resource, range);
        }
    }

    #[cold]
    fn outside_lifetime(&mut self, resource: u32, range: Option<Subresources>) {
        let Role::Transient(placement) = role(self.plan, resource) else { return };
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
