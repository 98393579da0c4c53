//! Frames on their way: recorded, submitted to their queues, and waited for.

use super::frame_slot::{FrameEnd, FrameExtras, FrameSlot};
use super::import::Import;
use super::options::ExecutorOptions;
use super::promises::Promises;
use super::submission::{SemaphorePoint, Submission};
use crate::base::{Error, span};
use crate::commands::{Readback, Timeline};
use crate::gpu::{Gpu, PendingWork};
use crate::prepare::{Batch, Frame, PreparedPlan, batches, numbered, numbered_titles};
use crate::record::{DrawSource, FrameReport, Observers, report};
use ash::vk;
use framewright_graph::plan::{Plan, Queue};
use std::sync::Arc;
use std::time::Duration;

/// The name in messages of the wait for a frame.
const DRAWING: &str = "drawing a frame";

/// The frames in flight of one Plan.
pub(crate) struct Frames {
    gpu: Arc<Gpu>,
    timeout: Duration,
    batches: Vec<Batch>,
    /// Whether each batch, then a step, is waited for before the next is submitted.
    step_by_step: bool,
    /// The titles of the Plan's steps, for the error that breadcrumbs add to; empty without breadcrumbs, and after that error.
    titles: Vec<String>,
    /// One for each of the Plan's queues that it uses.
    timelines: Vec<(Queue, Timeline)>,
    /// Where the Plan uses no queue or several, the order of a frame and the program's semaphores: twice the frame's number and 1 when
    /// it may begin, and one more when it has ended.
    outer: Option<Timeline>,
    /// A frame's steps, and its end.
    values_per_frame: u64,
    slots: Vec<FrameSlot>,
    submitted: u64,
    /// Frames before the one of this number are done: the last of them was waited for.
    done: u64,
    /// The value that the outer timeline was waited for to reach.
    outer_done: u64,
    /// Memory for the waits of a batch, and for what it signals.
    waits: Vec<vk::SemaphoreSubmitInfo<'static>>,
    signals: Vec<vk::SemaphoreSubmitInfo<'static>>,
    /// The values that every timeline is waited for to reach: those of [`Frames::expect`].
    pending: PendingWork,
    /// The same of a timeline of the program's.
    given: PendingWork,
    /// What custom passes promise, if it is checked.
    promises: Option<Promises>,
}

