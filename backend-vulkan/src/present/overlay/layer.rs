//! An overlay on the device: commands of its own behind each frame, which draw it into the image that is shown.

use super::picture::{Overlay, OverlayPicture, Place};
use super::pipeline::OverlayPipeline;
use super::texture::OverlayTexture;
use crate::base::Error;
use crate::commands::{CommandPool, Timeline, barriers, record};
use crate::gpu::{Gpu, PendingWork};
use crate::memory::{Image, ViewShape};
use crate::present::handle::SwapchainHandle;
use ash::vk;
use framewright_graph::device::ImageDescriptor;
use framewright_graph::plan::Queue;
use framewright_graph::vulkan::{Rotation, Shape, Sharing, Subresources, Usage};
use std::sync::Arc;
use std::time::Duration;

/// How long the last commands may take when it is dropped.
const TIMEOUT: Duration = Duration::from_secs(60);

const DOING: &str = "laying an overlay over a picture";

/// What lays overlays over the images of a window.
pub(crate) struct OverlayLayer {
    gpu: Arc<Gpu>,
    picture: Option<OverlayPicture>,
    /// Whether the texels aren't those on the device.
    stale: bool,
    drawn: Option<TargetImages>,
    pipeline: Option<OverlayPipeline>,
    texture: Option<OverlayTexture>,
    /// What the next commands draw, where.
    place: Option<Place>,
    /// Whether they upload what was staged.
    uploads: bool,
    /// The number of the last commands that uploaded texels; 0: none.
    uploaded: u64,
    /// Command buffers, one after the other.
    slots: Vec<(CommandPool, vk::CommandBuffer)>,
    timeline: Timeline,
    /// How many commands were submitted.
    submitted: u64,
    pending: PendingWork,
}

/// The images that it is laid over.
struct TargetImages {
    /// Views of them.
    views: Vec<(Image, vk::ImageView)>,
    /// Outlives the views.
    of: Arc<SwapchainHandle>,
}

impl OverlayLayer {
    pub(crate) fn new(gpu: &Arc<Gpu>) -> Result<OverlayLayer, Error> {
        let timeline = Timeline::new(gpu)?;
        let pending = PendingWork { semaphores: vec![timeline.raw], values: vec![0] };
        Ok(OverlayLayer {
            gpu: gpu.clone(),
            picture: None,
            stale: false,
            drawn: None,
            pipeline: None,
            texture: None,
            place: None,
            uploads: false,
            uploaded: 0,
            slots: Vec::new(),
            timeline,
            submitted: 0,
            pending,
        })
    }

    /// Takes another picture, or none.
    pub(crate) fn set(&mut self, overlay: Option<&Overlay<'_>>) -> Result<(), Error> {
        let Some(overlay) = overlay else {
            self.picture = None;
            return Ok(());
        };
        let limits = &self.gpu.limits;
        let [widest, highest] = limits.max_viewport_dimensions;
        overlay.check(limits.max_image_dimension2_d.min(widest).min(highest))?;
        match &mut self.picture {
            Some(picture) => self.stale |= picture.change(overlay),
            none => (*none, self.stale) = (Some(OverlayPicture::new(overlay)), true),
        }
        Ok(())
    }

    /// Makes ready to lay it over images of this swapchain. Returns whether any of it can be seen.
    pub(crate) fn ready(&mut self, swapchain: &Arc<SwapchainHandle>, timeout: Duration) -> Result<bool, Error> {
        self.place = None;
        let (format, rotation) = (swapchain.form.format, swapchain.form.rotation);
        let picture = self.picture.as_ref();
        let seen = picture.and_then(|it| Some((it.extent(rotation), it.place(swapchain.form.extent, rotation)?)));
        let Some((extent, place)) = seen else {
            self.release(timeout)?;
            return Ok(false);
        };
        if self.drawn.as_ref().is_none_or(|drawn| !Arc::ptr_eq(&drawn.of, swapchain)) {
            self.wait(self.submitted, timeout)?;
            // They may be turned otherwise than those before.
            (self.drawn, self.stale) = (Some(TargetImages::new(swapchain)?), true);
            while self.slots.len() <= swapchain.images.len() {
                let pool = CommandPool::new(&self.gpu, Queue::Graphics)?;
                let buffer = pool.buffer()?;
                self.slots.push((pool, buffer));
            }
        }
        if self.pipeline.as_ref().is_none_or(|pipeline| pipeline.format != format) {
            self.wait(self.submitted, timeout)?;
            self.pipeline = Some(OverlayPipeline::new(&self.gpu, format)?);
        }
        if self.texture.as_ref().is_none_or(|texture| !texture.fits(extent, format)) {
            self.wait(self.submitted, timeout)?;
            (self.texture, self.stale) = (Some(OverlayTexture::new(&self.gpu, extent, format)?), true);
        }
        if self.stale {
            self.stage(rotation, timeout)?;
        }
        self.place = Some(place);
        Ok(true)
    }

