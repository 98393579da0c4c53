//! Counts of fragment shader invocations.

use crate::base::Error;
use crate::gpu::Gpu;
use crate::prepare::view_mask;
use ash::vk;
use framewright_graph::plan::{Plan, Queue};
use std::sync::Arc;

/// What is said of secondary command buffers while a query is open.
pub(super) const COUNTED: &str =
    "secondary command buffers while fragments are counted, which they would have to inherit";

/// The counts of one frame: one for each batch whose queue draws.
///
/// Inside a scope with a view mask Vulkan takes a query for each view, and drivers differ on what a query around such a scope counts.
/// So the frames of a Plan with such a scope aren't counted.
pub(crate) struct FragmentCounts {
    gpu: Arc<Gpu>,
    pool: vk::QueryPool,
    batches: u32,
    /// The batch that is being recorded, and whether its fragments are counted.
    batch: u32,
    counts: bool,
}

impl FragmentCounts {
    /// Counts for the frames of `plan`, which are submitted in `batches` command buffers; `None` where the device can't count them.
    pub(crate) fn new(gpu: &Arc<Gpu>, plan: &Plan, batches: usize) -> Result<Option<FragmentCounts>, Error> {
        let mut scopes = plan.steps.iter().filter_map(|step| step.work.scope());
        let has_views = scopes.any(|scope| view_mask(plan, scope) != 0);
        let Some(batches) = u32::try_from(batches).ok().filter(|it| *it > 0) else { return Ok(None) };
        if has_views || !gpu.features.pipeline_statistics() {
            return Ok(None);
        }
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::PIPELINE_STATISTICS)
            .pipeline_statistics(vk::QueryPipelineStatisticFlags::FRAGMENT_SHADER_INVOCATIONS)
            .query_count(batches);
        // SAFETY: the device lives, and pipelineStatisticsQuery is on.
        let pool = unsafe { gpu.raw.create_query_pool(&info, None) }.map_err(Error::vulkan("counting fragments"))?;
        Ok(Some(FragmentCounts { gpu: gpu.clone(), pool, batches, batch: 0, counts: false }))
    }

    /// Resets all counts. The frame before must have been waited for.
    pub(crate) fn begin_frame(&mut self) {
        self.batch = 0;
        // SAFETY: hostQueryReset is on, and nothing uses the queries.
        unsafe { self.gpu.raw.reset_query_pool(self.pool, 0, self.batches) };
    }

    /// Begins to count in the command buffer of a batch.
    pub(crate) fn begin_batch(&mut self, commands: vk::CommandBuffer, queue: Queue) {
        let draws = self.gpu.queues.families.family(queue).flags.contains(vk::QueueFlags::GRAPHICS);
        self.counts = draws && self.batch < self.batches;
        if self.counts {
            // SAFETY: the command buffer is being recorded outside a scope, its queue draws, and the query was reset.
            unsafe {
                self.gpu.raw.cmd_begin_query(commands, self.pool, self.batch, vk::QueryControlFlags::empty());
            }
        }
    }

    /// Whether its query is open in the command buffer of the batch that is being recorded.
    pub(super) fn is_open(&self) -> bool {
        self.counts
    }

    /// Ends the count of a batch.
    pub(crate) fn end_batch(&mut self, commands: vk::CommandBuffer) {
        if self.counts {
            // SAFETY: the command buffer is being recorded outside a scope, and the query was begun in it.
            unsafe { self.gpu.raw.cmd_end_query(commands, self.pool, self.batch) };
        }
        self.batch += 1;
    }

    /// The sum over all batches.
    pub(super) fn read(&self) -> Result<u64, Error> {
        let mut values = vec![[0_u64; 2]; self.batches as usize];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
        // SAFETY: the frame was waited for; the flags ask for two times 64 bits each.
        match unsafe { self.gpu.raw.get_query_pool_results(self.pool, 0, &mut values, flags) } {
            // Batches of queues that don't draw have no count.
            Ok(()) | Err(vk::Result::NOT_READY) => {
                let counted = values.iter().filter(|[_, written]| *written != 0);
                Ok(counted.map(|[count, _]| *count).fold(0, u64::saturating_add))
            }
            Err(result) => Err(Error::vulkan("reading counts of fragments")(result)),
        }
    }
}

impl Drop for FragmentCounts {
    fn drop(&mut self) {
        if !self.gpu.is_abandoned() {
            // SAFETY: every frame was waited for.
            unsafe { self.gpu.raw.destroy_query_pool(self.pool, None) };
        }
    }
}
