//! Commands that are recorded, submitted and waited for at once, and timelines that tell when work is done.

use crate::base::{Error, SLICE};
use crate::gpu::{Gpu, PendingWork};
use ash::vk;
use framewright_graph::plan::Queue;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long an upload or a readback may take.
pub(crate) const TRANSFER_TIMEOUT: Duration = Duration::from_secs(60);

/// A timeline semaphore.
pub(crate) struct Timeline {
    gpu: Arc<Gpu>,
    pub(crate) raw: vk::Semaphore,
}

impl Timeline {
    /// A timeline at 0.
    pub(crate) fn new(gpu: &Arc<Gpu>) -> Result<Timeline, Error> {
        let mut ty = vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
        let info = vk::SemaphoreCreateInfo::default().push_next(&mut ty);
        // SAFETY: the device lives.
        let raw =
            unsafe { gpu.raw.create_semaphore(&info, None) }.map_err(Error::vulkan("making a timeline semaphore"))?;
        Ok(Timeline { gpu: gpu.clone(), raw })
    }
}

impl Drop for Timeline {
    fn drop(&mut self) {
        if !self.gpu.is_abandoned() {
            // SAFETY: the submission that signals the semaphore is waited for before the semaphore is destroyed.
            unsafe { self.gpu.raw.destroy_semaphore(self.raw, None) };
        }
    }
}

impl Gpu {
    /// Waits until all semaphores have reached their values. After a wait that fails the device is given up: nothing is
    /// freed any more.
    pub(crate) fn wait_for(&self, doing: &'static str, work: &PendingWork, timeout: Duration) -> Result<(), Error> {
        self.wait_until(doing, work, timeout).inspect_err(|_| self.abandon(work))
    }

    /// Waits until all semaphores have reached their values. After a wait that fails the caller gives the device up.
    pub(crate) fn wait_until(&self, doing: &'static str, work: &PendingWork, timeout: Duration) -> Result<(), Error> {
        let info = vk::SemaphoreWaitInfo::default().semaphores(&work.semaphores).values(&work.values);
        let begun = Instant::now();
        loop {
            let left = timeout.saturating_sub(begun.elapsed());
            let nanoseconds = u64::try_from(left.min(SLICE).as_nanos()).unwrap_or(u64::MAX);
            // SAFETY: the semaphores live.
            match unsafe { self.raw.wait_semaphores(&info, nanoseconds) } {
                Ok(()) => return Ok(()),
                Err(vk::Result::TIMEOUT) if self.is_cancelled() => return Err(Error::Cancelled { doing }),
                Err(vk::Result::TIMEOUT) if left > SLICE => {}
                Err(vk::Result::TIMEOUT) => return Err(Error::Timeout { doing, seconds: timeout.as_secs() }),
                Err(result) => return Err(Error::vulkan(doing)(result)),
            }
        }
    }

    /// Records commands for `queue`, submits them and waits until they are done.
    pub(crate) fn submit_once(
        self: &Arc<Gpu>,
        doing: &'static str,
        queue: Queue,
        work: impl FnOnce(vk::CommandBuffer),
    ) -> Result<(), Error> {
        let mut commands = Commands::new(self, queue)?;
        commands.record(|buffer| {
            work(buffer);
            Ok(())
        })?;
        commands.submit(doing, TRANSFER_TIMEOUT)
    }
}

/// One command buffer with its pool and timeline, used again and again.
pub(crate) struct Commands {
    gpu: Arc<Gpu>,
    queue: Queue,
    pool: CommandPool,
    buffer: vk::CommandBuffer,
    timeline: Timeline,
    submitted: u64,
}

impl Commands {
    /// A command buffer for a queue.
    pub(crate) fn new(gpu: &Arc<Gpu>, queue: Queue) -> Result<Commands, Error> {
        let pool = CommandPool::new(gpu, queue)?;
        let (buffer, timeline) = (pool.buffer()?, Timeline::new(gpu)?);
        Ok(Commands { gpu: gpu.clone(), queue, pool, buffer, timeline, submitted: 0 })
    }

    /// Records without submitting.
    pub(crate) fn record<T>(&mut self, work: impl FnOnce(vk::CommandBuffer) -> Result<T, Error>) -> Result<T, Error> {
        self.pool.reset()?;
        record(&self.gpu, self.buffer, work)
    }

