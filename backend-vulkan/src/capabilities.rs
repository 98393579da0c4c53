//! What a physical device can do: the minimum that this crate needs, and a live [`Profile`].

use crate::convert;
use crate::device::Shared;
use ash::vk;
use framewright_graph::device::{FormatSupport, ImageDescriptor, MemoryModel, MemoryNeeds, Profile};
use framewright_graph::format::Format;
use framewright_graph::vocabulary::Usage;

/// The Vulkan version that devices and the loader must have.
pub const MINIMUM_VERSION: u32 = vk::API_VERSION_1_3;

/// Feature structures in the order in which they are chained.
#[derive(Default)]
pub(crate) struct Features {
    core: vk::PhysicalDeviceFeatures,
    v1_3: vk::PhysicalDeviceVulkan13Features<'static>,
}

/// The features that a device must have beside [`MINIMUM_VERSION`], by Vulkan's names.
pub fn minimum_features() -> impl Iterator<Item = &'static str> {
    MINIMUM_FEATURES.iter().map(|(name, _)| *name)
}

/// Reaches one feature's flag.
type Flag = fn(&mut Features) -> &mut vk::Bool32;

/// The minimum device, feature by feature: Vulkan's name, what needs it, the flag. All of these are switched on.
const MINIMUM_FEATURES: [(&str, Flag); 9] = [
    // Rendering scopes without render pass objects.
    ("dynamicRendering", |it| &mut it.v1_3.dynamic_rendering),
    // Barriers as the Plan writes them.
    ("synchronization2", |it| &mut it.v1_3.synchronization2),
    // Memory needs of images that don't exist yet.
    ("maintenance4", |it| &mut it.v1_3.maintenance4),
    // `discard` in SPIR-V 1.6.
    ("shaderDemoteToHelperInvocation", |it| &mut it.v1_3.shader_demote_to_helper_invocation),
    ("shaderTerminateInvocation", |it| &mut it.v1_3.shader_terminate_invocation),
    // What a model file says about vertices can't reach beyond their buffer.
    ("robustBufferAccess", |it| &mut it.core.robust_buffer_access),
    // Another blend for each attachment.
    ("independentBlend", |it| &mut it.core.independent_blend),
    // Storage images that fragment shaders write.
    ("fragmentStoresAndAtomics", |it| &mut it.core.fragment_stores_and_atomics),
    // Fragment shaders that run once a sample.
    ("sampleRateShading", |it| &mut it.core.sample_rate_shading),
];

impl Features {
    /// What `physical` has.
    pub(crate) fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Features {
        let mut v1_3 = vk::PhysicalDeviceVulkan13Features::default();
        let mut all = vk::PhysicalDeviceFeatures2::default().push_next(&mut v1_3);
        // SAFETY: `physical` belongs to `instance`, and the chained structure outlives the call.
        unsafe { instance.get_physical_device_features2(physical, &mut all) };
        let core = all.features;
        v1_3.p_next = std::ptr::null_mut();
        Features { core, v1_3 }
    }

    /// The features of the minimum.
    pub(crate) fn minimum() -> Features {
        let mut features = Features::default();
        for (_, flag) in MINIMUM_FEATURES {
            *flag(&mut features) = vk::TRUE;
        }
        features
    }

    /// For a device's creation.
    pub(crate) fn parts(&mut self) -> (&vk::PhysicalDeviceFeatures, &mut vk::PhysicalDeviceVulkan13Features<'static>) {
        (&self.core, &mut self.v1_3)
    }
}

