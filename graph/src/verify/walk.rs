//! The walk over the steps, frame after frame.

use super::accesses::Kind;
use super::clocks::{Availability, Clock, Clocks, Time};
use super::dependencies::{before_access, before_layout_change, makes_available};
use super::findings::{Finding, Findings};
use super::frames::Frames;
use super::left_out::LeftOut;
use super::memory::{Memory, MemoryEvent};
use super::parts::{Part, SubresourceMap};
use super::program::{Access, Barrier, Program, Span};
use super::scopes::{PairSet, StageSet};
use super::subresources::{Contents, LostContents, Owner, SubresourceState, Write};
use super::violation::{Rule, StepName};
use crate::plan::{Plan, StepId};
use crate::vulkan::{Layout, Subresources};

/// All that is known between two steps.
pub(super) struct Walk<'w, 'p, const Q: usize> {
    pub(super) plan: &'p Plan,
    pub(super) found: &'w mut Findings<'p>,
    pub(super) program: &'w Program,
    pub(super) parts: SubresourceMap,
    pub(super) subresources: Vec<SubresourceState<Q>>,
    pub(super) memory: Memory,
    pub(super) clocks: Clocks<Q>,
    pub(super) frame: u32,
    /// Mistakes of contents in the step at hand: they are reported after those of order.
    pub(super) late: Vec<Finding>,
    batch: Vec<(Clock<Q>, StageSet, PairSet)>,
    /// For each queue, the clock of all that its semaphores have waited for.
    waited: [Clock<Q>; Q],
    /// The clock of all that the semaphores of the current step wait for.
    held: Clock<Q>,
    /// For each frame, and for each step that is waited for: the clock of a wait for that step.
    signalled: Vec<Vec<Clock<Q>>>,
}

/// Walks the steps of `plan` once for each frame.
pub(super) fn walk<'p>(plan: &'p Plan, program: &Program, frames: Frames, found: &mut Findings<'p>) {
    let before = found.violations.len();
    once(plan, program, &frames, &LeftOut::default(), found);
    let choices = LeftOut::choices(plan, &frames.circles);
    let with_gap = Frames { count: frames.count + 1, ..frames };
    for left_out in choices {
        // What is wrong already, where all steps run or without others, is told once.
        if found.violations.len() == before {
            once(plan, program, &with_gap, &left_out, found);
        }
    }
}

/// Walks the steps, some of which are left out.
fn once<'p>(plan: &'p Plan, program: &Program, frames: &Frames, left_out: &LeftOut, found: &mut Findings<'p>) {
    let Some(parts) = SubresourceMap::new(plan, &program.ranges) else {
        return found.structure(None, None, "tells more parts of images apart than can be followed");
    };
    if program.several_queues {
        Walk::<3>::new(plan, program, parts, found).all(frames, left_out);
    } else {
        Walk::<1>::new(plan, program, parts, found).all(frames, left_out);
    }
}

impl<'w, 'p, const Q: usize> Walk<'w, 'p, Q> {
    fn new(plan: &'p Plan, program: &'w Program, parts: SubresourceMap, found: &'w mut Findings<'p>) -> Self {
        Walk {
            plan,
            found,
            program,
            subresources: vec![SubresourceState::FRESH; parts.count()],
            parts,
            memory: Memory::new(plan),
            clocks: Clocks::new(),
            frame: 0,
            late: Vec::new(),
            batch: Vec::new(),
            waited: [Clock::START; Q],
            held: Clock::START,
            signalled: Vec::new(),
        }
    }

    fn all(&mut self, frames: &Frames, left_out: &LeftOut) {
        for frame in 0..frames.count {
            self.frame = frame;
            self.begin_frame();
            for step in 0..self.program.steps() {
                self.step(StepId(step), left_out.runs(step, frame, frames.count));
            }
            self.end_frame();
            self.become_next(frames);
        }
    }

    /// Waits and barriers stand in each frame, the work only where it `runs`.
    fn step(&mut self, id: StepId, runs: bool) {
        let span = self.program.span(id.0);
        if Q > 1 {
            self.wait(&span);
        }
        self.barriers(id, &span);
        if runs {
            self.work(id, &span);
        }
        if Q > 1 {
            self.releases(id, &span);
            self.signal(id, span.queue);
        }
    }

