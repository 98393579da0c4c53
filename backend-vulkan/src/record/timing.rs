//! Timestamps, and the report of a frame.

use super::fragments::FragmentCounts;
use super::recorded_frame::{Counts, RecordedFrame};
use crate::base::Error;
use crate::gpu::Gpu;
use crate::prepare::{Batch, view_mask};
use ash::vk;
use framewright_graph::plan::{Plan, Queue, Work};
use std::sync::Arc;
use std::time::Instant;

/// Times of a frame and its steps.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameReport {
    /// Time on the device from the first step's barriers to the end of the last step, in milliseconds; with several queues,
    /// on the one that took longest. This and all times on the device are 0 without [`crate::ExecutorOptions::timestamps`].
    pub milliseconds: f64,
    /// Time that this thread took to record its commands, what the draw source did for it included, in milliseconds.
    pub recording_milliseconds: f64,
    /// When this thread began to record them.
    pub recording_began: Option<Instant>,
    /// How often fragment shaders ran, if [`crate::ExecutorOptions::fragment_counts`] is set. `None` without it, on a device that
    /// doesn't count them (`pipelineStatisticsQuery`), and for a Plan that draws several views at once.
    pub fragment_invocations: Option<u64>,
    /// By step of the Plan.
    pub steps: Vec<StepReport>,
}

/// Time of a step, and its passes.
#[derive(Debug, Clone, PartialEq)]
pub struct StepReport {
    /// From the end of the step before to the end of this one, its barriers included, but no wait for other queues. 0 on
    /// queues without timestamps, and where the step didn't run.
    pub milliseconds: f64,
    /// When that began, in nanoseconds of the device's clock, whose beginning means nothing: of two steps it tells how far they are apart. Vulkan
    /// promises so of steps of one queue. `None` where `milliseconds` isn't measured.
    pub began: Option<u64>,
    /// Whether its work was done; its barriers were recorded all the same.
    pub ran: bool,
    /// The passes of a rendering scope, a dispatch or a custom pass; empty for other steps.
    pub passes: Vec<PassReport>,
}

/// Time and draws of a pass.
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

/// The timestamps of one frame: one when each batch begins, one at the end of each pass, one at the end of each step.
pub(crate) struct Timing {
    gpu: Arc<Gpu>,
    pool: vk::QueryPool,
    queries: Queries,
    /// The next timestamp.
    next: u32,
    /// Bits that count on the queue that is being recorded.
    bits: u32,
}

/// Which queries the timestamps of a frame take.
///
/// Vulkan takes one query for a timestamp, and inside a scope with a view mask one for each view. Lavapipe 25 takes one for
/// each view after such a scope too. So each timestamp has a query for each view of the Plan's widest scope, wherever it is
/// taken: a driver that goes on to take as many as a scope of this Plan does writes over no other timestamp. Behind the last one
/// there is one for each view that the device can draw: a driver that goes on with a wider scope of another Plan may write over
/// the timestamps behind, and over no other memory.
#[derive(Debug, Clone, Copy)]
struct Queries {
    stamps: u32,
    /// Queries of each timestamp.
    views: u32,
    /// Queries behind those of the last timestamp.
    spare: u32,
}

impl Queries {
    /// Queries for the frames of `plan`, which are submitted in `batches` command buffers, on a device that draws
    /// `max_views` views at once.
    fn of(plan: &Plan, batches: usize, max_views: u32) -> Option<Queries> {
        let passes: usize = plan.steps.iter().map(|step| step.work.passes().len()).sum();
        let stamps = u32::try_from(batches + plan.steps.len() + passes).ok()?;
        let views = plan.steps.iter().map(|step| views(plan, &step.work)).max().unwrap_or(1);
        let queries = Queries { stamps, views, spare: max_views.max(1) };
        stamps.checked_mul(views)?.checked_add(queries.spare)?;
        Some(queries)
    }

    /// How many the pool has.
    fn count(self) -> u32 {
        self.stamps * self.views + self.spare
    }

    /// The first query of a timestamp.
    fn first(self, stamp: u32) -> u32 {
        stamp * self.views
    }
}

impl Timing {
    /// Timestamps for the frames of `plan`.
    pub(crate) fn new(gpu: &Arc<Gpu>, plan: &Plan, batches: usize) -> Result<Timing, Error> {
        let queries = Queries::of(plan, batches, gpu.max_views)
            .ok_or_else(|| Error::BadPlan { what: "it has too many passes to time them".to_owned() })?;
        let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(queries.count());
        // SAFETY: the device lives.
        let pool = unsafe { gpu.raw.create_query_pool(&info, None) }.map_err(Error::vulkan("making timestamps"))?;
        Ok(Timing { gpu: gpu.clone(), pool, queries, next: 0, bits: 0 })
    }

