//! Frames on their way: recorded, submitted to their queues, and waited for.

use super::executor::ExecutorOptions;
use super::import::Import;
use super::output_readback::OutputReadback;
use crate::base::Error;
use crate::commands::{CommandPool, Readback, Timeline, record};
use crate::gpu::{Gpu, PendingWork};
use crate::prepare::{Batch, Frame, PreparedPlan, batches};
use crate::record::{CommandState, DrawSource, FragmentCounts, FrameReport, Recorded, Recording, Timing, report};
use ash::vk;
use framewright_graph::plan::{Plan, Queue};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The name in messages of the wait for a frame.
const DRAWING: &str = "drawing a frame";

/// The frames in flight of one Plan.
pub(crate) struct Frames {
    gpu: Arc<Gpu>,
    timeout: Duration,
    batches: Vec<Batch>,
    /// One for each of the Plan's queues that it uses.
    timelines: Vec<(Queue, Timeline)>,
    /// A frame's steps, and its end.
    values_per_frame: u64,
    slots: Vec<FrameSlot>,
    submitted: u64,
    /// Memory for the waits of a batch.
    waits: Vec<vk::SemaphoreSubmitInfo<'static>>,
    /// The values that every timeline is waited for to reach: those of [`Frames::expect`].
    pending: PendingWork,
}

/// The objects of one frame in flight.
struct FrameSlot {
    /// By batch.
    commands: Vec<(CommandPool, vk::CommandBuffer)>,
    /// If frames are timed.
    timing: Option<Timing>,
    /// If their fragments are counted.
    fragments: Option<FragmentCounts>,
    recorded: Recorded,
    /// By output, if they are kept.
    outputs: Vec<Readback>,
    frame: Option<u64>,
    finished: bool,
}

