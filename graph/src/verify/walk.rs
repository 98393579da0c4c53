//! The walk over the steps, twice in a row.

use super::cells::{Cell, Cells, Contents, Lost, Write};
use super::clocks::{Availability, Clock, Clocks, Time};
use super::dependencies::{before_access, before_layout_change, makes_available};
use super::memory::Memory;
use super::scopes::{PairSet, StageSet};
use super::survey::Survey;
use super::touches::{self, Touch};
use super::violation::{Rule, StepName};
use super::{Finding, Findings};
use crate::plan::{ImageBarrier, ImageId, Plan, Role, Step, StepId, Subresources};
use crate::vocabulary::{Layout, State};

/// All that is known between two steps.
pub(super) struct Walk<'w, 'p> {
    pub(super) plan: &'p Plan,
    pub(super) found: &'w mut Findings<'p>,
    /// For each image: the first and the last step that touch it.
    pub(super) touched: &'w [Option<[u32; 2]>],
    pub(super) cells: Cells,
    pub(super) memory: Memory,
    clocks: Clocks,
    frame: u32,
    batch: Vec<(Clock, StageSet, PairSet)>,
    touches: Vec<Touch>,
}

/// Walks the steps of `plan` twice.
pub(super) fn twice<'p>(plan: &'p Plan, survey: &Survey, found: &mut Findings<'p>) {
    let mut walk = Walk {
        plan,
        found,
        touched: &survey.touched,
        cells: Cells::new(&plan.images, survey.ranges.iter().copied()),
        memory: Memory::new(plan),
        clocks: Clocks::default(),
        frame: 0,
        batch: Vec::new(),
        touches: Vec::new(),
    };
    for frame in 0..2 {
        walk.frame = frame;
        walk.begin_frame();
        for (id, step) in (0..).map(StepId).zip(&plan.steps) {
            walk.barriers(id, step);
            walk.work(id, step);
            walk.contents(id, step);
        }
        walk.end_frame();
    }
}

impl Walk<'_, '_> {
    fn begin_frame(&mut self) {
        let time = self.frame_start();
        for (image, before, ..) in outputs(self.plan) {
            let (stages, pairs) = scopes(before);
            for index in self.cells.all(image) {
                let cell = self.cells.at(index);
                cell.layout = before.layout;
                cell.contents = Contents::Unwritten;
                cell.writes.clear();
                cell.reads.clear();
                cell.excused = false;
                record_writes(cell, pairs, time);
                cell.reads.insert(stages, time);
            }
        }
    }

    /// Whoever gets the outputs finds them as the last step leaves them.
    fn end_frame(&mut self) {
        let last = StepId(length(self.plan) - 1);
        for (id, _, after, range) in outputs(self.plan) {
            let (stages, pairs) = scopes(after);
            let touch = Touch { image: id, range, layout: after.layout, stages, pairs, attachment: false };
            self.access(last, &touch);
            self.read(last, id, range);
        }
    }

    fn barriers(&mut self, id: StepId, step: &Step) {
        let now = self.now(id);
        let mut batch = std::mem::take(&mut self.batch);
        batch.clear();
        let mut beside = PairSet::default();
        for barrier in &step.memory_barriers {
            let source = PairSet::of(barrier.src_stages, barrier.src_accesses);
            let mut before = self.clocks.before(StageSet::of(barrier.src_stages).and_earlier(), now);
            before.make_available(source, now);
            beside = beside.union(source);
            let shown = PairSet::of(barrier.dst_stages, barrier.dst_accesses);
            batch.push((before, StageSet::of(barrier.dst_stages).and_later(), shown));
        }
        let mut last = None;
        for barrier in &step.image_barriers {
            let stages = (barrier.src_stages, barrier.dst_stages);
            // Neighbours mostly wait for the same stages: what came before those is then known already.
            if last != Some(stages) {
                let before = self.clocks.before(StageSet::of(barrier.src_stages).and_earlier(), now);
                batch.push((before, StageSet::of(barrier.dst_stages).and_later(), PairSet::default()));
                last = Some(stages);
            }
            if let Some((before, _, _)) = batch.last() {
                self.image_barrier(id, barrier, before, beside);
            }
        }
        // Barriers of one call don't order each other: none takes effect before all are judged.
        for (before, stages, shown) in &batch {
            self.clocks.hold_up(*stages, before);
            self.clocks.show(*shown, before);
        }
        self.batch = batch;
    }

    fn image_barrier(&mut self, id: StepId, barrier: &ImageBarrier, before: &Clock, beside: PairSet) {
        let source = PairSet::of(barrier.src_stages, barrier.src_accesses);
        let shown = PairSet::of(barrier.dst_stages, barrier.dst_accesses);
        let available = Availability { time: self.now(id), stages: StageSet::of(barrier.dst_stages).and_later() };
        let forgets = barrier.old_layout == Layout::Undefined;
        if forgets {
            self.occupy(id, barrier.image, barrier.range);
        }
        let occupation = self.memory.occupation(barrier.image);
        for index in self.cells.cover(barrier.image, barrier.range) {
            if !forgets {
                self.check_layout(id, barrier.image, index, barrier.old_layout);
                if barrier.old_layout == barrier.new_layout {
                    for write in &mut self.cells.at(index).writes {
                        if makes_available(write, before, source) {
                            write.visible = write.visible.union(shown);
                            write.became_available(available);
                        }
                    }
                    continue;
                }
            }
            let cell = self.cells.at(index);
            if cell.occupation != occupation {
                // What it did before it lost its bytes is what the image that took them had to wait for.
                self.check_hand_over(id, barrier.image, index, before, source.union(beside));
            } else if !cell.excused
                && let Some(gap) = before_layout_change(cell, before, source)
            {
                self.report(id, barrier.image, index, gap.rule(), gap.time);
            }
            let frame_start = self.frame_start();
            let cell = self.cells.at(index);
            cell.occupation = occupation;
            cell.layout = barrier.new_layout;
            cell.writes.clear();
            cell.writes.push(Write::layout_change(available, shown));
            cell.reads.clear();
            cell.excused = false;
            if forgets {
                cell.contents = match cell.contents {
                    Contents::Defined if cell.filled > frame_start => Contents::Lost(Lost::Forgotten, available.time),
                    Contents::Lost(_, time) if time > frame_start => cell.contents,
                    _ => Contents::Unwritten,
                };
            }
        }
    }