    /// Resets all timestamps. The frame before must have been waited for.
    pub(crate) fn begin_frame(&mut self) {
        self.next = 0;
        // SAFETY: hostQueryReset is on, and nothing uses the queries.
        unsafe { self.gpu.raw.reset_query_pool(self.pool, 0, self.queries.count()) };
    }

    /// Writes the first timestamp of a batch.
    pub(crate) fn begin_batch(&mut self, commands: vk::CommandBuffer, queue: Queue) {
        self.bits = self.gpu.queues.families.family(queue).timestamp_bits;
        self.stamp(commands);
    }

    /// Writes the next timestamp, once everything before it is done.
    pub(crate) fn stamp(&mut self, commands: vk::CommandBuffer) {
        if self.next < self.queries.stamps {
            if self.bits > 0 {
                let (stage, query) = (vk::PipelineStageFlags2::ALL_COMMANDS, self.queries.first(self.next));
                // SAFETY: the command buffer is being recorded, its queue has timestamps, and the queries of all views were
                // reset.
                unsafe { self.gpu.raw.cmd_write_timestamp2(commands, stage, self.pool, query) };
            }
            self.next += 1;
        }
    }

    /// The timestamps in their order, as far as they were written.
    fn read(&self) -> Result<Vec<Option<u64>>, Error> {
        Ok(self.values()?.chunks(self.queries.views as usize).map(time).collect())
    }

    /// The value of each timestamp query, and whether it was written.
    fn values(&self) -> Result<Vec<[u64; 2]>, Error> {
        let mut values = vec![[0_u64; 2]; self.queries.first(self.queries.stamps) as usize];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
        // SAFETY: the frame was waited for; the flags ask for two times 64 bits each.
        match unsafe { self.gpu.raw.get_query_pool_results(self.pool, 0, &mut values, flags) } {
            // Outside of scopes with a view mask only the first of a timestamp's queries is written, and queues without
            // timestamps write none.
            Ok(()) | Err(vk::Result::NOT_READY) => Ok(values),
            Err(result) => Err(Error::vulkan("reading timestamps")(result)),
        }
    }
}

/// The report of a frame that was `recorded` and waited for, with its times if there is `timing`, and the count of its fragments if
/// there are `fragments`.
pub(crate) fn report(
    gpu: &Gpu,
    plan: &Plan,
    batches: &[Batch],
    timing: Option<&Timing>,
    fragments: Option<&FragmentCounts>,
    recorded: &RecordedFrame,
) -> Result<FrameReport, Error> {
    let mut counts = recorded.counts.iter().copied();
    let mut stamps = timing.map(Timing::read).transpose()?.unwrap_or_default().into_iter();
    let mut next = move || stamps.next().flatten();
    let mut queues: Vec<(Queue, Option<u64>, Option<u64>)> = Vec::new();
    let mut steps = Vec::new();
    for batch in batches {
        let clock = Clock::of(gpu, batch.queue);
        let mut step_began = next();
        if queues.iter().all(|(queue, ..)| *queue != batch.queue) {
            queues.push((batch.queue, step_began, step_began));
        }
        for (step, number) in plan.steps[batch.steps.clone()].iter().zip(batch.steps.clone()) {
            let ran = !recorded.left_out.contains(&number);
            let between = |from, to| if ran { clock.between(from, to) } else { 0.0 };
            let mut began = step_began;
            let mut reports = Vec::new();
            for pass in step.work.passes() {
                let ended = next();
                let milliseconds = between(began, ended);
                let Counts { draws, culled } = counts.next().unwrap_or_default();
                reports.push(PassReport { name: pass.name.to_string(), draws, culled, milliseconds });
                began = ended;
            }
            let ended = next();
            let began = step_began.filter(|_| ran && ended.is_some()).map(|ticks| clock.nanoseconds(ticks));
            steps.push(StepReport { milliseconds: between(step_began, ended), began, ran, passes: reports });
            step_began = ended;
        }
        if let Some((_, _, end)) = queues.iter_mut().find(|(queue, ..)| *queue == batch.queue) {
            *end = step_began;
        }
    }
    let spent = queues.into_iter().map(|(queue, from, to)| Clock::of(gpu, queue).between(from, to));
    let recording_milliseconds = recorded.took.as_secs_f64() * 1e3;
    let fragment_invocations = fragments.map(FragmentCounts::read).transpose()?;
    let milliseconds = spent.fold(0.0, f64::max);
    let recording_began = recorded.began;
    Ok(FrameReport { milliseconds, recording_milliseconds, recording_began, fragment_invocations, steps })
}

