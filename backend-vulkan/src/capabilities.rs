//! What a physical device can do: the minimum that this crate needs, and a live [`Profile`].

use crate::convert;
use crate::depth_resolve::DepthResolve;
use crate::device::Shared;
use crate::features::Features;
use crate::queues::Families;
use ash::vk;
use framewright_graph::device::{
    BufferDescriptor, FormatSupport, ImageDescriptor, MemoryModel, MemoryProvider, Profile, Queues,
};
use framewright_graph::vulkan::{Format, Shape, Sharing, Usage};
use std::ffi::CStr;

/// The Vulkan version that devices and the loader must have.
pub const MINIMUM_VERSION: u32 = vk::API_VERSION_1_3;

/// Whether `physical` offers `VK_KHR_dynamic_rendering_local_read`.
pub(crate) fn has_local_read(instance: &ash::Instance, physical: vk::PhysicalDevice) -> bool {
    has_extension(instance, physical, ash::khr::dynamic_rendering_local_read::NAME)
        && Features::of(instance, physical, true).local_read()
}

/// Whether `physical` has the device extension of this name.
pub(crate) fn has_extension(instance: &ash::Instance, physical: vk::PhysicalDevice, name: &CStr) -> bool {
    // SAFETY: `physical` belongs to `instance`.
    let extensions = unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
    extensions.iter().any(|it| it.extension_name_as_c_str() == Ok(name))
}

/// All that `physical` lacks of the minimum, by Vulkan's names.
pub(crate) fn missing(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Vec<String> {
    // SAFETY: `physical` belongs to `instance`.
    let properties = unsafe { instance.get_physical_device_properties(physical) };
    if properties.api_version < MINIMUM_VERSION {
        // Its 1.3 features can't even be asked for.
        return vec![format!("Vulkan {} (it has {})", version(MINIMUM_VERSION), version(properties.api_version))];
    }
    let features = Features::of(instance, physical, false).missing();
    let mut missing: Vec<String> = features.iter().map(|name| format!("the feature {name}")).collect();
    match Families::of(instance, physical) {
        None => missing.push("a queue for graphics and compute".to_owned()),
        Some(families) if families.graphics.timestamp_bits == 0 => {
            missing.push("timestamps on its graphics queue".to_owned());
        }
        Some(_) => {}
    }
    missing
}

/// How many views a rendering scope of `physical`, which has these features, can draw at once, as it says.
pub(crate) fn max_views(instance: &ash::Instance, physical: vk::PhysicalDevice, features: &Features) -> u32 {
    let mut views = vk::PhysicalDeviceVulkan11Properties::default();
    let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut views);
    // SAFETY: `physical` belongs to `instance`, and the chained structure outlives the call.
    unsafe { instance.get_physical_device_properties2(physical, &mut all) };
    if features.multiview() { views.max_multiview_view_count } else { 1 }
}

/// A version in words.
pub(crate) fn version(packed: u32) -> String {
    let major = vk::api_version_major(packed);
    format!("{major}.{}.{}", vk::api_version_minor(packed), vk::api_version_patch(packed))
}

/// The capabilities of an open device, which resolves depth so, and draws several views at once if it says
/// that and `draws_views`.
pub(crate) fn profile(
    shared: &Shared,
    source: String,
    needs: &mut dyn MemoryProvider,
    depth_resolve: DepthResolve,
    draws_views: bool,
) -> Profile {
    let (instance, physical) = (&shared.instance.raw, shared.physical);
    let families = &shared.queues.families;
    // SAFETY: `physical` belongs to `instance`.
    let (properties, memory) = unsafe {
        (instance.get_physical_device_properties(physical), instance.get_physical_device_memory_properties(physical))
    };
    let limits = properties.limits;
    let features = Features::of(instance, physical, false);
    let formats: Vec<_> = Format::ALL.iter().filter_map(|format| support(instance, physical, *format)).collect();
    let model = MemoryModel::fitted(needs, &formats);
    Profile {
        name: crate::device::text(properties.device_name_as_c_str()),
        source,
        max_attachment_extent: [
            limits.max_framebuffer_width,
            limits.max_framebuffer_height,
            limits.max_image_dimension2_d,
            limits.max_viewport_dimensions[0],
            limits.max_viewport_dimensions[1],
        ]
        .into_iter()
        .min()
        .unwrap_or(0),
        max_extent_3d: limits.max_image_dimension3_d,
        max_layers: limits.max_image_array_layers,
        max_color_attachments: limits.max_color_attachments,
        lazily_allocated_memory: memory
            .memory_types_as_slice()
            .iter()
            .any(|ty| ty.property_flags.contains(vk::MemoryPropertyFlags::LAZILY_ALLOCATED)),
        queues: Queues {
            compute: families.compute.is_some(),
            transfer: families.transfer.is_some(),
            sharing: Sharing::Exclusive,
        },
        local_read: shared.local_read.is_some(),
        max_multiview_views: if draws_views { shared.max_views } else { 1 },
        refuted_multiview: features.multiview() && !draws_views,
        untested_multiview: false,
        vertex_layer: features.vertex_layer(),
        max_clip_distances: Some(if features.clip_distances() { limits.max_clip_distances } else { 0 }),
        depth_resolve: depth_resolve.has,
        refuted_depth_resolve: depth_resolve.refuted,
        refuted_layered_depth_resolve: depth_resolve.refuted_layered,
        untested_depth_resolve: depth_resolve.untested,
        memory: MemoryModel { heap_bytes: Some(crate::memory::largest_heap(shared, model.type_bits)), ..model },
        formats,
        known_needs: Vec::new(),
        unknown: Vec::new(),
    }
}