    fn work(&mut self, id: StepId, step: &Step) {
        let now = self.now(id);
        let mut touches = std::mem::take(&mut self.touches);
        touches::list(step, &mut touches);
        // Attachments of a scope are kept in order by rasterisation: its accesses are held against what came before
        // it, not against each other, and up to its own first write.
        for touch in touches.iter().filter(|touch| touch.attachment) {
            self.access(id, touch);
            let writes = touch.pairs.reads().is_empty();
            let cover = self.cells.cover(touch.image, touch.range).filter(|_| writes);
            cover.for_each(|index| self.cells.at(index).rasterised = now);
        }
        for touch in touches.iter().filter(|touch| !touch.attachment) {
            self.access(id, touch);
            self.record(touch, now);
        }
        for touch in touches.iter().filter(|touch| touch.attachment) {
            self.record(touch, now);
        }
        self.touches = touches;
    }

    fn access(&mut self, step: StepId, touch: &Touch) {
        for index in self.cells.cover(touch.image, touch.range) {
            self.check_layout(step, touch.image, index, touch.layout);
            let ordered = touch.attachment && self.cells.at(index).rasterised == self.now(step);
            let cell = self.cells.at(index);
            if !ordered
                && !cell.excused
                && let Some(gap) = before_access(cell, &self.clocks, touch.stages, touch.pairs)
            {
                cell.excused = true;
                self.report(step, touch.image, index, gap.rule(), gap.time);
            }
        }
    }

    fn record(&mut self, touch: &Touch, now: Time) {
        for index in self.cells.cover(touch.image, touch.range) {
            let cell = self.cells.at(index);
            record_writes(cell, touch.pairs, now);
            cell.reads.insert(touch.pairs.reads().stages(), now);
        }
    }

    fn check_layout(&mut self, step: StepId, image: ImageId, index: usize, needed: Layout) {
        let cell = self.cells.at(index);
        let found = std::mem::replace(&mut cell.layout, needed);
        if found != needed {
            cell.excused = true;
            let writes = cell.writes.iter().map(|write| write.time);
            let last = writes.chain(cell.reads.iter().map(|(_, time)| time)).max().unwrap_or(0);
            self.report(step, image, index, Rule::Layout { found, needed }, last);
        }
    }

    fn report(&mut self, step: StepId, image: ImageId, index: usize, rule: Rule, time: Time) {
        let range = Some(self.cells.range(self.plan.image(image), index));
        let other = self.name_at(time, image);
        self.found.push(Finding { rule, step, other, image, range, bytes: None });
    }

    /// The time of a step in the frame that is walked.
    pub(super) fn now(&self, step: StepId) -> Time {
        self.frame_start() + step.0 + 1
    }

    /// The time before the first step of the frame that is walked.
    pub(super) fn frame_start(&self) -> Time {
        self.frame * (length(self.plan) + 1)
    }

    /// The step at `time`; before the frame, the step that touched `image` last in the frame before.
    pub(super) fn name_at(&self, time: Time, image: ImageId) -> Option<StepName> {
        let frame = length(self.plan) + 1;
        let step = match time % frame {
            0 => return self.touched[image.0 as usize].map(|[_, last]| StepName::new(self.plan, StepId(last), true)),
            after => StepId(after - 1),
        };
        Some(StepName::new(self.plan, step, time / frame < self.frame))
    }
}

/// Number of steps. [`super::structure`] has seen to it that two walks can be numbered.
fn length(plan: &Plan) -> u32 {
    u32::try_from(plan.steps.len()).unwrap_or(u32::MAX / 4)
}

/// A write replaces what an earlier step did; the pairs of one step stand side by side.
fn record_writes(cell: &mut Cell, pairs: PairSet, now: Time) {
    for pair in pairs.writes().iter() {
        if cell.writes.first().is_some_and(|write| write.time != now || write.pair().is_none()) {
            cell.writes.clear();
            cell.reads.clear();
            cell.excused = false;
        }
        if cell.writes.iter().all(|write| write.pair() != Some(pair)) {
            cell.writes.push(Write::access(now, pair));
        }
    }
}

/// The outputs: image, state before the frame, state after it, all of the image.
fn outputs(plan: &Plan) -> impl Iterator<Item = (ImageId, State, State, Subresources)> + '_ {
    plan.images.iter().filter_map(|image| match image.role {
        Role::Transient(_) => None,
        Role::External { before, after } | Role::Persistent { before, after, .. } => {
            Some((image.id, before, after, Subresources::all(image.format, image.mips, image.layers)))
        }
    })
}

fn scopes(state: State) -> (StageSet, PairSet) {
    (StageSet::of(state.stages), PairSet::of(state.stages, state.accesses))
}