impl Frames {
    /// Room for as many frames of `plan` in flight as `options` say, at least one.
    pub(crate) fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        imports: &[Import],
        options: &ExecutorOptions,
    ) -> Result<Frames, Error> {
        let extras: Vec<_> = imports.iter().filter_map(|it| it.wait.map(|wait| (it.first, wait))).collect();
        let promises = options.check_uses.then(|| Promises::new(gpu, plan)).transpose()?;
        // What another queue does beside a pass isn't the pass's.
        let several = plan.steps.iter().any(|step| step.queue != Queue::Graphics);
        let step_by_step = options.step_by_step || options.check_uses && several;
        let batches = batches(plan, &extras, step_by_step);
        let mut timelines = Vec::new();
        for queue in batches.iter().filter(|batch| batch.last).map(|batch| batch.queue) {
            timelines.push((queue, Timeline::new(gpu)?));
        }
        let outer = (timelines.len() != 1).then(|| Timeline::new(gpu)).transpose()?;
        let own = timelines.iter().map(|(_, timeline)| timeline);
        let semaphores: Vec<_> = own.chain(&outer).map(|timeline| timeline.raw).collect();
        let pending = PendingWork { values: vec![0; semaphores.len()], semaphores };
        let slots = 0..options.frames_in_flight.max(1);
        let slots = slots.map(|_| FrameSlot::new(gpu, plan, &batches, options, promises.as_ref()));
        Ok(Frames {
            gpu: gpu.clone(),
            timeout: options.timeout,
            step_by_step,
            titles: match options.breadcrumbs {
                true => numbered_titles(plan).collect(),
                false => Vec::new(),
            },
            timelines,
            outer,
            values_per_frame: plan.steps.len() as u64 + 1,
            slots: slots.collect::<Result<_, _>>()?,
            batches,
            submitted: 0,
            done: 0,
            outer_done: 0,
            waits: Vec::new(),
            signals: Vec::new(),
            pending,
            given: PendingWork { semaphores: vec![vk::Semaphore::null()], values: vec![0] },
            promises,
        })
    }

    /// How many frames were submitted: the number of the next one.
    pub(crate) fn next(&self) -> u64 {
        self.submitted
    }

    /// Waits until the next frame's place is free.
    pub(crate) fn make_room(&mut self) -> Result<(), Error> {
        let slot = self.slot_of(self.submitted);
        match self.slots[slot].frame {
            Some((frame, _)) => self.wait(frame),
            None => Ok(()),
        }
    }

    /// Records and submits the next frame, whose place must be free; its number must be that of [`Frames::next`].
    pub(crate) fn submit(
        &mut self,
        frame: &Frame<'_>,
        prepared: &PreparedPlan,
        source: &mut dyn DrawSource,
        extras: &FrameExtras<'_>,
        among: &Submission<'_>,
    ) -> Result<(), Error> {
        let at = self.begin(frame, extras)?;
        self.record(at, frame, prepared, source, extras)?;
        span!("submit", frame = frame.number);
        let mut outer = 0;
        // The program's waits, the batches, and the program's signals.
        let parts = self.batches.len() + 2;
        for part in 0..parts {
            let submitted = match part.checked_sub(1) {
                None => self.submit_outer_begin(frame.number, among, &mut outer),
                Some(batch) if batch < self.batches.len() => self.submit_batch(at, batch, frame.number, among),
                Some(_) => self.submit_outer_end(frame.number, among, &mut outer),
            };
            if let Err((result, counts)) = submitted {
                if part > 1 || outer > 0 || counts {
                    // Part of the frame is on its way and the rest will never come.
                    self.expect(part.saturating_sub(1).min(self.batches.len()), frame.number, outer);
                    self.gpu.abandon(&self.pending);
                }
                let error = self.at_step(frame.plan, part, Error::vulkan(DRAWING)(result));
                return Err(self.at_breadcrumbs(error));
            }
            if self.step_by_step && (1..=self.batches.len()).contains(&part) {
                self.expect(part, frame.number, outer);
                let done = self.gpu.wait_for(DRAWING, &self.pending, self.timeout);
                done.map_err(|error| self.at_step(frame.plan, part, error))?;
            }
        }
        self.end(at, frame.number, FrameEnd::Own { outer });
        Ok(())
    }

    fn record(
        &mut self,
        slot: usize,
        frame: &Frame<'_>,
        prepared: &PreparedPlan,
        source: &mut dyn DrawSource,
        extras: &FrameExtras<'_>,
    ) -> Result<(), Error> {
        span!("record", frame = frame.number);
        self.slots[slot].record(&self.batches, frame, prepared, source, extras)
    }

    /// The error of a part of a frame, with its step if each step is a part.
    fn at_step(&self, plan: &Plan, part: usize, error: Error) -> Error {
        let batch = part.checked_sub(1).and_then(|batch| self.batches.get(batch)).filter(|_| self.step_by_step);
        let Some(step) = batch.map(|batch| batch.steps.start) else { return error };
        Error::AtStep { step: numbered(plan, step, &plan.steps[step]), error: Box::new(error) }
    }

    /// The error of a wait, with the steps that the device was at if breadcrumbs tell: those of the oldest frame that isn't done.
    /// They are told once.
    fn at_breadcrumbs(&mut self, error: Error) -> Error {
        if !matches!(error, Error::Timeout { .. } | Error::DeviceLost { .. }) {
            return error;
        }
        let titles = std::mem::take(&mut self.titles);
        let frames = self.slots.iter().filter(|slot| !slot.finished);
        let frames = frames.filter_map(|slot| Some((slot.frame?.0, slot.observers.breadcrumbs.as_ref()?.running())));
        let oldest = frames.filter(|(_, steps)| !steps.is_empty()).min_by_key(|(frame, _)| *frame);
        let titles = oldest.iter().flat_map(|(_, steps)| steps).filter_map(|step| titles.get(*step));
        let titles: Vec<&str> = titles.map(String::as_str).collect();
        if titles.is_empty() {
            return error;
        }
        Error::AtStep { step: titles.join("; "), error: Box::new(error) }
    }

    /// Records the next frame into a command buffer of the program's, which tells by `done` when the device is done with it. Else as
    /// [`Frames::submit`].
    pub(crate) fn record_into(
        &mut self,
        (commands, done): (vk::CommandBuffer, SemaphorePoint),
        frame: &Frame<'_>,
        prepared: &PreparedPlan,
        source: &mut dyn DrawSource,
        extras: &FrameExtras<'_>,
    ) -> Result<(), Error> {
        let at = self.begin(frame, extras)?;
        match self.batches.as_slice() {
            [batch] if batch.queue == Queue::Graphics => {
                span!("record", frame = frame.number);
                self.slots[at].record_into(commands, batch, frame, prepared, source, extras)?;
            }
            [] => {}
            _ => {
                let what = match self.step_by_step {
                    true => "it is executed step by step, and a command buffer is submitted at once",
                    false => "it uses other queues than the one for graphics, and one command buffer goes to one queue",
                };
                return Err(Error::BadPlan { what: what.to_owned() });
            }
        }
        self.end(at, frame.number, FrameEnd::Given(done));
        Ok(())
    }

    /// Takes the next frame's place, which must be free.
    fn begin(&mut self, frame: &Frame<'_>, extras: &FrameExtras<'_>) -> Result<usize, Error> {
        let at = self.slot_of(frame.number);
        let slot = &mut self.slots[at];
        // Resources of the slot's frame before are no longer in use.
        slot.recorded.begin();
        slot.frame = None;
        if slot.outputs.len() < extras.readbacks.len() {
            slot.outputs = extras.readbacks.iter().map(|it| it.make(frame)).collect::<Result<_, _>>()?;
        }
        extras.readbacks.iter().zip(&mut slot.outputs).for_each(|(readback, to)| readback.reach(frame, to));
        Ok(at)
    }

    /// Notes that a frame is on its way.
    fn end(&mut self, at: usize, frame: u64, end: FrameEnd) {
        let slot = &mut self.slots[at];
        (slot.frame, slot.finished) = (Some((frame, end)), false);
        self.submitted += 1;
    }

    /// Submits one batch. Where that fails: whether it counts as submitted all the same.
    fn submit_batch(
        &mut self,
        slot: usize,
        number: usize,
        frame: u64,
        among: &Submission<'_>,
    ) -> Result<(), (vk::Result, bool)> {
        let batch = &self.batches[number];
        let (mut waits, mut signals) = (std::mem::take(&mut self.waits), std::mem::take(&mut self.signals));
        waits.clear();
        for wait in &batch.waits {
            // Before the first frame nothing is waited for.
            let Some(of) = frame.checked_sub(u64::from(wait.frames_ago)) else { continue };
            let awaited = self.batches.iter().find(|batch| batch.steps.contains(&(wait.step.0 as usize)));
            let Some(awaited) = awaited else { continue };
            let value = self.step_value(of, wait.step.0.into());
            waits.push(self.point(awaited.queue, value));
        }
        signals.clear();
        match &self.outer {
            // The first batch of each queue.
            Some(outer) if !among.waits.is_empty() => {
                if self.batches[..number].iter().all(|before| before.queue != batch.queue) {
                    waits.push(point(outer, outer_begin(frame)));
                }
            }
            Some(_) => {}
            None => {
                waits.extend(among.waits.iter().filter(|_| number == 0).map(SemaphorePoint::info));
                signals.extend(among.signals.iter().filter(|_| batch.last).map(SemaphorePoint::info));
            }
        }
        // Last, since drivers signal one after the other: who has waited for it may destroy the program's.
        signals.extend(self.signalled(batch, frame).map(|value| self.point(batch.queue, value)));
        let submitted = self.queue_submit(batch.queue, &waits, Some(self.slots[slot].commands[number].1), &signals);
        (self.waits, self.signals) = (waits, signals);
        submitted
    }

    /// Waits for the program's semaphores on behalf of all queues of the Plan, if there isn't just one.
    fn submit_outer_begin(
        &mut self,
        frame: u64,
        among: &Submission<'_>,
        reached: &mut u64,
    ) -> Result<(), (vk::Result, bool)> {
        let Some(outer) = self.outer.as_ref().filter(|_| !among.waits.is_empty()) else { return Ok(()) };
        let begin = [point(outer, outer_begin(frame))];
        self.waits.clear();
        self.waits.extend(among.waits.iter().map(SemaphorePoint::info));
        self.queue_submit(Queue::Graphics, &self.waits, None, &begin)?;
        *reached = outer_begin(frame);
        Ok(())
    }

    /// Signals the program's semaphores when all queues of the Plan are done, if there isn't just one.
    fn submit_outer_end(
        &mut self,
        frame: u64,
        among: &Submission<'_>,
        reached: &mut u64,
    ) -> Result<(), (vk::Result, bool)> {
        let Some(outer) = self.outer.as_ref().filter(|_| !among.signals.is_empty()) else { return Ok(()) };
        let (end, last) = ((frame + 1) * self.values_per_frame, outer_begin(frame) + 1);
        self.waits.clear();
        self.waits.extend(self.timelines.iter().map(|(_, timeline)| point(timeline, end)));
        self.waits.extend((*reached > 0).then(|| point(outer, *reached)));
        self.signals.clear();
        self.signals.extend(among.signals.iter().map(SemaphorePoint::info));
        self.signals.push(point(outer, last));
        self.queue_submit(Queue::Graphics, &self.waits, None, &self.signals)?;
        *reached = last;
        Ok(())
    }

    /// One submission to a queue of the Plan. Where that fails: whether it counts as submitted all the same.
    fn queue_submit(
        &self,
        queue: Queue,
        waits: &[vk::SemaphoreSubmitInfo<'_>],
        commands: Option<vk::CommandBuffer>,
        signals: &[vk::SemaphoreSubmitInfo<'_>],
    ) -> Result<(), (vk::Result, bool)> {
        let commands = commands.map(|commands| vk::CommandBufferSubmitInfo::default().command_buffer(commands));
        let submits = [vk::SubmitInfo2::default()
            .wait_semaphore_infos(waits)
            .command_buffer_infos(commands.as_slice())
            .signal_semaphore_infos(signals)];
        let queues = self.gpu.queues.lock();
        let queue =
            queues.of(self.gpu.queues.families.family(queue)).map_err(|_| (vk::Result::ERROR_UNKNOWN, false))?;
        // SAFETY: the commands are recorded, and what they use is kept until the frame was waited for; after a wait that
        // fails nothing is freed any more. The program has promised that its semaphores live and are in the right state.
        let submitted = unsafe { self.gpu.raw.queue_submit2(queue, &submits, vk::Fence::null()) };
        submitted.map_err(|result| (result, result == vk::Result::ERROR_DEVICE_LOST))
    }

    /// A point on a queue's timeline.
    fn point(&self, queue: Queue, value: u64) -> vk::SemaphoreSubmitInfo<'static> {
        let timeline = self.timelines.iter().find(|(of, _)| *of == queue);
        timeline.map_or_else(vk::SemaphoreSubmitInfo::default, |(_, timeline)| point(timeline, value))
    }

    /// The value that a timeline has when a step is done.
    fn step_value(&self, frame: u64, step: u64) -> u64 {
        frame * self.values_per_frame + step + 1
    }

    /// The value that a batch brings its queue's timeline to. That of the last one is the frame's end, later than any step.
    fn signalled(&self, batch: &Batch, frame: u64) -> Option<u64> {
        if batch.last {
            return Some((frame + 1) * self.values_per_frame);
        }
        batch.awaited.then(|| self.step_value(frame, batch.steps.end as u64 - 1))
    }

    /// Notes as pending what the timelines reach when the first `batches` batches of `frame` are done, and what `outer` does.
    fn expect(&mut self, batches: usize, frame: u64, outer: u64) {
        for number in 0..self.timelines.len() {
            let queue = self.timelines[number].0;
            let own = self.batches[..batches].iter().filter(|batch| batch.queue == queue);
            let value = own.filter_map(|batch| self.signalled(batch, frame)).max();
            self.pending.values[number] = value.unwrap_or(frame * self.values_per_frame);
        }
        if self.outer.is_some() {
            self.pending.values[self.timelines.len()] = outer;
        }
    }

    /// Waits until a frame that was submitted is done, and tells what custom passes did in it that they must not.
    pub(crate) fn wait(&mut self, frame: u64) -> Result<(), Error> {
        self.wait_until_done(frame)?;
        self.promises.as_mut().map_or(Ok(()), Promises::told)
    }

    /// Waits until a frame that was submitted is done.
    fn wait_until_done(&mut self, frame: u64) -> Result<(), Error> {
        let at = self.slot_of(frame);
        let end = match self.slots[at].frame {
            Some((there, end)) if there == frame && !self.slots[at].finished => end,
            _ => return Ok(()),
        };
        if self.gpu.is_abandoned() {
            return Err(self.at_breadcrumbs(Error::DeviceLost { doing: DRAWING }));
        }
        span!("wait", frame = frame);
        match end {
            FrameEnd::Own { outer } => {
                self.expect(self.batches.len(), frame, outer);
                let done = self.gpu.wait_for(DRAWING, &self.pending, self.timeout);
                done.map_err(|error| self.at_breadcrumbs(error))?;
                self.outer_done = self.outer_done.max(outer);
            }
            FrameEnd::Given(SemaphorePoint { semaphore, value, .. }) => {
                (self.given.semaphores[0], self.given.values[0]) = (semaphore, value);
                // The semaphore is the program's, and may be gone when the device ends: it is not kept.
                let done = self.gpu.wait_until(DRAWING, &self.given, self.timeout);
                done.inspect_err(|_| self.gpu.abandon(&PendingWork::default()))
                    .map_err(|error| self.at_breadcrumbs(error))?;
            }
        }
        self.slots[at].finished = true;
        self.done = self.done.max(frame + 1);
        match &mut self.promises {
            Some(promises) => promises.look(&self.gpu, self.slots[at].observers.watch.as_ref()),
            None => Ok(()),
        }
    }

    /// Waits no more for a frame that the program was to submit.
    pub(crate) fn discard(&mut self, frame: u64) {
        let at = self.slot_of(frame);
        let slot = &mut self.slots[at];
        slot.finished |= matches!(slot.frame, Some((there, FrameEnd::Given(_))) if there == frame);
    }

    /// Tells from now on what frames of an earlier executor, which were waited for, found out about custom passes and didn't tell.
    pub(super) fn take_promises(&mut self, before: &mut Frames) {
        if let (Some(promises), Some(before)) = (&mut self.promises, &mut before.promises) {
            promises.take_over(before);
        }
    }

    /// Waits for every frame that was submitted.
    pub(crate) fn wait_for_all(&mut self) -> Result<(), Error> {
        (0..self.slots.len())
            .try_for_each(|slot| self.slots[slot].frame.map_or(Ok(()), |(frame, _)| self.wait_until_done(frame)))
    }

    /// Whether all frames before this one are known to be done. Queues end frames in their order, so those before one that was waited for
    /// are; what signals the program's semaphores after such a frame may be yet to come.
    pub(super) fn are_done_before(&self, frame: u64) -> bool {
        let is_over = |end: FrameEnd| match end {
            FrameEnd::Own { outer } => outer <= self.outer_done,
            FrameEnd::Given(_) => true,
        };
        let is_done = |(number, end): (u64, FrameEnd)| number >= frame || number < self.done && is_over(end);
        self.slots.iter().all(|slot| slot.finished || slot.frame.is_none_or(is_done))
    }

    /// Whether a frame was submitted, and no later one has taken its place.
    pub(crate) fn holds(&self, frame: u64) -> bool {
        self.slots[self.slot_of(frame)].frame.is_some_and(|(there, _)| there == frame)
    }

    /// The report of a frame that was waited for, and whose place no later one has taken.
    pub(crate) fn report(&self, plan: &Plan, frame: u64) -> Result<FrameReport, Error> {
        let FrameSlot { observers: Observers { timing, fragments, .. }, recorded, .. } =
            &self.slots[self.slot_of(frame)];
        report(&self.gpu, plan, &self.batches, timing.as_ref(), fragments.as_ref(), recorded)
    }

    /// The kept contents of an output of a frame that was waited for.
    pub(crate) fn readback(&self, frame: u64, output: usize) -> Option<&Readback> {
        let slot = &self.slots[self.slot_of(frame)];
        if self.holds(frame) { slot.outputs.get(output) } else { None }
    }

    fn slot_of(&self, frame: u64) -> usize {
        usize::try_from(frame % self.slots.len() as u64).unwrap_or(0)
    }
}

impl Drop for Frames {
    fn drop(&mut self) {
        // A wait that fails has given the device up, and nothing is freed.
        let _ = self.wait_for_all();
    }
}

/// A point on a timeline, for all stages.
fn point(timeline: &Timeline, value: u64) -> vk::SemaphoreSubmitInfo<'static> {
    let stages = vk::PipelineStageFlags2::ALL_COMMANDS;
    vk::SemaphoreSubmitInfo::default().semaphore(timeline.raw).value(value).stage_mask(stages)
}

/// The value of the outer timeline when a frame may begin.
fn outer_begin(frame: u64) -> u64 {
    2 * frame + 1
}
