//! Swapchains: the images that a surface shows one after the other.

use super::form::SwapchainForm;
use super::handle::SwapchainHandle;
use super::options::{PresentMode, SwapchainOptions};
use super::surface::{Surface, presenting};
use crate::base::{Error, SLICE};
use crate::gpu::PendingWork;
use ash::vk;
use framewright_graph::vulkan::{Format, Rotation, Usage};
use std::sync::Arc;
use std::time::Instant;

/// The images that a surface shows. [`Executor::present`](crate::Executor::present) draws into them.
pub struct Swapchain {
    surface: Surface,
    options: SwapchainOptions,
    /// `None`: the surface has no area, as that of a minimised window.
    current: Option<Arc<SwapchainHandle>>,
    /// The images before, while the surface has no area.
    before: Option<Arc<SwapchainHandle>>,
    /// How images are used by all Plans that were to be shown.
    used: vk::ImageUsageFlags,
    /// How many images were asked for.
    acquired: u64,
    /// Whether no more images can be shown: one was taken that is never shown, or the surface has changed.
    spent: bool,
    /// Whether an image was shown that fitted the surface.
    was_right: bool,
    /// Whether images fitted, and no longer do: then new ones of the same form may fit better.
    stale: bool,
    pending: PendingWork,
}

/// An image that may be drawn into.
pub(crate) struct FreeImage {
    pub(crate) number: u32,
    /// Whether the surface has changed since the images were made. Some drivers say so only here.
    suboptimal: bool,
    /// Signalled when it is free.
    pub(crate) free: vk::Semaphore,
    /// To be signalled when it is drawn.
    pub(crate) drawn: vk::Semaphore,
    /// The timeline and its value, to be signalled as well.
    pub(crate) done: (vk::Semaphore, u64),
}

/// What became of an image that was shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PresentOutcome {
    /// It fits the surface.
    Right,
    /// The surface has changed and still shows it.
    Suboptimal,
    /// The surface has changed and doesn't show it.
    OutOfDate,
}

impl Swapchain {
    /// A swapchain for a surface, which has one at a time: drop another one first, and the executors that draw into it. One without an area, as that of a minimised window, gets it later, by [`Swapchain::resize`].
    ///
    /// # Errors
    /// [`Error::BadResource`] if the surface has none of the formats; [`Error::SurfaceLost`], [`Error::OutOfMemory`].
    pub fn new(surface: &Surface, options: &SwapchainOptions) -> Result<Swapchain, Error> {
        let mut swapchain = Swapchain {
            surface: surface.clone(),
            options: options.clone(),
            current: None,
            before: None,
            // Every Plan lets its outputs be read back.
            used: vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC,
            acquired: 0,
            spent: false,
            was_right: false,
            stale: false,
            pending: PendingWork { semaphores: vec![vk::Semaphore::null()], values: vec![0] },
        };
        swapchain.resize(options.extent)?;
        Ok(swapchain)
    }

    /// Makes the images anew if others would fit better: the window has another size, or
    /// [`Executor::present`](crate::Executor::present) said that they no longer fit. Where new ones would be no different, and these can
    /// still be shown, they stay. `extent` counts where the surface leaves the size to the program. Returns whether the surface has
    /// an area now.
    ///
    /// Executors keep the old images until they have presented others and the frames in the old ones are done, or until they are dropped.
    /// Then all work of the graphics queue is waited for.
    ///
    /// # Errors
    /// Those of [`Swapchain::new`]. Nothing can be shown then until it succeeds.
    pub fn resize(&mut self, extent: [u32; 2]) -> Result<bool, Error> {
        self.options.extent = extent;
        let form = SwapchainForm::of(&self.surface.handle, &self.options, self.used);
        if let (Ok(Some(form)), Some(current), false) = (&form, &self.current, self.spent || self.stale)
            && current.form == *form
        {
            return Ok(true);
        }
        // A surface has one swapchain at a time: the one before is known until another takes its place.
        let old = self.current.take().or_else(|| self.before.take());
        self.before.clone_from(&old);
        (self.acquired, self.spent, self.was_right, self.stale) = (0, false, false, false);
        let Some(form) = form? else { return Ok(false) };
        self.current = Some(Arc::new(SwapchainHandle::new(&self.surface.handle, form, old.as_deref())?));
        self.before = None;
        Ok(true)
    }

    /// Makes sure that images can be used in these ways, where the surface has such images. Returns whether they are otherwise as they
    /// were.
    pub(crate) fn allow(&mut self, usage: vk::ImageUsageFlags) -> Result<bool, Error> {
        let Some(before) = self.current.as_ref().map(|current| current.form) else { return Ok(true) };
        if self.used.contains(usage) {
            return Ok(true);
        }
        self.used |= usage;
        self.resize(self.options.extent)?;
        let now = self.current.as_ref().map(|current| SwapchainForm { usage: before.usage, ..current.form });
        Ok(now == Some(before))
    }

