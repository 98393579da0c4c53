//! The texture of wgpu's that both draw into, and the semaphores by which they take turns.

use crate::gpu::Gpu;
use framewright::vulkan::ash::vk;
use framewright::{DrawSource, Renderer, SemaphorePoint, Submission};
use std::error::Error;
use wgpu::hal::api::Vulkan;

/// Width and height.
pub(crate) const EXTENT: [u32; 2] = [640, 360];

/// The format of the pipeline's output.
pub(crate) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// A timeline semaphore, and the value that was asked for last.
#[derive(Clone, Copy)]
struct Timeline(vk::Semaphore, u64);

/// What is shown.
pub(crate) struct Screen {
    texture: wgpu::Texture,
    /// Framewright's frames.
    drawn: Timeline,
    /// wgpu's submissions.
    shown: Timeline,
    pub(crate) gpu: Gpu,
}

impl Screen {
    pub(crate) fn new(gpu: Gpu) -> Result<Screen, Box<dyn Error>> {
        let [width, height] = EXTENT;
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("screen"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            // As the Plan says of it.
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let (drawn, shown) = (Timeline(gpu.timeline()?, 0), Timeline(gpu.timeline()?, 0));
        let mut screen = Screen { texture, drawn, shown, gpu };
        // wgpu clears a texture that it never drew into, whatever others have drawn there.
        let mut encoder = screen.encoder();
        drop(pass(&mut encoder, &screen.view(), wgpu::LoadOp::Clear(wgpu::Color::BLACK)));
        screen.submit(encoder)?;
        Ok(screen)
    }

    pub(crate) fn encoder(&self) -> wgpu::CommandEncoder {
        self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    pub(crate) fn view(&self) -> wgpu::TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// Has the texture take the place of the pipeline's `screen`.
    pub(crate) fn import_into(&self, renderer: &mut Renderer) -> Result<(), Box<dyn Error>> {
        // SAFETY: the texture is of this device, as the Plan says, and outlives the renderer.
        unsafe {
            let image = self.texture.as_hal::<Vulkan>().ok_or("no image of Vulkan's")?.raw_handle();
            Ok(renderer.executor_mut()?.import_image("screen", image)?)
        }
    }

    /// Has Framewright draw, after all that wgpu was given.
    pub(crate) fn draw(
        &mut self,
        renderer: &mut Renderer,
        objects: &mut dyn DrawSource,
    ) -> Result<(), framewright::Error> {
        self.drawn.1 += 1;
        let (waits, signals) = ([self.shown.point()], [self.drawn.point()]);
        let among = Submission { waits: &waits, signals: &signals, ..Submission::default() };
        // SAFETY: the semaphores live until the device has finished. Nobody reads the texture when the wait is over.
        unsafe { renderer.executor_mut()?.submit_with(objects, &among)? };
        Ok(())
    }

    /// Gives wgpu commands, which run after all that Framewright was given, and leave the texture as Framewright does: as a target.
    pub(crate) fn submit(&mut self, mut encoder: wgpu::CommandEncoder) -> Result<(), Box<dyn Error>> {
        let state = wgpu::TextureUses::COLOR_TARGET;
        let target = wgpu::TextureTransition { texture: &self.texture, selector: None, state };
        encoder.transition_resources(std::iter::empty(), std::iter::once(target));
        self.shown.1 += 1;
        // SAFETY: the semaphores live until the device has finished.
        unsafe {
            let queue = self.gpu.queue.as_hal::<Vulkan>().ok_or("no queue of Vulkan's")?;
            queue.add_wait_semaphore(self.drawn.0, Some(self.drawn.1), vk::PipelineStageFlags::ALL_COMMANDS);
            queue.add_signal_semaphore(self.shown.0, Some(self.shown.1));
        }
        self.gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Writes what is shown to a file.
    pub(crate) fn write(&mut self, path: &str) -> Result<(), Box<dyn Error>> {
        let [width, height] = EXTENT;
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        let size = u64::from(width * height * 4);
        let buffer = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
        let buffer = self.gpu.device.create_buffer(&buffer);
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 4), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        let mut encoder = self.encoder();
        encoder.copy_texture_to_buffer(self.texture.as_image_copy(), to, self.texture.size());
        self.submit(encoder)?;
        buffer.map_async(wgpu::MapMode::Read, .., |_| {});
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        std::fs::create_dir_all("out")?;
        image::save_buffer(path, &buffer.get_mapped_range(..)?, width, height, image::ExtendedColorType::Rgba8)?;
        Ok(())
    }
}

impl Timeline {
    fn point(self) -> SemaphorePoint {
        SemaphorePoint::timeline(self.0, self.1)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // SAFETY: nobody uses the device any more, which has finished then.
        unsafe {
            if self.gpu.raw().device_wait_idle().is_ok() {
                self.gpu.raw().destroy_semaphore(self.drawn.0, None);
                self.gpu.raw().destroy_semaphore(self.shown.0, None);
            }
        }
    }
}

/// A pass of wgpu's that draws into a view.
pub(crate) fn pass(
    encoder: &mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPass<'static> {
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    let target = wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
    let descriptor = wgpu::RenderPassDescriptor { color_attachments: &[Some(target)], ..Default::default() };
    encoder.begin_render_pass(&descriptor).forget_lifetime()
}