/// The time that a timestamp's queries hold. Vulkan writes it to one of them and may write 0 to the others.
fn time(queries: &[[u64; 2]]) -> Option<u64> {
    queries.iter().filter(|[_, written]| *written != 0).map(|[value, _]| *value).max()
}

/// How a queue's timestamps count.
struct Clock {
    /// Bits that count.
    mask: u64,
    /// Nanoseconds of a tick.
    period: f64,
}

impl Clock {
    fn of(gpu: &Gpu, queue: Queue) -> Clock {
        let bits = gpu.queues.families.family(queue).timestamp_bits;
        let mask = u64::MAX.unbounded_shr(64_u32.saturating_sub(bits));
        Clock { mask, period: f64::from(gpu.limits.timestamp_period) }
    }

    /// A timestamp in nanoseconds, exactly: a clock that has run for months has more digits than a floating-point number.
    fn nanoseconds(&self, ticks: u64) -> u64 {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "periods are positive, and below a second"
        )]
        let picoseconds = (self.period * 1e3).round() as u128;
        u64::try_from(u128::from(ticks & self.mask) * picoseconds / 1000).unwrap_or(u64::MAX)
    }

    /// Milliseconds from one timestamp to another; 0 if either is missing.
    fn between(&self, from: Option<u64>, to: Option<u64>) -> f64 {
        #[allow(clippy::cast_precision_loss, reason = "durations are far below 2^53 ticks")]
        let milliseconds = |from: u64, to: u64| (to.wrapping_sub(from) & self.mask) as f64 * self.period / 1e6;
        from.zip(to).map_or(0.0, |(from, to)| milliseconds(from, to))
    }
}

impl Drop for Timing {
    fn drop(&mut self) {
        if !self.gpu.is_abandoned() {
            // SAFETY: every frame was waited for.
            unsafe { self.gpu.raw.destroy_query_pool(self.pool, None) };
        }
    }
}

/// Queries that a timestamp inside a step takes.
fn views(plan: &Plan, work: &Work) -> u32 {
    work.scope().map_or(1, |scope| view_mask(plan, scope).count_ones().max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The queries that a driver writes which takes one for each of `views` views, whether inside a scope or not.
    fn written(queries: Queries, stamp: u32, views: u32) -> std::ops::Range<u32> {
        queries.first(stamp)..queries.first(stamp) + views
    }

    fn queries(views: u32) -> Queries {
        Queries { stamps: 7, views, spare: 6 }
    }

    #[test]
    fn timestamps_of_every_view_everywhere_stay_inside_the_query_pool() {
        // The view mask that an earlier scope of someone else left behind may be wider than any of the Plan.
        for (own, left_behind) in [(1, 1), (1, 2), (1, 6), (2, 2), (2, 6), (6, 6)] {
            let queries = queries(own);
            let last = (0..queries.stamps).map(|stamp| written(queries, stamp, left_behind).end).max();
            assert!(last <= Some(queries.count()), "{own} views, then {left_behind}: {last:?} of {}", queries.count());
        }
    }

    #[test]
    fn a_timestamp_of_every_view_writes_over_no_other_timestamp() {
        for views in [1, 2, 6] {
            let queries = queries(views);
            for stamp in 1..queries.stamps {
                assert!(written(queries, stamp - 1, views).end <= queries.first(stamp), "{views} views");
            }
        }
    }

    #[test]
    fn lv_10_a_timestamp_keeps_its_digits_whatever_the_clock_began_with() {
        let clock = Clock { mask: u64::MAX >> 1, period: 1.0 };
        assert_eq!(clock.nanoseconds(u64::MAX), u64::MAX >> 1);
        let slow = Clock { mask: u64::MAX, period: 52.083 };
        assert_eq!((slow.nanoseconds(1000), slow.nanoseconds(1001)), (52_083, 52_135));
        assert_eq!(slow.nanoseconds(u64::MAX), u64::MAX);
    }

    #[test]
    fn the_time_is_the_one_of_the_views_that_holds_it() {
        let (missing, zero, at) = ([0, 0], [0, 1], |time| [time, 1]);
        assert_eq!(time(&[missing]), None);
        assert_eq!(time(&[at(5), missing]), Some(5));
        assert_eq!(time(&[at(5), at(5)]), Some(5));
        assert_eq!(time(&[zero, at(5)]), Some(5));
    }
}