impl Shared {
    /// Whether the device can make an image of this description.
    pub(crate) fn can_make(&self, descriptor: &ImageDescriptor) -> bool {
        let [width, height, depth] = descriptor.extent;
        let levels = u32::BITS - width.max(height).max(depth).leading_zeros();
        let attachment = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT;
        let square = width == height && depth == 1 && descriptor.layers.is_multiple_of(6);
        let shaped = match descriptor.shape {
            Shape::D2 => depth == 1,
            Shape::D3 => descriptor.layers == 1 && descriptor.samples == 1 && !attachment.intersects(descriptor.usage),
            Shape::Cube => square && descriptor.samples == 1,
        };
        let may_be_asked = shaped
            && !descriptor.usage.is_empty()
            && (attachment.intersects(descriptor.usage) || !descriptor.usage.contains(Usage::TRANSIENT_ATTACHMENT))
            && descriptor.samples.is_power_of_two()
            && (descriptor.samples == 1 || descriptor.mips == 1)
            && descriptor.mips <= levels;
        if !may_be_asked {
            return false;
        }
        let info = crate::image::create_info(descriptor, &self.queues.families.indices);
        // SAFETY: the physical device belongs to the instance.
        let limits = unsafe {
            self.instance.raw.get_physical_device_image_format_properties(
                self.physical,
                info.format,
                info.image_type,
                info.tiling,
                info.usage,
                info.flags,
            )
        };
        limits.is_ok_and(|limits| {
            let most = [limits.max_extent.width, limits.max_extent.height, limits.max_extent.depth];
            descriptor.extent.iter().zip(most).all(|(extent, most)| (1..=most).contains(extent))
                && (1..=limits.max_mip_levels).contains(&descriptor.mips)
                && (1..=limits.max_array_layers).contains(&descriptor.layers)
                && limits.sample_counts.contains(convert::samples(descriptor.samples))
        })
    }

    /// Whether the device can make a buffer of this description.
    pub(crate) fn can_make_buffer(&self, descriptor: &BufferDescriptor) -> bool {
        let mut v1_3 = vk::PhysicalDeviceVulkan13Properties::default();
        let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut v1_3);
        // SAFETY: the physical device belongs to the instance, and the chained structure outlives the call.
        unsafe { self.instance.raw.get_physical_device_properties2(self.physical, &mut all) };
        (1..=v1_3.max_buffer_size.saturating_sub(3)).contains(&descriptor.bytes) && !descriptor.usage.is_empty()
    }

    /// What images of a format can do.
    pub(crate) fn format_features(&self, format: Format) -> vk::FormatFeatureFlags {
        let format = convert::format(format);
        // SAFETY: the physical device belongs to the instance.
        unsafe { self.instance.raw.get_physical_device_format_properties(self.physical, format) }
            .optimal_tiling_features
    }

    /// How rendering scopes can resolve depth and stencil.
    pub(crate) fn depth_stencil_resolve(&self) -> vk::PhysicalDeviceDepthStencilResolveProperties<'static> {
        let mut resolve = vk::PhysicalDeviceDepthStencilResolveProperties::default();
        let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut resolve);
        // SAFETY: the physical device belongs to the instance, and the chained structure outlives the call.
        unsafe { self.instance.raw.get_physical_device_properties2(self.physical, &mut all) };
        resolve.p_next = std::ptr::null_mut();
        resolve
    }
}

/// What one format can be; `None` if nothing.
fn support(instance: &ash::Instance, physical: vk::PhysicalDevice, format: Format) -> Option<FormatSupport> {
    let vk_format = convert::format(format);
    // SAFETY: `physical` belongs to `instance`.
    let features =
        unsafe { instance.get_physical_device_format_properties(physical, vk_format) }.optimal_tiling_features;
    use vk::FormatFeatureFlags as Feature;
    let uses = [
        (Feature::TRANSFER_SRC, Usage::TRANSFER_SRC),
        (Feature::TRANSFER_DST, Usage::TRANSFER_DST),
        (Feature::SAMPLED_IMAGE, Usage::SAMPLED),
        (Feature::STORAGE_IMAGE, Usage::STORAGE),
        (Feature::COLOR_ATTACHMENT, Usage::COLOR_ATTACHMENT),
        (Feature::DEPTH_STENCIL_ATTACHMENT, Usage::DEPTH_STENCIL_ATTACHMENT),
    ];
    let mut usage =
        uses.iter().filter(|(feature, _)| features.contains(*feature)).fold(Usage::empty(), |all, it| all | it.1);
    if usage.is_empty() {
        return None;
    }
    let attachment = usage & (Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT);
    let mut samples = Vec::new();
    if !attachment.is_empty() {
        usage |= Usage::TRANSIENT_ATTACHMENT | Usage::INPUT_ATTACHMENT;
        // SAFETY: `physical` belongs to `instance`.
        let properties = unsafe {
            instance.get_physical_device_image_format_properties(
                physical,
                vk_format,
                vk::ImageType::TYPE_2D,
                vk::ImageTiling::OPTIMAL,
                convert::usage(attachment | (usage & Usage::SAMPLED)),
                vk::ImageCreateFlags::empty(),
            )
        };
        let counts = properties.map_or(vk::SampleCountFlags::TYPE_1, |it| it.sample_counts);
        samples = [1, 2, 4, 8, 16, 32, 64].into_iter().filter(|count| counts.as_raw() & count != 0).collect();
    }
    Some(FormatSupport {
        format,
        usage,
        linear_filter: features.contains(Feature::SAMPLED_IMAGE_FILTER_LINEAR),
        blend: features.contains(Feature::COLOR_ATTACHMENT_BLEND),
        samples,
    })
}