    /// Chooses another present mode, from the next [`Swapchain::resize`] on.
    pub fn set_mode(&mut self, mode: PresentMode) {
        self.options.mode = mode;
    }

    /// The format of the images; `None` while the surface has no area.
    #[must_use]
    pub fn format(&self) -> Option<Format> {
        self.current.as_ref().map(|current| current.form.format)
    }

    /// Width and height of the upright picture, in texels; `None` while the surface has no area.
    #[must_use]
    pub fn extent(&self) -> Option<[u32; 2]> {
        self.current.as_ref().map(|current| current.form.rotation.extent(current.form.extent))
    }

    /// The rotation of the pictures that it shows; see [`SwapchainOptions::turned`].
    #[must_use]
    pub fn rotation(&self) -> Rotation {
        self.current.as_ref().map_or(Rotation::Identity, |current| current.form.rotation)
    }

    /// How the images may be used: as a colour attachment and the source of copies, and as Plans that were shown need. Less where the
    /// surface has no such images.
    #[must_use]
    pub fn usage(&self) -> Usage {
        self.current.as_ref().map_or(Usage::empty(), |current| Usage::from_bits_retain(current.form.usage.as_raw()))
    }

    /// How many images there are; 0 while the surface has no area.
    #[must_use]
    pub fn images(&self) -> usize {
        self.current.as_ref().map_or(0, |current| current.images.len())
    }

    pub(crate) fn current(&self) -> Option<&Arc<SwapchainHandle>> {
        self.current.as_ref()
    }

    /// Takes the next image; `None`: the surface has changed and none can be shown. It must be drawn and shown, or
    /// [`Swapchain::give_up`] be called.
    pub(crate) fn acquire(&mut self) -> Result<Option<FreeImage>, Error> {
        const DOING: &str = "taking an image of the window";
        let Some(current) = self.current.as_ref().filter(|_| !self.spent) else { return Ok(None) };
        let (all, timeout) = (current.free.len() as u64, self.options.timeout);
        let next = self.acquired + 1;
        // The frame that used this semaphore last must be done with it.
        if let Some(before) = next.checked_sub(all).filter(|before| *before > 0) {
            (self.pending.semaphores[0], self.pending.values[0]) = (current.done.raw, before);
            current.gpu.wait_for(DOING, &self.pending, timeout)?;
        }
        let free = current.free[usize::try_from(self.acquired % all).unwrap_or(0)];
        let begun = Instant::now();
        let (number, suboptimal) = loop {
            let nanoseconds = u64::try_from(SLICE.as_nanos()).unwrap_or(u64::MAX);
            // SAFETY: swapchain and semaphore live, and nothing waits for or signals the semaphore any more.
            let taken =
                unsafe { current.functions.acquire_next_image(current.raw, nanoseconds, free, vk::Fence::null()) };
            match taken {
                Ok(taken) => break taken,
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => {
                    self.spent = true;
                    return Ok(None);
                }
                Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) if current.gpu.is_cancelled() => {
                    return Err(Error::Cancelled { doing: DOING });
                }
                Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) if begun.elapsed() < timeout => {}
                Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) => {
                    return Err(Error::Timeout { doing: DOING, seconds: timeout.as_secs() });
                }
                Err(result) => return Err(presenting(DOING)(result)),
            }
        };
        self.acquired = next;
        let drawn = current.drawn[number as usize];
        Ok(Some(FreeImage { number, suboptimal, free, drawn, done: (current.done.raw, next) }))
    }

    /// Shows an image that is being drawn.
    pub(crate) fn show(&mut self, image: &FreeImage) -> Result<PresentOutcome, Error> {
        const DOING: &str = "showing an image in the window";
        let Some(current) = &self.current else { return Ok(PresentOutcome::OutOfDate) };
        let (waits, swapchains, numbers) = ([image.drawn], [current.raw], [image.number]);
        let info =
            vk::PresentInfoKHR::default().wait_semaphores(&waits).swapchains(&swapchains).image_indices(&numbers);
        let queues = current.gpu.queues.lock();
        let queue = queues.of(current.gpu.queues.families.graphics)?;
        // SAFETY: the image was taken, and a frame that was submitted leaves it as it is presented and signals the semaphore.
        match unsafe { current.functions.queue_present(queue, &info) } {
            Ok(false) if !image.suboptimal => {
                self.was_right = true;
                Ok(PresentOutcome::Right)
            }
            Ok(_) => {
                // Images that fitted and no longer do are made anew; those that never did stay, as on a screen that is mounted turned.
                self.stale |= self.was_right;
                Ok(PresentOutcome::Suboptimal)
            }
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => {
                self.spent = true;
                Ok(PresentOutcome::OutOfDate)
            }
            Err(result) => {
                self.spent = true;
                Err(presenting(DOING)(result))
            }
        }
    }

    /// Gives up an image that was taken and won't be drawn: only new images can be shown.
    pub(crate) fn give_up(&mut self) {
        self.spent = true;
    }
}