    /// Lets go of the images that it was laid over, and of its texels.
    fn release(&mut self, timeout: Duration) -> Result<(), Error> {
        if self.drawn.is_some() {
            self.wait(self.submitted, timeout)?;
            (self.drawn, self.texture) = (None, None);
        }
        Ok(())
    }

    /// Stages the texels for the next commands.
    fn stage(&mut self, rotation: Rotation, timeout: Duration) -> Result<(), Error> {
        self.wait(self.uploaded, timeout)?;
        if let (Some(texture), Some(picture)) = (&mut self.texture, &self.picture) {
            texture.stage(&picture.texels(rotation))?;
            (self.stale, self.uploads) = (false, true);
        }
        Ok(())
    }

    /// Draws it into an image of the swapchain that it was made ready for, once the frame is `done`, and signals that the image is
    /// `drawn`.
    pub(crate) fn lay_over(
        &mut self,
        image: u32,
        done: (vk::Semaphore, u64),
        drawn: vk::Semaphore,
        timeout: Duration,
    ) -> Result<(), Error> {
        let next = self.submitted + 1;
        let slots = self.slots.len() as u64;
        self.wait(next.saturating_sub(slots), timeout)?;
        let slot = usize::try_from(self.submitted % slots.max(1)).unwrap_or(0);
        let ready = (&self.drawn, &self.pipeline, &self.texture, self.place, self.slots.get(slot));
        let (Some(target), Some(pipeline), Some(texture), Some(place), Some((pool, commands))) = ready else {
            return Err(Error::BadResource { what: "the overlay of the window wasn't made ready".to_owned() });
        };
        let (gpu, uploads) = (&self.gpu, self.uploads);
        pool.reset()?;
        record(gpu, *commands, |commands| {
            if uploads {
                texture.record_upload(gpu, commands);
            }
            draw(gpu, commands, target.image(image), (pipeline, texture), place);
            Ok(())
        })?;
        self.submit(*commands, done, drawn)?;
        if std::mem::take(&mut self.uploads)
            && let Some(texture) = &mut self.texture
        {
            texture.uploaded();
            self.uploaded = self.submitted;
        }
        Ok(())
    }

    fn submit(
        &mut self,
        commands: vk::CommandBuffer,
        (done, value): (vk::Semaphore, u64),
        drawn: vk::Semaphore,
    ) -> Result<(), Error> {
        let point = |semaphore, value, stages| {
            vk::SemaphoreSubmitInfo::default().semaphore(semaphore).value(value).stage_mask(stages)
        };
        let (output, all) = (vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT, vk::PipelineStageFlags2::ALL_COMMANDS);
        let waits = [point(done, value, output)];
        let signals = [point(drawn, 0, all), point(self.timeline.raw, self.submitted + 1, all)];
        let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(commands)];
        let submits = [vk::SubmitInfo2::default()
            .wait_semaphore_infos(&waits)
            .command_buffer_infos(&buffers)
            .signal_semaphore_infos(&signals)];
        let queues = self.gpu.queues.lock();
        let queue = queues.of(self.gpu.queues.families.graphics)?;
        // SAFETY: the commands are recorded; what they use is kept until they were waited for, and the semaphores are those of an image
        // that was taken and that a frame draws.
        let submitted = unsafe { self.gpu.raw.queue_submit2(queue, &submits, vk::Fence::null()) };
        drop(queues);
        if let Err(result) = submitted {
            if result == vk::Result::ERROR_DEVICE_LOST {
                // Then, and only then, the commands count as submitted all the same.
                self.pending.values[0] = self.submitted + 1;
                self.gpu.abandon(&self.pending);
            }
            return Err(Error::vulkan(DOING)(result));
        }
        self.submitted += 1;
        Ok(())
    }

    /// Waits until the commands of this number are done; 0: nothing.
    fn wait(&mut self, number: u64, timeout: Duration) -> Result<(), Error> {
        if number == 0 {
            return Ok(());
        }
        self.pending.values[0] = number;
        self.gpu.wait_for(DOING, &self.pending, timeout)
    }
}

