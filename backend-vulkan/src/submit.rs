//! Command buffers that are recorded, submitted and waited for.

use crate::device::Shared;
use crate::error::Error;
use ash::vk;
use std::sync::Arc;
use std::time::Duration;

/// How long an upload or a readback may take.
pub(crate) const TRANSFER_TIMEOUT: Duration = Duration::from_secs(60);

/// One command buffer with its pool and fence, used again and again.
pub(crate) struct Commands {
    shared: Arc<Shared>,
    pool: vk::CommandPool,
    buffer: vk::CommandBuffer,
    fence: vk::Fence,
}

impl Commands {
    /// A command buffer for the device's queue.
    pub(crate) fn new(shared: &Arc<Shared>) -> Result<Commands, Error> {
        const DOING: &str = "making a command buffer";
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(shared.queue_family);
        // SAFETY: the device lives.
        let pool = unsafe { shared.raw.create_command_pool(&info, None) }.map_err(Error::vulkan(DOING))?;
        let mut commands =
            Commands { shared: shared.clone(), pool, buffer: vk::CommandBuffer::null(), fence: vk::Fence::null() };
        let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
        // SAFETY: the pool was just made.
        let buffers = unsafe { shared.raw.allocate_command_buffers(&info) }.map_err(Error::vulkan(DOING))?;
        commands.buffer = buffers.first().copied().unwrap_or_default();
        // SAFETY: the device lives.
        commands.fence =
            unsafe { shared.raw.create_fence(&vk::FenceCreateInfo::default(), None) }.map_err(Error::vulkan(DOING))?;
        Ok(commands)
    }

    /// Records without submitting.
    pub(crate) fn record<T>(&mut self, work: impl FnOnce(vk::CommandBuffer) -> Result<T, Error>) -> Result<T, Error> {
        const DOING: &str = "recording commands";
        if self.shared.is_abandoned() {
            return Err(Error::DeviceLost { doing: DOING });
        }
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: each submission was waited for to its end, so nothing of the pool is in use.
        unsafe {
            let flags = vk::CommandPoolResetFlags::empty();
            self.shared.raw.reset_command_pool(self.pool, flags).map_err(Error::vulkan(DOING))?;
            self.shared.raw.begin_command_buffer(self.buffer, &begin).map_err(Error::vulkan(DOING))?;
        }
        let result = work(self.buffer)?;
        // SAFETY: the command buffer is being recorded.
        unsafe { self.shared.raw.end_command_buffer(self.buffer) }.map_err(Error::vulkan(DOING))?;
        Ok(result)
    }

    /// Submits what was recorded and waits until the device is done.
    pub(crate) fn submit(&mut self, doing: &'static str, timeout: Duration) -> Result<(), Error> {
        if self.shared.is_abandoned() {
            // Another thread gave it up since the commands were recorded.
            return Err(Error::DeviceLost { doing });
        }
        let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(self.buffer)];
        let submits = [vk::SubmitInfo2::default().command_buffer_infos(&buffers)];
        let nanoseconds = u64::try_from(timeout.as_nanos()).unwrap_or(u64::MAX);
        // SAFETY: the commands are recorded, and what they use outlives the wait below; after a wait that fails nothing
        // is freed any more.
        unsafe {
            self.shared.raw.reset_fences(&[self.fence]).map_err(Error::vulkan(doing))?;
            let queue = self.shared.queue();
            let submitted = self.shared.raw.queue_submit2(*queue, &submits, self.fence);
            drop(queue);
            if let Err(result) = submitted {
                if result == vk::Result::ERROR_DEVICE_LOST {
                    // Then, and only then, the commands count as submitted all the same.
                    self.shared.abandon(self.fence);
                }
                return Err(Error::vulkan(doing)(result));
            }
            match self.shared.raw.wait_for_fences(&[self.fence], true, nanoseconds) {
                Ok(()) => Ok(()),
                Err(vk::Result::TIMEOUT) => {
                    self.shared.abandon(self.fence);
                    Err(Error::Timeout { doing, seconds: timeout.as_secs() })
                }
                Err(result) => {
                    self.shared.abandon(self.fence);
                    Err(Error::vulkan(doing)(result))
                }
            }
        }
    }
}

impl Drop for Commands {
    fn drop(&mut self) {
        if !self.shared.is_abandoned() {
            // SAFETY: each submission was waited for.
            unsafe {
                self.shared.raw.destroy_fence(self.fence, None);
                self.shared.raw.destroy_command_pool(self.pool, None);
            }
        }
    }
}

impl Shared {
    /// Records commands, submits them and waits until they are done.
    pub(crate) fn submit_once(
        self: &Arc<Shared>,
        doing: &'static str,
        work: impl FnOnce(vk::CommandBuffer),
    ) -> Result<(), Error> {
        let mut commands = Commands::new(self)?;
        commands.record(|buffer| {
            work(buffer);
            Ok(())
        })?;
        commands.submit(doing, TRANSFER_TIMEOUT)
    }
}