/// The imports and readbacks of a frame, which the Plan doesn't hold.
pub(crate) struct FrameExtras<'b> {
    pub(crate) imports: &'b [Import],
    /// By output, if they are kept.
    pub(crate) readbacks: &'b [OutputReadback],
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
        let batches = batches(plan, &extras);
        let mut timelines = Vec::new();
        for queue in batches.iter().filter(|batch| batch.last).map(|batch| batch.queue) {
            timelines.push((queue, Timeline::new(gpu)?));
        }
        let semaphores: Vec<_> = timelines.iter().map(|(_, timeline)| timeline.raw).collect();
        let pending = PendingWork { values: vec![0; semaphores.len()], semaphores };
        let slots = 0..options.frames_in_flight.max(1);
        let slots = slots.map(|_| FrameSlot::new(gpu, plan, &batches, options));
        Ok(Frames {
            gpu: gpu.clone(),
            timeout: options.timeout,
            timelines,
            values_per_frame: plan.steps.len() as u64 + 1,
            slots: slots.collect::<Result<_, _>>()?,
            batches,
            submitted: 0,
            waits: Vec::new(),
            pending,
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
            Some(frame) => self.wait(frame),
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
    ) -> Result<(), Error> {
        let at = self.slot_of(frame.number);
        let slot = &mut self.slots[at];
        // Resources of the slot's frame before are no longer in use.
        slot.recorded.begin();
        slot.frame = None;
        if slot.outputs.len() < extras.readbacks.len() {
            slot.outputs = extras.readbacks.iter().map(|it| it.make(frame)).collect::<Result<_, _>>()?;
        }
        slot.record(&self.batches, frame, prepared, source, extras)?;
        for number in 0..self.batches.len() {
            if let Err((result, submitted)) = self.submit_batch(at, number, frame.number) {
                if number > 0 || submitted {
                    // Part of the frame is on its way and the rest will never come.
                    self.expect(number, frame.number);
                    self.gpu.abandon(&self.pending);
                }
                return Err(Error::vulkan(DRAWING)(result));
            }
        }
        let slot = &mut self.slots[at];
        (slot.frame, slot.finished) = (Some(frame.number), false);
        self.submitted += 1;
        Ok(())
    }

    /// Submits one batch. Where that fails: whether it counts as submitted all the same.
    fn submit_batch(&mut self, slot: usize, number: usize, frame: u64) -> Result<(), (vk::Result, bool)> {
        let batch = &self.batches[number];
        let mut waits = std::mem::take(&mut self.waits);
        waits.clear();
        for wait in &batch.waits {
            // Before the first frame nothing is waited for.
            let Some(of) = frame.checked_sub(u64::from(wait.frames_ago)) else { continue };
            let awaited = self.batches.iter().find(|batch| batch.steps.contains(&(wait.step.0 as usize)));
            let Some(awaited) = awaited else { continue };
            let value = self.step_value(of, wait.step.0.into());
            waits.push(self.point(awaited.queue, value).stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS));
        }
        let signal = self
            .signalled(batch, frame)
            .map(|value| self.point(batch.queue, value).stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS));
        let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(self.slots[slot].commands[number].1)];
        let submits = [vk::SubmitInfo2::default()
            .wait_semaphore_infos(&waits)
            .command_buffer_infos(&buffers)
            .signal_semaphore_infos(signal.as_slice())];
        let queues = self.gpu.queues.lock();
        let queue =
            queues.of(self.gpu.queues.families.family(batch.queue)).map_err(|_| (vk::Result::ERROR_UNKNOWN, false))?;
        // SAFETY: the commands are recorded, and what they use is kept until the frame was waited for; after a wait that
        // fails nothing is freed any more.
        let submitted = unsafe { self.gpu.raw.queue_submit2(queue, &submits, vk::Fence::null()) };
        drop(queues);
        self.waits = waits;
        submitted.map_err(|result| (result, result == vk::Result::ERROR_DEVICE_LOST))
    }

    /// A point on a queue's timeline.
    fn point(&self, queue: Queue, value: u64) -> vk::SemaphoreSubmitInfo<'static> {
        let timeline = self.timelines.iter().find(|(of, _)| *of == queue).map(|(_, timeline)| timeline.raw);
        vk::SemaphoreSubmitInfo::default().semaphore(timeline.unwrap_or_default()).value(value)
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

    /// Notes as pending what the timelines reach when the first `batches` batches of `frame` are done.
    fn expect(&mut self, batches: usize, frame: u64) {
        for number in 0..self.timelines.len() {
            let queue = self.timelines[number].0;
            let own = self.batches[..batches].iter().filter(|batch| batch.queue == queue);
            let value = own.filter_map(|batch| self.signalled(batch, frame)).max();
            self.pending.values[number] = value.unwrap_or(frame * self.values_per_frame);
        }
    }

    /// Waits until a frame that was submitted is done.
    pub(crate) fn wait(&mut self, frame: u64) -> Result<(), Error> {
        let slot = self.slot_of(frame);
        if !self.holds(frame) || self.slots[slot].finished {
            return Ok(());
        }
        if self.gpu.is_abandoned() {
            return Err(Error::DeviceLost { doing: DRAWING });
        }
        self.expect(self.batches.len(), frame);
        self.gpu.wait_for(DRAWING, &self.pending, self.timeout)?;
        self.slots[slot].finished = true;
        Ok(())
    }

    /// Waits for every frame that was submitted.
    pub(crate) fn wait_for_all(&mut self) -> Result<(), Error> {
        let frames: Vec<u64> = self.slots.iter().filter_map(|slot| slot.frame).collect();
        frames.into_iter().try_for_each(|frame| self.wait(frame))
    }

    /// Whether a frame was submitted, and no later one has taken its place.
    pub(crate) fn holds(&self, frame: u64) -> bool {
        self.slots[self.slot_of(frame)].frame == Some(frame)
    }

    /// The report of a frame that was waited for, and whose place no later one has taken.
    pub(crate) fn report(&self, plan: &Plan, frame: u64) -> Result<FrameReport, Error> {
        let FrameSlot { timing, fragments, recorded, .. } = &self.slots[self.slot_of(frame)];
        report(&self.gpu, plan, &self.batches, timing.as_ref(), fragments.as_ref(), recorded)
    }

    /// The kept contents of an output of a frame that was waited for.
    pub(crate) fn readback(&self, frame: u64, output: usize) -> Option<&Readback> {
        let slot = &self.slots[self.slot_of(frame)];
        if slot.frame == Some(frame) { slot.outputs.get(output) } else { None }
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

impl FrameSlot {
    fn new(gpu: &Arc<Gpu>, plan: &Plan, batches: &[Batch], options: &ExecutorOptions) -> Result<FrameSlot, Error> {
        let commands = batches.iter().map(|batch| {
            let pool = CommandPool::new(gpu, batch.queue)?;
            let buffer = pool.buffer()?;
            Ok::<_, Error>((pool, buffer))
        });
        Ok(FrameSlot {
            commands: commands.collect::<Result<_, _>>()?,
            timing: options.timestamps.then(|| Timing::new(gpu, plan, batches.len())).transpose()?,
            fragments: match options.fragment_counts {
                true => FragmentCounts::new(gpu, plan, batches.len())?,
                false => None,
            },
            recorded: Recorded::default(),
            outputs: Vec::new(),
            frame: None,
            finished: false,
        })
    }

    /// Records all batches of a frame.
    fn record(
        &mut self,
        batches: &[Batch],
        frame: &Frame<'_>,
        prepared: &PreparedPlan,
        source: &mut dyn DrawSource,
        extras: &FrameExtras<'_>,
    ) -> Result<(), Error> {
        let begun = Instant::now();
        for (pool, _) in &self.commands {
            pool.reset()?;
        }
        if let Some(timing) = &mut self.timing {
            timing.begin_frame();
        }
        if let Some(fragments) = &mut self.fragments {
            fragments.begin_frame();
        }
        let (timing, fragments) = (self.timing.as_mut(), self.fragments.as_mut());
        let recorded = &mut self.recorded;
        let mut recording =
            Recording { frame, prepared, source, timing, fragments, recorded, state: CommandState::default() };
        for (batch, (_, buffer)) in batches.iter().zip(&self.commands) {
            record(frame.gpu, *buffer, |commands| {
                recording.begin_batch(commands, batch.queue);
                for step in batch.steps.clone() {
                    for import in extras.imports.iter().filter(|it| it.first.0 as usize == step) {
                        import.record(frame, commands);
                    }
                    recording.step(commands, step)?;
                    let readbacks = extras.readbacks.iter().zip(&self.outputs);
                    for (readback, into) in readbacks.filter(|(it, _)| it.after.0 as usize == step) {
                        readback.record(frame, commands, into);
                    }
                }
                recording.end_batch(commands);
                Ok(())
            })?;
        }
        self.recorded.end(begun.elapsed());
        Ok(())
    }
}
