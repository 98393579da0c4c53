//! Timestamps, and the report of a frame.

use crate::batches::Batch;
use crate::device::Shared;
use crate::error::Error;
use crate::prepare_pass::view_mask;
use crate::record::Recorded;
use ash::vk;
use framewright_graph::plan::{Pass, Plan, Queue, Work};
use std::sync::Arc;

/// What a frame took.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameReport {
    /// Time on the device from the first step's barriers to the end of the last step, in milliseconds; with several queues,
    /// on the one that took longest.
    pub milliseconds: f64,
    /// Time that this thread took to record its commands, what the draw source did for it included, in milliseconds.
    pub recording_milliseconds: f64,
    /// By step of the Plan.
    pub steps: Vec<StepReport>,
}

/// What a step took.
#[derive(Debug, Clone, PartialEq)]
pub struct StepReport {
    /// From the end of the step before to the end of this one, its barriers included, but no wait for other queues. 0 on
    /// queues without timestamps.
    pub milliseconds: f64,
    /// The passes of a rendering scope, a dispatch or a custom pass; empty for other steps.
    pub passes: Vec<PassReport>,
}

/// What a pass took.
#[derive(Debug, Clone, PartialEq)]
pub struct PassReport {
    /// Its name.
    pub name: String,
    /// Draw calls, dispatches, or commands of a custom pass.
    pub draws: u32,
    /// Objects that the draw source left out because nothing of them can be seen; see [`crate::Recorder::count_culled`].
    pub culled: u32,
    /// From the end of the pass before it in its scope, or of the step before, to its own end. Resolves and stores at the
    /// end of the scope are the step's. A device that draws in tiles can't tell the passes of one scope apart.
    pub milliseconds: f64,
}

/// What was recorded for a pass.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counts {
    /// As in [`PassReport`].
    pub(crate) draws: u32,
    /// As in [`PassReport`].
    pub(crate) culled: u32,
}

/// The timestamps of one frame: one when each batch begins, one at the end of each pass, one at the end of each step. Inside
/// scopes that draw several views at once a timestamp takes a query for each of them.
pub(crate) struct Timing {
    shared: Arc<Shared>,
    pool: vk::QueryPool,
    count: u32,
    next: u32,
    /// Bits that count on the queue that is being recorded.
    bits: u32,
}

impl Timing {
    /// Timestamps for the frames of `plan`.
    pub(crate) fn new(shared: &Arc<Shared>, plan: &Plan, batches: usize) -> Result<Timing, Error> {
        let passes: usize = plan.steps.iter().map(|step| passes(&step.work).len() * views(plan, &step.work)).sum();
        let count = u32::try_from((batches + plan.steps.len() + passes).max(1))
            .map_err(|_| Error::BadPlan { what: "it has too many passes to time them".to_owned() })?;
        let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(count);
        // SAFETY: the device lives.
        let pool = unsafe { shared.raw.create_query_pool(&info, None) }.map_err(Error::vulkan("making timestamps"))?;
        Ok(Timing { shared: shared.clone(), pool, count, next: 0, bits: 0 })
    }

    /// Resets all timestamps. The frame before must have been waited for.
    pub(crate) fn begin_frame(&mut self) {
        self.next = 0;
        // SAFETY: hostQueryReset is on, and nothing uses the queries.
        unsafe { self.shared.raw.reset_query_pool(self.pool, 0, self.count) };
    }

    /// Writes the first timestamp of a batch.
    pub(crate) fn begin_batch(&mut self, commands: vk::CommandBuffer, queue: Queue) {
        self.bits = self.shared.queues.families.family(queue).timestamp_bits;
        self.stamp(commands);
    }

    /// Writes the next timestamp, once everything before it is done.
    pub(crate) fn stamp(&mut self, commands: vk::CommandBuffer) {
        self.stamp_views(commands, 1);
    }

    /// The same inside a scope that draws so many views at once.
    pub(crate) fn stamp_views(&mut self, commands: vk::CommandBuffer, views: u32) {
        if self.next + views <= self.count {
            if self.bits > 0 {
                let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
                // SAFETY: the command buffer is being recorded, its queue has timestamps, and the query was reset.
                unsafe { self.shared.raw.cmd_write_timestamp2(commands, stage, self.pool, self.next) };
            }
            self.next += views;
        }
    }