    /// Submits what was recorded and waits until the device is done.
    pub(crate) fn submit(&mut self, doing: &'static str, timeout: Duration) -> Result<(), Error> {
        if self.gpu.is_abandoned() {
            // Another thread gave it up since the commands were recorded.
            return Err(Error::DeviceLost { doing });
        }
        let value = self.submitted + 1;
        let work = PendingWork { semaphores: vec![self.timeline.raw], values: vec![value] };
        let signal = [vk::SemaphoreSubmitInfo::default()
            .semaphore(self.timeline.raw)
            .value(value)
            .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
        let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(self.buffer)];
        let submits = [vk::SubmitInfo2::default().command_buffer_infos(&buffers).signal_semaphore_infos(&signal)];
        let queues = self.gpu.queues.lock();
        let queue = queues.of(self.gpu.queues.families.family(self.queue))?;
        // SAFETY: the commands are recorded, and what they use outlives the wait below; after a wait that fails nothing is
        // freed any more.
        let submitted = unsafe { self.gpu.raw.queue_submit2(queue, &submits, vk::Fence::null()) };
        drop(queues);
        if let Err(result) = submitted {
            if result == vk::Result::ERROR_DEVICE_LOST {
                // Then, and only then, the commands count as submitted all the same.
                self.gpu.abandon(&work);
            }
            return Err(Error::vulkan(doing)(result));
        }
        self.submitted = value;
        self.gpu.wait_for(doing, &work, timeout)
    }
}

/// A pool of command buffers, which are all recorded anew at a time.
pub(crate) struct CommandPool {
    gpu: Arc<Gpu>,
    raw: vk::CommandPool,
}

impl CommandPool {
    /// A pool for a queue's family.
    pub(crate) fn new(gpu: &Arc<Gpu>, queue: Queue) -> Result<CommandPool, Error> {
        let family = gpu.queues.families.family(queue).index;
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(family);
        // SAFETY: the device lives and has the family.
        let raw =
            unsafe { gpu.raw.create_command_pool(&info, None) }.map_err(Error::vulkan("making a command pool"))?;
        Ok(CommandPool { gpu: gpu.clone(), raw })
    }

    /// A command buffer of the pool.
    pub(crate) fn buffer(&self) -> Result<vk::CommandBuffer, Error> {
        let doing = "making a command buffer";
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.raw).command_buffer_count(1);
        // SAFETY: the pool lives.
        let buffers = unsafe { self.gpu.raw.allocate_command_buffers(&info) }.map_err(Error::vulkan(doing))?;
        buffers.first().copied().ok_or(Error::Vulkan { doing, result: vk::Result::ERROR_UNKNOWN })
    }

    /// Makes all its command buffers ready to be recorded again. None may be in use.
    pub(crate) fn reset(&self) -> Result<(), Error> {
        const DOING: &str = "recording commands";
        if self.gpu.is_abandoned() {
            return Err(Error::DeviceLost { doing: DOING });
        }
        // SAFETY: the commands of the pool were waited for when they were submitted.
        unsafe { self.gpu.raw.reset_command_pool(self.raw, vk::CommandPoolResetFlags::empty()) }
            .map_err(Error::vulkan(DOING))
    }
}

impl Drop for CommandPool {
    fn drop(&mut self) {
        if !self.gpu.is_abandoned() {
            // SAFETY: each submission was waited for.
            unsafe { self.gpu.raw.destroy_command_pool(self.raw, None) };
        }
    }
}

/// Records `work` into a command buffer whose pool was reset.
pub(crate) fn record<T>(
    gpu: &Gpu,
    buffer: vk::CommandBuffer,
    work: impl FnOnce(vk::CommandBuffer) -> Result<T, Error>,
) -> Result<T, Error> {
    const DOING: &str = "recording commands";
    let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
    // SAFETY: the command buffer is not in use and its pool was reset.
    unsafe { gpu.raw.begin_command_buffer(buffer, &begin) }.map_err(Error::vulkan(DOING))?;
    let result = work(buffer)?;
    // SAFETY: the command buffer is being recorded.
    unsafe { gpu.raw.end_command_buffer(buffer) }.map_err(Error::vulkan(DOING))?;
    Ok(result)
}