impl TargetImages {
    fn new(of: &Arc<SwapchainHandle>) -> Result<TargetImages, Error> {
        let form = &of.form;
        let blends = of.gpu.format_features(form.format).contains(vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND);
        if !blends || !form.usage.contains(vk::ImageUsageFlags::COLOR_ATTACHMENT) {
            let what =
                "nothing can be laid over the images of this window: nothing can be blended into them".to_owned();
            return Err(Error::BadResource { what });
        }
        let [width, height] = form.extent;
        let descriptor = ImageDescriptor {
            format: form.format,
            shape: Shape::D2,
            extent: [width, height, 1],
            mips: 1,
            layers: 1,
            samples: 1,
            usage: Usage::COLOR_ATTACHMENT,
            sharing: Sharing::Exclusive,
        };
        let view = |raw: &vk::Image| {
            // SAFETY: the swapchain made it so, and is kept.
            let image = unsafe { Image::foreign(&of.gpu, &descriptor, *raw) };
            let view = image.view(Subresources::all(form.format, 1, 1), ViewShape::Flat)?;
            Ok((image, view))
        };
        let views = of.images.iter().map(view).collect::<Result<_, Error>>()?;
        Ok(TargetImages { views, of: of.clone() })
    }

    /// An image, its view, and its extent.
    fn image(&self, number: u32) -> (vk::Image, vk::ImageView, [u32; 2]) {
        let (image, view) = &self.views[number as usize];
        (image.raw, *view, self.of.form.extent)
    }
}

/// Records the draw into an image that a frame has left as it is presented.
fn draw(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    (image, view, [width, height]): (vk::Image, vk::ImageView, [u32; 2]),
    (pipeline, texture): (&OverlayPipeline, &OverlayTexture),
    place: Place,
) {
    let presented = vk::ImageLayout::PRESENT_SRC_KHR;
    let drawn = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
    let output = vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT;
    let (read, write) = (vk::AccessFlags2::COLOR_ATTACHMENT_READ, vk::AccessFlags2::COLOR_ATTACHMENT_WRITE);
    let change = vk::ImageMemoryBarrier2::default()
        .image(image)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .subresource_range(vk::ImageSubresourceRange {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            level_count: 1,
            layer_count: 1,
            ..Default::default()
        })
        .src_stage_mask(output);
    let before = change.old_layout(presented).new_layout(drawn).dst_stage_mask(output).dst_access_mask(read | write);
    barriers(gpu, commands, &[], &[before]);
    let attachments = [vk::RenderingAttachmentInfo::default()
        .image_view(view)
        .image_layout(drawn)
        .load_op(vk::AttachmentLoadOp::LOAD)
        .store_op(vk::AttachmentStoreOp::STORE)];
    let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
    let rendering = vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&attachments);
    let [x, y, wide, high] = place.viewport;
    let viewport = vk::Viewport { x, y, width: wide, height: high, min_depth: 0.0, max_depth: 1.0 };
    let [x, y, wide, high] = place.scissor;
    let scissor = vk::Rect2D {
        offset: vk::Offset2D { x: x.cast_signed(), y: y.cast_signed() },
        extent: vk::Extent2D { width: wide, height: high },
    };
    let sets = [texture.set.raw];
    // SAFETY: recording outside a scope; image, pipeline and set live until the commands were waited for, the pipeline fits the image's
    // format and the set, all its dynamic state is set, and the numbers are within the limits of the device.
    unsafe {
        let device = &gpu.raw;
        device.cmd_begin_rendering(commands, &rendering);
        device.cmd_bind_pipeline(commands, vk::PipelineBindPoint::GRAPHICS, pipeline.raw);
        device.cmd_bind_descriptor_sets(commands, vk::PipelineBindPoint::GRAPHICS, pipeline.layout, 0, &sets, &[]);
        device.cmd_set_viewport(commands, 0, &[viewport]);
        device.cmd_set_scissor(commands, 0, &[scissor]);
        device.cmd_set_cull_mode(commands, vk::CullModeFlags::NONE);
        device.cmd_set_front_face(commands, vk::FrontFace::COUNTER_CLOCKWISE);
        device.cmd_draw(commands, 3, 1, 0, 0);
        device.cmd_end_rendering(commands);
    }
    barriers(gpu, commands, &[], &[change.src_access_mask(write).old_layout(drawn).new_layout(presented)]);
}

impl Drop for OverlayLayer {
    fn drop(&mut self) {
        // After a wait that fails the device is given up, and nothing is freed.
        if !self.gpu.is_abandoned() {
            let _ = self.wait(self.submitted, TIMEOUT);
        }
    }
}
