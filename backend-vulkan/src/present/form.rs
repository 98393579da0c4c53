//! The form of a swapchain: what the options ask for, as far as the surface offers it.

use super::options::{PresentMode, SwapchainOptions};
use super::surface::SurfaceHandle;
use crate::base::{Error, convert, named};
use crate::gpu::{Gpu, rotation_of_surface};
use ash::vk;
use framewright_graph::vulkan::{Format, Rotation};

/// The colour space of all swapchains.
pub(super) const COLOR_SPACE: vk::ColorSpaceKHR = vk::ColorSpaceKHR::SRGB_NONLINEAR;

/// All that a swapchain is made with. Two of the same form are alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct SwapchainForm {
    pub(super) format: Format,
    /// Width and height of the images.
    pub(super) extent: [u32; 2],
    pub(super) usage: vk::ImageUsageFlags,
    pub(super) rotation: Rotation,
    pub(super) transform: vk::SurfaceTransformFlagsKHR,
    pub(super) alpha: vk::CompositeAlphaFlagsKHR,
    pub(super) mode: vk::PresentModeKHR,
    /// How many images there are at least.
    pub(super) images: u32,
}

impl SwapchainForm {
    /// The form of a swapchain for a surface as it is now, whose images are used in these ways where it has such images. `None` if it
    /// has no area.
    ///
    /// # Errors
    /// [`Error::BadResource`] if it has none of the formats; [`Error::SurfaceLost`].
    pub(super) fn of(
        surface: &SurfaceHandle,
        options: &SwapchainOptions,
        used: vk::ImageUsageFlags,
    ) -> Result<Option<SwapchainForm>, Error> {
        let capabilities = surface.capabilities()?;
        let wanted = rotation_of_surface(capabilities.current_transform).filter(|_| options.turned);
        let rotation = wanted.unwrap_or(Rotation::Identity);
        let Some(extent) = extent(&capabilities, rotation.extent(options.extent)) else { return Ok(None) };
        let format = format(&options.formats, &surface.formats()?)?;
        let mode = mode(options.mode);
        let mode = if surface.present_modes()?.contains(&mode) { mode } else { vk::PresentModeKHR::FIFO };
        let most = if capabilities.max_image_count == 0 { u32::MAX } else { capabilities.max_image_count };
        let identity = vk::SurfaceTransformFlagsKHR::IDENTITY;
        let transform = match wanted.is_some() || !capabilities.supported_transforms.contains(identity) {
            true => capabilities.current_transform,
            false => identity,
        };
        let alpha = capabilities.supported_composite_alpha;
        let opaque = vk::CompositeAlphaFlagsKHR::OPAQUE;
        Ok(Some(SwapchainForm {
            format,
            extent,
            usage: used & possible(&surface.gpu, format, &capabilities),
            rotation,
            transform,
            alpha: if alpha.contains(opaque) { opaque } else { lowest(alpha) },
            mode,
            images: options.images.clamp(capabilities.min_image_count, most),
        }))
    }
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
fn format(wanted: &[Format], offered: &[vk::SurfaceFormatKHR]) -> Result<Format, Error> {
    let has = |format: &&Format| {
        offered.iter().any(|it| it.format == convert::format(**format) && it.color_space == COLOR_SPACE)
    };
    wanted.iter().find(has).copied().ok_or_else(|| {
        let list = |names: Vec<String>| names.join(", ");
        let wanted = list(wanted.iter().map(ToString::to_string).collect());
        let offered =
            list(offered.iter().map(|it| format!("{} in {}", named(it.format), named(it.color_space))).collect());
        Error::BadResource { what: format!("the window has none of the formats {wanted}; it has {offered}") }
    })
}

/// All that the images can be used for, of what Plans may ask for.
fn possible(gpu: &Gpu, format: Format, capabilities: &vk::SurfaceCapabilitiesKHR) -> vk::ImageUsageFlags {
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