    /// The whole step, barriers included, comes after the steps that it waits for; later steps do so where their barriers, or
    /// the stages that wait, lead on to them.
    fn wait(&mut self, span: &Span) {
        self.held = Clock::START;
        let accesses = &self.program.accesses[span.accesses.clone()];
        let work = accesses.iter().fold(StageSet::default(), |all, access| all.union(access.stages));
        for wait in &self.program.waits[span.waits.clone()] {
            let signal = self.program.signals.binary_search(&wait.step);
            let frame = self.frame.checked_sub(wait.frames_ago).and_then(|frame| self.signalled.get(frame as usize));
            // In the first frames there is nothing yet to wait for.
            if let (Some(frame), Ok(signal)) = (frame, signal)
                && let Some(before) = frame.get(signal)
            {
                self.clocks.hold_up(span.queue, wait.stages.and_later().union(work), before);
                self.clocks.show(span.queue, PairSet::of_stages(wait.stages), before);
                self.waited[usize::from(span.queue)].join(before);
                self.held.join(before);
            }
        }
    }

    fn signal(&mut self, id: StepId, queue: u8) {
        let signalled = self.signalled.last_mut();
        if let Some(signalled) = signalled.filter(|before| self.program.signals.get(before.len()) == Some(&id.0)) {
            let mut before = self.clocks.signal(queue, self.frame * (self.program.steps() + 1) + id.0 + 2);
            before.join(&self.waited[usize::from(queue)]);
            signalled.push(before);
        }
    }

    /// Makes room for the semaphores of a new frame.
    pub(super) fn begin_signals(&mut self) {
        self.signalled.push(Vec::new());
    }

    fn barriers(&mut self, id: StepId, span: &Span) {
        if span.memory_barriers.is_empty() && span.barriers.is_empty() {
            return;
        }
        let (now, queue, program) = (self.now(id), span.queue, self.program);
        let mut batch = std::mem::take(&mut self.batch);
        batch.clear();
        for barrier in &program.memory_barriers[span.memory_barriers.clone()] {
            let mut before = self.before(queue, barrier.from, now);
            before.make_available(queue, barrier.source, now);
            batch.push((before, barrier.to, barrier.shown));
        }
        // Image barriers are a call of their own, which comes after that of the memory barriers.
        self.take_effect(queue, &mut batch);
        let mut last = None;
        for (barrier, number) in program.barriers[span.barriers.clone()].iter().zip(span.barriers.start as u32..) {
            let stages = (barrier.scopes.from, barrier.scopes.to);
            // Neighbours mostly wait for the same stages: the clock before those is then known already.
            if last != Some(stages) {
                batch.push((self.before(queue, stages.0, now), stages.1, PairSet::default()));
                last = Some(stages);
            }
            if let Some((before, _, _)) = batch.last() {
                self.image_barrier(id, queue, barrier, number, before);
            }
        }
        self.take_effect(queue, &mut batch);
        self.batch = batch;
    }

    /// Barriers of one call don't order each other, and none finds writes available that another one makes available: they take
    /// effect once all are judged.
    fn take_effect(&mut self, queue: u8, call: &mut Vec<(Clock<Q>, StageSet, PairSet)>) {
        for (before, stages, shown) in &*call {
            self.clocks.hold_up(queue, *stages, before);
            self.clocks.show(queue, *shown, before);
        }
        call.clear();
    }

    fn before(&self, queue: u8, stages: StageSet, now: Time) -> Clock<Q> {
        let mut before = self.clocks.before(queue, stages, now);
        if Q > 1 {
            before.join(&self.held);
        }
        before
    }