    /// The report of the frame that was waited for.
    pub(crate) fn report(&self, plan: &Plan, batches: &[Batch], recorded: &Recorded) -> Result<FrameReport, Error> {
        let stamps = self.stamps()?;
        let mut counts = recorded.counts.iter().copied();
        let mut stamps = stamps.into_iter().map(|[value, written]| (written != 0).then_some(value));
        let mut next = move || stamps.next().flatten();
        let mut queues: Vec<(Queue, Option<u64>, Option<u64>)> = Vec::new();
        let mut steps = Vec::new();
        for batch in batches {
            let clock = self.clock(batch.queue);
            let mut step_began = next();
            if queues.iter().all(|(queue, ..)| *queue != batch.queue) {
                queues.push((batch.queue, step_began, step_began));
            }
            for step in &plan.steps[batch.steps.clone()] {
                let mut began = step_began;
                let mut reports = Vec::new();
                let views = views(plan, &step.work);
                for pass in passes(&step.work) {
                    // Only one of the views' queries need have the time.
                    let ended = (0..views).filter_map(|_| next().filter(|stamp| *stamp > 0 || views == 1)).max();
                    let milliseconds = clock.between(began, ended);
                    let Counts { draws, culled } = counts.next().unwrap_or_default();
                    reports.push(PassReport { name: pass.name.to_string(), draws, culled, milliseconds });
                    began = ended;
                }
                let ended = next();
                steps.push(StepReport { milliseconds: clock.between(step_began, ended), passes: reports });
                step_began = ended;
            }
            if let Some((_, _, end)) = queues.iter_mut().find(|(queue, ..)| *queue == batch.queue) {
                *end = step_began;
            }
        }
        let spent = queues.into_iter().map(|(queue, from, to)| self.clock(queue).between(from, to));
        let recording_milliseconds = recorded.took.as_secs_f64() * 1e3;
        Ok(FrameReport { milliseconds: spent.fold(0.0, f64::max), recording_milliseconds, steps })
    }

    fn clock(&self, queue: Queue) -> Clock {
        let bits = self.shared.queues.families.family(queue).timestamp_bits;
        let mask = u64::MAX.unbounded_shr(64_u32.saturating_sub(bits));
        Clock { mask, period: f64::from(self.shared.limits.timestamp_period) }
    }

    /// Each timestamp, and whether it was written.
    fn stamps(&self) -> Result<Vec<[u64; 2]>, Error> {
        let mut stamps = vec![[0_u64; 2]; self.count as usize];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
        // SAFETY: the frame was waited for; the flags ask for two times 64 bits each.
        match unsafe { self.shared.raw.get_query_pool_results(self.pool, 0, &mut stamps, flags) } {
            // Queues without timestamps wrote none.
            Ok(()) | Err(vk::Result::NOT_READY) => Ok(stamps),
            Err(result) => Err(Error::vulkan("reading timestamps")(result)),
        }
    }
}

/// How a queue's timestamps count.
struct Clock {
    /// Bits that count.
    mask: u64,
    /// Nanoseconds of a tick.
    period: f64,
}

impl Clock {
    /// Milliseconds from one timestamp to another; 0 if either is missing.
    fn between(&self, from: Option<u64>, to: Option<u64>) -> f64 {
        #[allow(clippy::cast_precision_loss, reason = "durations are far below 2^53 ticks")]
        let milliseconds = |from: u64, to: u64| (to.wrapping_sub(from) & self.mask) as f64 * self.period / 1e6;
        from.zip(to).map_or(0.0, |(from, to)| milliseconds(from, to))
    }
}

impl Drop for Timing {
    fn drop(&mut self) {
        if !self.shared.is_abandoned() {
            // SAFETY: every frame was waited for.
            unsafe { self.shared.raw.destroy_query_pool(self.pool, None) };
        }
    }
}

/// The passes of a step.
fn passes(work: &Work) -> &[Pass] {
    match work {
        Work::Render(scope) => &scope.passes,
        Work::Dispatch(pass) | Work::Custom(pass) => std::slice::from_ref(pass),
        _ => &[],
    }
}

/// Queries that a timestamp inside a step takes.
fn views(plan: &Plan, work: &Work) -> usize {
    match work {
        Work::Render(scope) => view_mask(plan, scope).count_ones().max(1) as usize,
        _ => 1,
    }
}
