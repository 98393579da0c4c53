//! Swapchains: the images that a surface shows one after the other.

use super::surface::{Surface, SurfaceHandle, presenting};
use crate::base::{Error, SLICE, convert};
use crate::commands::Timeline;
use crate::gpu::{Gpu, PendingWork, rotation_of_surface};
use ash::{khr, vk};
use framewright_graph::plan;
use framewright_graph::vulkan::{Format, Rotation};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How a swapchain is made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SwapchainOptions {
    /// Width and height of the pictures, where the surface leaves them to the program: X11 and Windows don't.
    pub extent: [u32; 2],
    /// Formats that will do, the best first; those of sRGB by default. Each is taken in sRGB's colour space: of UNORM formats the
    /// pipeline encodes the values itself.
    pub formats: Vec<Format>,
    /// When a picture is shown. A surface that lacks the mode waits for the screen ([`PresentMode::Fifo`]), which each one has.
    pub mode: PresentMode,
    /// How many images there are at least. The surface may have more.
    pub images: u32,
    /// Whether pictures are turned as the surface wants them (`preTransform`), which saves its compositor a pass where screens are
    /// mounted turned; see [`Swapchain::rotation`]. Else they are upright.
    pub turned: bool,
    /// How long an image may take to become free.
    pub timeout: Duration,
}

impl Default for SwapchainOptions {
    fn default() -> SwapchainOptions {
        SwapchainOptions {
            extent: [1280, 720],
            formats: vec![Format::R8G8B8A8_SRGB, Format::B8G8R8A8_SRGB],
            mode: PresentMode::Fifo,
            images: 3,
            turned: false,
            timeout: Duration::from_secs(10),
        }
    }
}

/// When a picture is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PresentMode {
    /// At the screen's next refresh, in order: no picture is left out and none tears.
    Fifo,
    /// As `Fifo`, but a late picture is shown at once, and may tear.
    FifoRelaxed,
    /// At the screen's next refresh the newest: pictures may be left out.
    Mailbox,
    /// At once: pictures may tear.
    Immediate,
}

/// The images that a surface shows. [`Executor::present`](crate::Executor::present) draws into them.
pub struct Swapchain {
    surface: Surface,
    options: SwapchainOptions,
    /// `None`: the surface has no area, as that of a minimised window.
    current: Option<Arc<SwapchainHandle>>,
    /// The images before, while the surface has no area.
    before: Option<Arc<SwapchainHandle>>,
    /// How many images were asked for.
    acquired: u64,
    /// Whether an image was taken that is never shown.
    broken: bool,
    pending: PendingWork,
}