    fn image_barrier(&mut self, id: StepId, queue: u8, barrier: &Barrier, number: u32, before: &Clock<Q>) {
        let scopes = &barrier.scopes;
        let available = Availability { time: self.now(id), stages: scopes.to, queue };
        let forgets = barrier.old == Layout::Undefined;
        if forgets {
            self.alias(id, barrier.image);
        }
        let generation = self.memory.generation(barrier.image);
        let frame_start = self.frame_start();
        let outlives = self.program.used[barrier.image as usize].outlives;
        let mut part = self.parts.of(barrier.image, barrier.range);
        while let Some(index) = self.parts.next(&mut part) {
            let acquired = Q > 1 && self.own_by_barrier(id, queue, barrier, number, index);
            if !forgets && !acquired {
                self.check_layout(id, barrier.image, index, barrier.old);
                if barrier.old == barrier.new && barrier.ownership.is_none() {
                    let write = &mut self.subresources[index].write;
                    if write.exists() && makes_available(write, before, scopes.source) {
                        write.shown(available, scopes.shown);
                    }
                    continue;
                }
            }
            let state = &self.subresources[index];
            if state.generation != generation {
                // The accesses before the image lost its bytes don't count here: the next owner had to wait for them.
                self.check_hand_over(id, barrier.image, Some(index), MemoryEvent::Barrier(before));
            } else if !state.excused
                && let Some(gap) = before_layout_change(state, before, scopes.source)
            {
                self.report(id, barrier.image, index, gap.rule(), gap.time);
            }
            let state = &mut self.subresources[index];
            state.generation = generation;
            state.layout = barrier.new;
            state.write = Write::layout_change(available, scopes.shown);
            state.reads.clear();
            state.excused = false;
            if forgets {
                state.contents = match state.contents {
                    Contents::Defined if outlives || state.filled > frame_start => {
                        Contents::Lost(LostContents::Forgotten, available.time)
                    }
                    Contents::Lost(_, time) if time > frame_start => state.contents,
                    _ => Contents::Unwritten,
                };
            }
        }
    }

    /// The first halves of ownership transfers: from here on no queue may use the image, until the other half.
    fn releases(&mut self, id: StepId, span: &Span) {
        let (now, queue, program) = (self.now(id), span.queue, self.program);
        for (barrier, number) in program.barriers[span.releases.clone()].iter().zip(span.releases.start as u32..) {
            let before = self.before(queue, barrier.scopes.from, now + 1);
            let mut part = self.parts.of(barrier.image, barrier.range);
            while let Some(index) = self.parts.next(&mut part) {
                self.use_on(id, queue, barrier.image, index);
                self.check_layout(id, barrier.image, index, barrier.old);
                let state = &self.subresources[index];
                if !state.excused
                    && let Some(gap) = before_layout_change(state, &before, barrier.scopes.source)
                {
                    self.report(id, barrier.image, index, gap.rule(), gap.time);
                }
                let state = &mut self.subresources[index];
                state.layout = barrier.new;
                // A release makes nothing visible; the semaphore does.
                let released = Availability { time: now, stages: StageSet::ALL, queue };
                state.write = Write::layout_change(released, PairSet::default());
                state.reads.clear();
                state.excused = false;
                state.owner = Owner::Released(number);
            }
        }
    }

    fn work(&mut self, id: StepId, span: &Span) {
        let (now, queue, program) = (self.now(id), span.queue, self.program);
        let accesses = &program.accesses[span.accesses.clone()];
        if span.has_attachments {
            self.scope(id, queue, accesses);
        } else {
            for access in accesses {
                let mut part = self.begin_access(id, queue, access);
                while let Some(index) = self.parts.next(&mut part) {
                    self.check_access(id, queue, access, index);
                    self.subresources[index].record(queue, access.pairs, now);
                    self.contents(id, access, index);
                }
            }
        }
        self.late.drain(..).for_each(|finding| self.found.push(finding));
    }

    /// The accesses of a rendering scope. Attachments are kept in order by rasterisation: its accesses are held against the
    /// accesses before the scope, not against each other, and up to its own first write.
    fn scope(&mut self, id: StepId, queue: u8, accesses: &[Access]) {
        let now = self.now(id);
        let attached = |access: &&Access| access.kind == Kind::Attachment;
        for access in accesses.iter().filter(attached) {
            let writes = access.pairs.reads().is_empty() && !access.pairs.is_empty();
            let mut part = self.begin_access(id, queue, access);
            while let Some(index) = self.parts.next(&mut part) {
                self.check_access(id, queue, access, index);
                if writes {
                    self.subresources[index].rasterised = now;
                }
            }
        }
        for access in accesses.iter().filter(|access| !attached(access)) {
            let mut part = self.begin_access(id, queue, access);
            while let Some(index) = self.parts.next(&mut part) {
                self.check_access(id, queue, access, index);
                self.subresources[index].record(queue, access.pairs, now);
            }
        }
        for access in accesses.iter().filter(attached) {
            let mut part = self.parts.of(access.resource, access.range);
            while let Some(index) = self.parts.next(&mut part) {
                self.subresources[index].record(queue, access.pairs, now);
            }
        }
        for access in accesses.iter().filter(|access| access.contents != 0) {
            let mut part = self.parts.of(access.resource, access.range);
            while let Some(index) = self.parts.next(&mut part) {
                self.contents(id, access, index);
            }
        }
    }

