//! Capabilities that a device claims.

use crate::base::convert;
use crate::gpu::{Device, Gpu};
use ash::vk;
use framewright_graph::device::{FormatSupport, MemoryModel, Profile, Queues, SOME_PLANS_USE};
use framewright_graph::vulkan::{Format, ResolveMode, Sharing, Usage, VertexFormat};

/// The modes in which depth can be resolved, in the order in which the self-test works them out.
pub(super) const DEPTH_RESOLVE_MODES: [ResolveMode; 4] =
    [ResolveMode::SampleZero, ResolveMode::Average, ResolveMode::Min, ResolveMode::Max];

/// Those of the modes that the device says it has.
pub(super) fn depth_resolve_modes(gpu: &Gpu) -> Vec<ResolveMode> {
    let said = gpu.depth_stencil_resolve().supported_depth_resolve_modes;
    DEPTH_RESOLVE_MODES.into_iter().filter(|mode| said.contains(convert::resolve(*mode))).collect()
}

/// The profile of a device that does all that it says.
pub(super) fn claimed_profile(device: &Device) -> Profile {
    let gpu = &device.gpu;
    let (instance, physical, limits) = (&gpu.instance.raw, gpu.physical, &gpu.limits);
    let families = &gpu.queues.families;
    // Formats that a feature brings are there once it is switched on.
    let is_on = |format: &&Format| format.feature().is_none_or(|feature| gpu.features.has(feature));
    let formats = Format::ALL.iter().filter(is_on);
    let formats: Vec<_> = formats.filter_map(|format| support(instance, physical, *format)).collect();
    let model = MemoryModel::fitted(&mut device.memory(), &formats);
    Profile {
        name: gpu.summary.name.clone(),
        source: format!("read from {}, Vulkan {}", gpu.summary.driver, gpu.summary.vulkan),
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
        lazily_allocated_memory: gpu.lazy_types() != 0,
        queues: Queues {
            compute: families.compute.is_some(),
            transfer: families.transfer.is_some(),
            sharing: Sharing::Exclusive,
            wait_bytes: Queues::USUAL_WAIT_BYTES,
        },
        local_read: gpu.local_read.is_some(),
        max_multiview_views: gpu.max_views,
        refuted_multiview: false,
        untested_multiview: false,
        vertex_layer: gpu.features.vertex_layer(),
        max_clip_distances: Some(if gpu.features.clip_distances() { limits.max_clip_distances } else { 0 }),
        features: Some(gpu.features.needed().map(str::to_owned).collect()),
        without: gpu
            .features
            .missing()
            .into_iter()
            .filter(|it| SOME_PLANS_USE.contains(it))
            .map(str::to_owned)
            .collect(),
        limits: Some(gpu.shader_limits()),
        vertex_formats: Some(vertex_formats(gpu)),
        depth_resolve: depth_resolve_modes(gpu),
        refuted_depth_resolve: Vec::new(),
        refuted_layered_depth_resolve: Vec::new(),
        untested_depth_resolve: Vec::new(),
        refuted_integer_resolve: false,
        memory: MemoryModel { heap_bytes: Some(gpu.largest_heap(model.type_bits)), ..model },
        formats,
        known_needs: Vec::new(),
        unknown: Vec::new(),
    }
}

/// The formats of which the device reads vertices beside those that every device reads.
fn vertex_formats(gpu: &Gpu) -> Vec<VertexFormat> {
    let named = VertexFormat::NAMED.iter().map(|(_, format)| *format);
    named.filter(|format| !format.is_on_every_device() && gpu.reads_vertices(*format)).collect()
}

/// The support that the device claims for one format; `None` if there is none.
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
        (Feature::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR, Usage::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR),
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
        minmax_filter: features.contains(Feature::SAMPLED_IMAGE_FILTER_MINMAX),
        blend: features.contains(Feature::COLOR_ATTACHMENT_BLEND),
        samples,
    })
}
