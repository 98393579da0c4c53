//! Vulkan's swapchain, with its images and semaphores.

use super::form::{COLOR_SPACE, SwapchainForm};
use super::surface::{SurfaceHandle, presenting};
use crate::base::{Error, convert, named};
use crate::commands::Timeline;
use crate::gpu::Gpu;
use ash::{khr, vk};
use framewright_graph::plan;
use std::sync::Arc;

/// Vulkan's swapchain.
pub(crate) struct SwapchainHandle {
    pub(super) gpu: Arc<Gpu>,
    pub(super) functions: khr::swapchain::Device,
    pub(super) raw: vk::SwapchainKHR,
    pub(crate) images: Vec<vk::Image>,
    pub(super) form: SwapchainForm,
    /// Signalled when an image is free, in turn; one more than there are images.
    pub(super) free: Vec<vk::Semaphore>,
    /// By image: signalled when it is drawn.
    pub(super) drawn: Vec<vk::Semaphore>,
    /// How many of the frames that were drawn into its images are done.
    pub(super) done: Timeline,
    /// Outlives the swapchain.
    _surface: Arc<SurfaceHandle>,
}

impl SwapchainHandle {
    /// A swapchain of this form, in place of an old one.
    pub(super) fn new(
        surface: &Arc<SurfaceHandle>,
        form: SwapchainForm,
        old: Option<&SwapchainHandle>,
    ) -> Result<SwapchainHandle, Error> {
        let gpu = &surface.gpu;
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface.raw)
            .min_image_count(form.images)
            .image_format(convert::format(form.format))
            .image_color_space(COLOR_SPACE)
            .image_extent(vk::Extent2D { width: form.extent[0], height: form.extent[1] })
            .image_array_layers(1)
            .image_usage(form.usage)
            .image_sharing_mode(vk::SharingMode::EXCLUSIVE)
            .pre_transform(form.transform)
            .composite_alpha(form.alpha)
            .present_mode(form.mode)
            .clipped(true)
            .old_swapchain(old.map_or(vk::SwapchainKHR::null(), |old| old.raw));
        let functions = khr::swapchain::Device::new(&gpu.instance.raw, &gpu.raw);
        let done = Timeline::new(gpu)?;
        let alone = surface.alone();
        // SAFETY: the surface lives, can be presented to, offers all that is asked for, and no other thread has it meanwhile.
        let raw = unsafe { functions.create_swapchain(&info, None) }.map_err(presenting("making a swapchain"))?;
        drop(alone);
        let mut made = SwapchainHandle {
            gpu: gpu.clone(),
            functions,
            raw,
            images: Vec::new(),
            form,
            free: Vec::new(),
            drawn: Vec::new(),
            done,
            _surface: surface.clone(),
        };
        // SAFETY: the swapchain lives.
        made.images = unsafe { made.functions.get_swapchain_images(raw) }
            .map_err(presenting("asking for the images of a swapchain"))?;
        for _ in &made.images {
            made.drawn.push(semaphore(gpu)?);
        }
        for _ in 0..=made.images.len() {
            made.free.push(semaphore(gpu)?);
        }
        Ok(made)
    }

    /// Why its images can't be the image of a Plan; `None` if they can.
    pub(crate) fn unfit(&self, image: &plan::Image) -> Option<String> {
        let form = &self.form;
        let wanted = convert::usage(image.usage);
        let [width, height, _] = image.made();
        if image.format != form.format {
            return Some(format!("it is {}, and those of the window are {}", image.format, form.format));
        }
        if [width, height] != form.extent {
            let [own_width, own_height] = form.extent;
            return Some(format!(
                "it has {width}x{height} texels, and those of the window have {own_width}x{own_height}"
            ));
        }
        if image.samples > 1 || image.mips > 1 || image.made_layers() > 1 {
            return Some("it has several samples, mip levels or layers, and those of the window have one".to_owned());
        }
        if !form.usage.contains(wanted) {
            let lacking = wanted & !form.usage;
            return Some(format!("it is used as {}, and those of the window can't be", named(lacking)));
        }
        None
    }
}

impl Drop for SwapchainHandle {
    fn drop(&mut self) {
        if self.gpu.is_abandoned() {
            return;
        }
        let queues = self.gpu.queues.lock();
        let Ok(queue) = queues.of(self.gpu.queues.families.graphics) else { return };
        // SAFETY: the queue is locked. When it has nothing left to do, nothing waits for the semaphores any more, also no
        // presentation. Executors that drew into the images held on to this, and are done with them.
        unsafe {
            let _ = self.gpu.raw.queue_wait_idle(queue);
            for semaphore in self.free.drain(..).chain(self.drawn.drain(..)) {
                self.gpu.raw.destroy_semaphore(semaphore, None);
            }
            self.functions.destroy_swapchain(self.raw, None);
        }
    }
}

fn semaphore(gpu: &Gpu) -> Result<vk::Semaphore, Error> {
    // SAFETY: the device lives.
    unsafe { gpu.raw.create_semaphore(&vk::SemaphoreCreateInfo::default(), None) }
        .map_err(Error::vulkan("making a semaphore"))
}