/// Vulkan's swapchain.
pub(crate) struct SwapchainHandle {
    gpu: Arc<Gpu>,
    functions: khr::swapchain::Device,
    raw: vk::SwapchainKHR,
    pub(crate) images: Vec<vk::Image>,
    format: Format,
    /// Width and height of the images.
    extent: [u32; 2],
    usage: vk::ImageUsageFlags,
    rotation: Rotation,
    /// Signalled when an image is free, in turn; one more than there are images.
    free: Vec<vk::Semaphore>,
    /// By image: signalled when it is drawn.
    drawn: Vec<vk::Semaphore>,
    /// How many of the frames that were drawn into its images are done.
    done: Timeline,
    /// Outlives the swapchain.
    _surface: Arc<SurfaceHandle>,
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
pub(crate) enum Shown {
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
            acquired: 0,
            broken: false,
            pending: PendingWork { semaphores: vec![vk::Semaphore::null()], values: vec![0] },
        };
        swapchain.resize(options.extent)?;
        Ok(swapchain)
    }

    /// Makes the images anew: the window has another size, or [`Executor::present`](crate::Executor::present) said that they no
    /// longer fit. `extent` counts where the surface leaves the size to the program. Returns whether the surface has an area now.
    ///
    /// Executors keep the old images until they present again or are dropped; then all work of the graphics queue is waited for.
    ///
    /// # Errors
    /// Those of [`Swapchain::new`]. Nothing can be shown then until it succeeds.
    pub fn resize(&mut self, extent: [u32; 2]) -> Result<bool, Error> {
        self.options.extent = extent;
        // A surface has one swapchain at a time: the one before is known until another takes its place.
        let old = self.current.take().or_else(|| self.before.take());
        self.before.clone_from(&old);
        self.current = SwapchainHandle::new(&self.surface.handle, &self.options, old.as_deref())?.map(Arc::new);
        if self.current.is_some() {
            self.before = None;
        }
        (self.acquired, self.broken) = (0, false);
        Ok(self.current.is_some())
    }

    /// Chooses another present mode, from the next [`Swapchain::resize`] on.
    pub fn set_mode(&mut self, mode: PresentMode) {
        self.options.mode = mode;
    }

    /// The format of the images; `None` while the surface has no area.
    #[must_use]
    pub fn format(&self) -> Option<Format> {
        self.current.as_ref().map(|current| current.format)
    }

    /// Width and height of the upright picture, in texels; `None` while the surface has no area.
    #[must_use]
    pub fn extent(&self) -> Option<[u32; 2]> {
        self.current.as_ref().map(|current| current.rotation.extent(current.extent))
    }

    /// The rotation of the pictures that it shows; see [`SwapchainOptions::turned`].
    #[must_use]
    pub fn rotation(&self) -> Rotation {
        self.current.as_ref().map_or(Rotation::Identity, |current| current.rotation)
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
        let Some(current) = self.current.as_ref().filter(|_| !self.broken) else { return Ok(None) };
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
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => return Ok(None),
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
    pub(crate) fn show(&mut self, image: &FreeImage) -> Result<Shown, Error> {
        const DOING: &str = "showing an image in the window";
        let Some(current) = &self.current else { return Ok(Shown::OutOfDate) };
        let (waits, swapchains, numbers) = ([image.drawn], [current.raw], [image.number]);
        let info =
            vk::PresentInfoKHR::default().wait_semaphores(&waits).swapchains(&swapchains).image_indices(&numbers);
        let queues = current.gpu.queues.lock();
        let queue = queues.of(current.gpu.queues.families.graphics)?;
        // SAFETY: the image was taken, and a frame that was submitted leaves it as it is presented and signals the semaphore.
        match unsafe { current.functions.queue_present(queue, &info) } {
            Ok(false) if !image.suboptimal => Ok(Shown::Right),
            Ok(_) => Ok(Shown::Suboptimal),
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => Ok(Shown::OutOfDate),
            Err(result) => Err(presenting(DOING)(result)),
        }
    }

    /// Gives up an image that was taken and won't be drawn: only new images can be shown.
    pub(crate) fn give_up(&mut self) {
        self.broken = true;
    }
}