    /// The parts that a step accesses. A buffer may have to take its bytes first.
    #[inline]
    fn begin_access(&mut self, step: StepId, queue: u8, access: &Access) -> Part {
        if access.resource as usize >= self.plan.images.len() {
            self.alias_buffer(step, queue, access);
        }
        self.parts.of(access.resource, access.range)
    }

    /// Whether a step may access a part: on its queue, in the layout that it names, after all that it conflicts with.
    #[inline]
    fn check_access(&mut self, step: StepId, queue: u8, access: &Access, index: usize) {
        if Q > 1 {
            self.use_on(step, queue, access.resource, index);
        }
        let state = &self.subresources[index];
        let in_order = || before_access(state, &self.clocks, queue, access.stages, access.pairs).is_none();
        if state.layout != access.layout || !in_order() {
            self.report_access(step, queue, access, index);
        }
    }

    /// Reports what is wrong with an access, unless it is excused.
    #[inline(never)]
    fn report_access(&mut self, step: StepId, queue: u8, access: &Access, index: usize) {
        self.check_layout(step, access.resource, index, access.layout);
        let state = &self.subresources[index];
        let ordered = match access.kind {
            Kind::Plain => false,
            Kind::Attachment => state.rasterised == self.now(step),
            Kind::Local => true,
        };
        if !ordered
            && !state.excused
            && let Some(gap) = before_access(state, &self.clocks, queue, access.stages, access.pairs)
        {
            self.subresources[index].excused = true;
            self.report(step, access.resource, index, gap.rule(), gap.time);
        }
    }

    #[inline]
    pub(super) fn check_layout(&mut self, step: StepId, resource: u32, index: usize, needed: Layout) {
        let state = &mut self.subresources[index];
        let found = std::mem::replace(&mut state.layout, needed);
        if found != needed {
            self.wrong_layout(step, resource, index, Rule::Layout { found, needed });
        }
    }

    #[cold]
    fn wrong_layout(&mut self, step: StepId, resource: u32, index: usize, rule: Rule) {
        let state = &mut self.subresources[index];
        state.excused = true;
        let last = state.last();
        self.report(step, resource, index, rule, last);
    }

    #[cold]
    pub(super) fn report(&mut self, step: StepId, resource: u32, index: usize, rule: Rule, time: Time) {
        let other = self.name_at(time, resource);
        let range = self.range(resource, index);
        let bytes = self.buffer_bytes(resource);
        self.found.push(Finding { rule, step, other, resource, range, bytes });
    }

    /// The part of an image that a subresource stands for.
    pub(super) fn range(&self, resource: u32, index: usize) -> Option<Subresources> {
        let image = self.plan.images.get(resource as usize)?;
        Some(self.parts.range(image, index))
    }

    /// All bytes of a buffer.
    pub(super) fn buffer_bytes(&self, resource: u32) -> Option<[u64; 2]> {
        let buffer = (resource as usize).checked_sub(self.plan.images.len())?;
        Some([0, self.plan.buffers[buffer].bytes])
    }

    /// The time of a step in the frame that is walked.
    pub(super) fn now(&self, step: StepId) -> Time {
        self.frame_start() + step.0 + 1
    }

    /// The time before the first step of the frame that is walked.
    pub(super) fn frame_start(&self) -> Time {
        self.frame * (self.program.steps() + 1)
    }

    /// The step at `time`; at the beginning of a frame, the step that accessed it last in the frame before.
    pub(super) fn name_at(&self, time: Time, resource: u32) -> Option<StepName> {
        let frame = self.program.steps() + 1;
        let ago = self.frame.saturating_sub(time / frame);
        match time % frame {
            0 => {
                let [_, last] = self.program.used[resource as usize].steps()?;
                Some(StepName::new(self.plan, last, ago + 1))
            }
            after => Some(StepName::new(self.plan, StepId(after - 1), ago)),
        }
    }
}
