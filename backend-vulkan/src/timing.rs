//! Timestamps, and the report of a frame.

use crate::device::Shared;
use crate::error::Error;
use ash::vk;
use framewright_graph::plan::{Plan, Work};
use std::sync::Arc;

/// What a frame took.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameReport {
    /// Time on the device from the first step's barriers to the end of the last step, in milliseconds.
    pub milliseconds: f64,
    /// By step of the Plan.
    pub steps: Vec<StepReport>,
}

/// What a step took.
#[derive(Debug, Clone, PartialEq)]
pub struct StepReport {
    /// From the end of the step before to the end of this one, its barriers included.
    pub milliseconds: f64,
    /// The passes of a rendering scope; empty for other steps.
    pub passes: Vec<PassReport>,
}

/// What a pass took.
#[derive(Debug, Clone, PartialEq)]
pub struct PassReport {
    /// Its name.
    pub name: String,
    /// Draw calls.
    pub draws: u32,
    /// From the end of the pass before it in its scope, or of the step before, to its own end. Resolves and stores at the
    /// end of the scope are the step's. A device that draws in tiles can't tell the passes of one scope apart.
    pub milliseconds: f64,
}

/// The timestamps of one frame: one when it begins, one at the end of each pass, one at the end of each step.
pub(crate) struct Timing {
    shared: Arc<Shared>,
    pool: vk::QueryPool,
    count: u32,
    next: u32,
}

impl Timing {
    /// Timestamps for the frames of `plan`.
    pub(crate) fn new(shared: &Arc<Shared>, plan: &Plan) -> Result<Timing, Error> {
        let passes: usize = plan.steps.iter().map(|step| passes(&step.work).len()).sum();
        let count = u32::try_from(1 + plan.steps.len() + passes)
            .map_err(|_| Error::BadPlan { what: "it has too many passes to time them".to_owned() })?;
        let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(count);
        // SAFETY: the device lives.
        let pool = unsafe { shared.raw.create_query_pool(&info, None) }.map_err(Error::vulkan("making timestamps"))?;
        Ok(Timing { shared: shared.clone(), pool, count, next: 0 })
    }

    /// Resets all timestamps and writes the first.
    pub(crate) fn begin(&mut self, commands: vk::CommandBuffer) {
        self.next = 0;
        // SAFETY: the command buffer is being recorded outside a scope, and the frame before was waited for.
        unsafe { self.shared.raw.cmd_reset_query_pool(commands, self.pool, 0, self.count) };
        self.stamp(commands);
    }

    /// Writes the next timestamp, once everything before it is done.
    pub(crate) fn stamp(&mut self, commands: vk::CommandBuffer) {
        if self.next < self.count {
            let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
            // SAFETY: the command buffer is being recorded, and the query was reset in it.
            unsafe { self.shared.raw.cmd_write_timestamp2(commands, stage, self.pool, self.next) };
            self.next += 1;
        }
    }

    /// The report of the frame that was waited for. `draws` holds the draw calls of each pass in order.
    pub(crate) fn report(&self, plan: &Plan, draws: &[u32]) -> Result<FrameReport, Error> {
        let mut stamps = vec![0_u64; self.count as usize];
        // SAFETY: the frame was waited for and wrote all timestamps; the flag asks for 64 bits each.
        unsafe {
            let flags = vk::QueryResultFlags::TYPE_64;
            self.shared.raw.get_query_pool_results(self.pool, 0, &mut stamps, flags)
        }
        .map_err(Error::vulkan("reading timestamps"))?;
        let mask = u64::MAX.unbounded_shr(64_u32.saturating_sub(self.shared.timestamp_bits));
        let period = f64::from(self.shared.limits.timestamp_period);
        #[allow(clippy::cast_precision_loss, reason = "durations are far below 2^53 ticks")]
        let between = |from: u64, to: u64| (to.wrapping_sub(from) & mask) as f64 * period / 1e6;
        let mut draws = draws.iter().copied();
        let mut stamps = stamps.into_iter();
        let first = stamps.next().unwrap_or(0);
        let mut step_began = first;
        let mut steps = Vec::new();
        for step in &plan.steps {
            let mut began = step_began;
            let mut reports = Vec::new();
            for pass in passes(&step.work) {
                let ended = stamps.next().unwrap_or(began);
                reports.push(PassReport {
                    name: pass.name.to_string(),
                    draws: draws.next().unwrap_or(0),
                    milliseconds: between(began, ended),
                });
                began = ended;
            }
            let ended = stamps.next().unwrap_or(began);
            steps.push(StepReport { milliseconds: between(step_began, ended), passes: reports });
            step_began = ended;
        }
        Ok(FrameReport { milliseconds: between(first, step_began), steps })
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

/// The passes of a rendering scope.
fn passes(work: &Work) -> &[framewright_graph::plan::Pass] {
    match work {
        Work::Render(scope) => &scope.passes,
        _ => &[],
    }
}