impl SwapchainHandle {
    /// `None` if the surface has no area.
    fn new(
        surface: &Arc<SurfaceHandle>,
        options: &SwapchainOptions,
        old: Option<&SwapchainHandle>,
    ) -> Result<Option<SwapchainHandle>, Error> {
        let gpu = &surface.gpu;
        let capabilities = surface.capabilities()?;
        let rotation = match rotation_of_surface(capabilities.current_transform) {
            Some(rotation) if options.turned => rotation,
            _ => Rotation::Identity,
        };
        let Some(extent) = extent(&capabilities, rotation.extent(options.extent)) else { return Ok(None) };
        let offered = surface.formats()?;
        let (format, chosen) = format(&options.formats, &offered)?;
        let usage = usage(gpu, format, &capabilities);
        let mode = mode(options.mode);
        let mode = if surface.present_modes()?.contains(&mode) { mode } else { vk::PresentModeKHR::FIFO };
        let most = if capabilities.max_image_count == 0 { u32::MAX } else { capabilities.max_image_count };
        let transform = if options.turned && rotation_of_surface(capabilities.current_transform).is_some()
            || !capabilities.supported_transforms.contains(vk::SurfaceTransformFlagsKHR::IDENTITY)
        {
            capabilities.current_transform
        } else {
            vk::SurfaceTransformFlagsKHR::IDENTITY
        };
        let alpha = capabilities.supported_composite_alpha;
        let opaque = vk::CompositeAlphaFlagsKHR::OPAQUE;
        let alpha = if alpha.contains(opaque) { opaque } else { lowest(alpha) };
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface.raw)
            .min_image_count(options.images.clamp(capabilities.min_image_count, most))
            .image_format(chosen.format)
            .image_color_space(chosen.color_space)
            .image_extent(vk::Extent2D { width: extent[0], height: extent[1] })
            .image_array_layers(1)
            .image_usage(usage)
            .image_sharing_mode(vk::SharingMode::EXCLUSIVE)
            .pre_transform(transform)
            .composite_alpha(alpha)
            .present_mode(mode)
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
            format,
            extent,
            usage,
            rotation,
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
        Ok(Some(made))
    }

    /// Why its images can't be the image of a Plan; `None` if they can.
    pub(crate) fn unfit(&self, image: &plan::Image) -> Option<String> {
        let wanted = convert::usage(image.usage);
        let [width, height, _] = image.made();
        if image.format != self.format {
            return Some(format!("it is {}, and those of the window are {}", image.format, self.format));
        }
        if [width, height] != self.extent {
            let [own_width, own_height] = self.extent;
            return Some(format!(
                "it has {width}x{height} texels, and those of the window have {own_width}x{own_height}"
            ));
        }
        if image.samples > 1 || image.mips > 1 || image.made_layers() > 1 {
            return Some("it has several samples, mip levels or layers, and those of the window have one".to_owned());
        }
        if !self.usage.contains(wanted) {
            let lacking = wanted & !self.usage;
            return Some(format!("it is used as {lacking:?}, and those of the window can't be"));
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

/// The size of the images; `None` if the surface has no area.
fn extent(capabilities: &vk::SurfaceCapabilitiesKHR, wanted: [u32; 2]) -> Option<[u32; 2]> {
    let (least, most) = (capabilities.min_image_extent, capabilities.max_image_extent);
    let current = capabilities.current_extent;
    let [width, height] = if current.width == u32::MAX {
        [
            wanted[0].clamp(least.width, most.width.max(least.width)),
            wanted[1].clamp(least.height, most.height.max(least.height)),
        ]
    } else {
        [current.width, current.height]
    };
    (width > 0 && height > 0 && most.width > 0 && most.height > 0).then_some([width, height])
}

/// The first of the wanted formats that the surface has for sRGB's colour space.
fn format(wanted: &[Format], offered: &[vk::SurfaceFormatKHR]) -> Result<(Format, vk::SurfaceFormatKHR), Error> {
    let srgb = vk::ColorSpaceKHR::SRGB_NONLINEAR;
    let found = wanted.iter().find_map(|format| {
        let chosen = offered.iter().find(|it| it.format == convert::format(*format) && it.color_space == srgb)?;
        Some((*format, *chosen))
    });
    found.ok_or_else(|| {
        let list = |names: Vec<String>| names.join(", ");
        let wanted = list(wanted.iter().map(ToString::to_string).collect());
        let offered = list(offered.iter().map(|it| format!("{:?} in {:?}", it.format, it.color_space)).collect());
        Error::BadResource { what: format!("the window has none of the formats {wanted}; it has {offered}") }
    })
}

/// All that the images can be used for, of what Plans may ask for.
fn usage(gpu: &Gpu, format: Format, capabilities: &vk::SurfaceCapabilitiesKHR) -> vk::ImageUsageFlags {
    use vk::{FormatFeatureFlags as Has, ImageUsageFlags as Usage};
    let features = gpu.format_features(format);
    let pairs = [
        (Usage::COLOR_ATTACHMENT, Has::COLOR_ATTACHMENT),
        (Usage::INPUT_ATTACHMENT, Has::COLOR_ATTACHMENT),
        (Usage::SAMPLED, Has::SAMPLED_IMAGE),
        (Usage::STORAGE, Has::STORAGE_IMAGE),
        (Usage::TRANSFER_SRC, Has::TRANSFER_SRC),
        (Usage::TRANSFER_DST, Has::TRANSFER_DST),
    ];
    let possible = pairs.iter().filter(|(_, needs)| features.contains(*needs)).map(|(usage, _)| *usage);
    possible.fold(Usage::empty(), |all, usage| all | usage) & capabilities.supported_usage_flags
}

fn mode(mode: PresentMode) -> vk::PresentModeKHR {
    match mode {
        PresentMode::Fifo => vk::PresentModeKHR::FIFO,
        PresentMode::FifoRelaxed => vk::PresentModeKHR::FIFO_RELAXED,
        PresentMode::Mailbox => vk::PresentModeKHR::MAILBOX,
        PresentMode::Immediate => vk::PresentModeKHR::IMMEDIATE,
    }
}

/// The lowest of some bits.
fn lowest(alpha: vk::CompositeAlphaFlagsKHR) -> vk::CompositeAlphaFlagsKHR {
    let bits = alpha.as_raw();
    vk::CompositeAlphaFlagsKHR::from_raw(bits & bits.wrapping_neg())
}