/// The first queue family that does graphics.
pub(crate) fn graphics_family(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<(u32, u32)> {
    // SAFETY: `physical` belongs to `instance`.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    (0..)
        .zip(families)
        .find(|(_, family)| family.queue_flags.contains(vk::QueueFlags::GRAPHICS))
        .map(|(index, family)| (index, family.timestamp_valid_bits))
}

/// All that `physical` lacks of the minimum, by Vulkan's names.
pub(crate) fn missing(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Vec<String> {
    // SAFETY: `physical` belongs to `instance`.
    let properties = unsafe { instance.get_physical_device_properties(physical) };
    if properties.api_version < MINIMUM_VERSION {
        // Its 1.3 features can't even be asked for.
        return vec![format!("Vulkan {} (it has {})", version(MINIMUM_VERSION), version(properties.api_version))];
    }
    let mut has = Features::of(instance, physical);
    let features = MINIMUM_FEATURES.iter().filter(|(_, flag)| *flag(&mut has) == vk::FALSE);
    let mut missing: Vec<String> = features.map(|(name, _)| format!("the feature {name}")).collect();
    match graphics_family(instance, physical) {
        None => missing.push("a queue for graphics".to_owned()),
        Some((_, 0)) => missing.push("timestamps on its graphics queue".to_owned()),
        Some(_) => {}
    }
    missing
}

/// A version in words.
pub(crate) fn version(packed: u32) -> String {
    let major = vk::api_version_major(packed);
    format!("{major}.{}.{}", vk::api_version_minor(packed), vk::api_version_patch(packed))
}

/// The capabilities of `physical`. `needs` asks the opened device for an image's memory needs.
pub(crate) fn profile(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    source: String,
    needs: impl Fn(&ImageDescriptor) -> MemoryNeeds,
) -> Profile {
    // SAFETY: `physical` belongs to `instance`.
    let (properties, memory) = unsafe {
        (instance.get_physical_device_properties(physical), instance.get_physical_device_memory_properties(physical))
    };
    let limits = properties.limits;
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
        max_color_attachments: limits.max_color_attachments,
        lazily_allocated_memory: memory
            .memory_types_as_slice()
            .iter()
            .any(|ty| ty.property_flags.contains(vk::MemoryPropertyFlags::LAZILY_ALLOCATED)),
        formats: Format::ALL.iter().filter_map(|format| support(instance, physical, *format)).collect(),
        memory: memory_model(needs),
    }
}

impl Shared {
    /// Whether the device can make an image of this description.
    pub(crate) fn can_make(&self, descriptor: &ImageDescriptor) -> bool {
        let [width, height, depth] = descriptor.extent;
        let levels = u32::BITS - width.max(height).max(depth).leading_zeros();
        let attachment = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT;
        let may_be_asked = !descriptor.usage.is_empty()
            && (attachment.intersects(descriptor.usage) || !descriptor.usage.contains(Usage::TRANSIENT_ATTACHMENT))
            && descriptor.samples.is_power_of_two()
            && (descriptor.samples == 1 || (descriptor.mips == 1 && depth == 1))
            && descriptor.mips <= levels;
        if !may_be_asked {
            return false;
        }
        let info = crate::image::create_info(descriptor);
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

    /// What images of a format can do.
    pub(crate) fn format_features(&self, format: Format) -> vk::FormatFeatureFlags {
        let format = convert::format(format);
        // SAFETY: the physical device belongs to the instance.
        unsafe { self.instance.raw.get_physical_device_format_properties(self.physical, format) }
            .optimal_tiling_features
    }

    /// How rendering scopes can resolve depth.
    pub(crate) fn depth_resolve_modes(&self) -> vk::ResolveModeFlags {
        let mut resolve = vk::PhysicalDeviceDepthStencilResolveProperties::default();
        let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut resolve);
        // SAFETY: the physical device belongs to the instance, and the chained structure outlives the call.
        unsafe { self.instance.raw.get_physical_device_properties2(self.physical, &mut all) };
        resolve.supported_depth_resolve_modes
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
        usage |= Usage::TRANSIENT_ATTACHMENT;
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

/// Fits the model of [`MemoryModel`] to a device by asking for a column and a row of texels.
fn memory_model(needs: impl Fn(&ImageDescriptor) -> MemoryNeeds) -> MemoryModel {
    const LONG: u32 = 1024;
    let of = |extent: [u32; 2]| {
        needs(&ImageDescriptor {
            format: Format::R8G8B8A8_UNORM,
            extent: [extent[0], extent[1], 1],
            mips: 1,
            layers: 1,
            samples: 1,
            usage: Usage::COLOR_ATTACHMENT | Usage::SAMPLED,
        })
    };
    let texels = |needs: MemoryNeeds| {
        let texels = needs.bytes / Format::R8G8B8A8_UNORM.texel_bytes() / u64::from(LONG);
        u32::try_from(texels).unwrap_or(1).max(1)
    };
    let column = of([1, LONG]);
    MemoryModel { alignment: column.alignment, row_texels: texels(column), rows: texels(of([LONG, 1])) }
}
