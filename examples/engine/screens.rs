//! The images that frames are drawn into, and commands of the engine's own that copy them to the host.

use crate::gpu::Gpu;
use framewright::vulkan::SemaphorePoint;
use framewright::vulkan::ash::vk;
use std::error::Error;

/// A ring of images. Two timeline semaphores order frames and copies: a frame signals `drawn` with its number and 1, its copy
/// signals `copied` with the same value.
pub(crate) struct Screens<'g> {
    gpu: &'g Gpu,
    extent: [u32; 2],
    drawn: vk::Semaphore,
    copied: vk::Semaphore,
    pool: vk::CommandPool,
    pub(crate) screens: Vec<Screen>,
}

/// An image, and what copies it.
pub(crate) struct Screen {
    pub(crate) image: vk::Image,
    memory: vk::DeviceMemory,
    host: vk::Buffer,
    host_memory: vk::DeviceMemory,
    commands: vk::CommandBuffer,
}

impl<'g> Screens<'g> {
    /// Makes images as the Plan describes them.
    pub(crate) fn new(
        gpu: &'g Gpu,
        info: &vk::ImageCreateInfo<'_>,
        count: usize,
    ) -> Result<Screens<'g>, Box<dyn Error>> {
        let raw = &gpu.raw;
        let extent = [info.extent.width, info.extent.height];
        let (family, _) = gpu.graphics();
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        // SAFETY: the device lives.
        let pool = unsafe { raw.create_command_pool(&pool, None)? };
        let buffers = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(count as u32);
        // SAFETY: the pool is new.
        let buffers = unsafe { raw.allocate_command_buffers(&buffers)? };
        let screens = buffers.into_iter().map(|commands| Screen::new(gpu, info, commands)).collect::<Result<_, _>>()?;
        Ok(Screens { gpu, extent, drawn: timeline(gpu)?, copied: timeline(gpu)?, pool, screens })
    }

    /// What a frame waits for: the copy of the frame that was drawn into the same image.
    pub(crate) fn waits(&self, frame: u64) -> Option<SemaphorePoint> {
        let before = (frame + 1).checked_sub(self.screens.len() as u64).filter(|value| *value > 0)?;
        Some(SemaphorePoint::timeline(self.copied, before))
    }

    /// What it signals.
    pub(crate) fn signals(&self, frame: u64) -> SemaphorePoint {
        SemaphorePoint::timeline(self.drawn, frame + 1)
    }

    /// Copies what a frame has drawn, in a command buffer that waits for it.
    pub(crate) fn copy(&self, frame: u64) -> Result<(), Box<dyn Error>> {
        let raw = &self.gpu.raw;
        let screen = &self.screens[frame as usize % self.screens.len()];
        // The command buffer of this image is free when its last copy is done.
        if let Some(before) = self.waits(frame) {
            self.wait(before.value)?;
        }
        // In this layout the pipeline gives the image back.
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let layers = vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1);
        let [width, height] = self.extent;
        let region = vk::BufferImageCopy::default().image_subresource(layers).image_extent(vk::Extent3D {
            width,
            height,
            depth: 1,
        });
        let to_host = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::COPY)
            .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::HOST)
            .dst_access_mask(vk::AccessFlags2::HOST_READ)];
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(screen.commands)];
        let point = |semaphore| vk::SemaphoreSubmitInfo::default().semaphore(semaphore).value(frame + 1);
        let waits = [point(self.drawn).stage_mask(vk::PipelineStageFlags2::COPY)];
        let signals = [point(self.copied).stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
        let submit = vk::SubmitInfo2::default().command_buffer_infos(&commands);
        let submit = submit.wait_semaphore_infos(&waits).signal_semaphore_infos(&signals);
        // SAFETY: the frame was submitted, leaves the image in this layout, and nothing else uses the queue meanwhile.
        unsafe {
            raw.begin_command_buffer(screen.commands, &vk::CommandBufferBeginInfo::default())?;
            raw.cmd_copy_image_to_buffer(screen.commands, screen.image, layout, screen.host, &[region]);
            raw.cmd_pipeline_barrier2(screen.commands, &vk::DependencyInfo::default().memory_barriers(&to_host));
            raw.end_command_buffer(screen.commands)?;
            raw.queue_submit2(self.gpu.graphics().1, &[submit], vk::Fence::null())?;
        }
        Ok(())
    }

    /// The texels of a frame that was copied.
    pub(crate) fn read(&self, frame: u64) -> Result<Vec<u8>, Box<dyn Error>> {
        self.wait(frame + 1)?;
        let screen = &self.screens[frame as usize % self.screens.len()];
        let bytes = self.extent[0] as usize * self.extent[1] as usize * 4;
        let raw = &self.gpu.raw;
        // SAFETY: the copy is done, its memory is coherent and not mapped yet, and holds as many bytes.
        unsafe {
            let start = raw.map_memory(screen.host_memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?;
            let texels = std::slice::from_raw_parts(start.cast::<u8>(), bytes).to_vec();
            raw.unmap_memory(screen.host_memory);
            Ok(texels)
        }
    }

    fn wait(&self, value: u64) -> Result<(), vk::Result> {
        const SECOND: u64 = 1_000_000_000;
        let (semaphores, values) = ([self.copied], [value]);
        let info = vk::SemaphoreWaitInfo::default().semaphores(&semaphores).values(&values);
        // SAFETY: the semaphore lives.
        unsafe { self.gpu.raw.wait_semaphores(&info, 60 * SECOND) }
    }
}

impl Screen {
    fn new(gpu: &Gpu, info: &vk::ImageCreateInfo<'_>, commands: vk::CommandBuffer) -> Result<Screen, Box<dyn Error>> {
        let raw = &gpu.raw;
        let bytes = u64::from(info.extent.width) * u64::from(info.extent.height) * 4;
        let host = vk::BufferCreateInfo::default().size(bytes).usage(vk::BufferUsageFlags::TRANSFER_DST);
        let on_host = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: the device lives, and each memory has a type that image and buffer may have.
        unsafe {
            let image = raw.create_image(info, None)?;
            let on_device = vk::MemoryPropertyFlags::DEVICE_LOCAL;
            let memory = gpu.allocate(raw.get_image_memory_requirements(image), on_device)?;
            raw.bind_image_memory(image, memory, 0)?;
            let host = raw.create_buffer(&host, None)?;
            let host_memory = gpu.allocate(raw.get_buffer_memory_requirements(host), on_host)?;
            raw.bind_buffer_memory(host, host_memory, 0)?;
            Ok(Screen { image, memory, host, host_memory, commands })
        }
    }
}

/// A timeline semaphore at 0.
fn timeline(gpu: &Gpu) -> Result<vk::Semaphore, vk::Result> {
    let mut timeline = vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
    // SAFETY: the device lives.
    unsafe { gpu.raw.create_semaphore(&vk::SemaphoreCreateInfo::default().push_next(&mut timeline), None) }
}

impl Drop for Screens<'_> {
    fn drop(&mut self) {
        let raw = &self.gpu.raw;
        // SAFETY: the device is idle before anything is destroyed; if it is lost, nothing runs on it.
        unsafe {
            let _ = raw.device_wait_idle();
            for screen in &self.screens {
                raw.destroy_image(screen.image, None);
                raw.free_memory(screen.memory, None);
                raw.destroy_buffer(screen.host, None);
                raw.free_memory(screen.host_memory, None);
            }
            raw.destroy_command_pool(self.pool, None);
            raw.destroy_semaphore(self.drawn, None);
            raw.destroy_semaphore(self.copied, None);
        }
    }
}
