//! From the graph's words to Vulkan's enumerants. Flags and formats share their values; the rest are tables.

use ash::vk;
use framewright_graph::format::Format;
use framewright_graph::plan::Subresources;
use framewright_graph::vocabulary::{
    Accesses, Aspects, CompareOp, Layout, LoadOp, ResolveMode, Stages, StoreOp, Usage,
};

pub(crate) fn format(format: Format) -> vk::Format {
    vk::Format::from_raw(format.vulkan())
}

pub(crate) fn stages(stages: Stages) -> vk::PipelineStageFlags2 {
    vk::PipelineStageFlags2::from_raw(stages.bits())
}

pub(crate) fn accesses(accesses: Accesses) -> vk::AccessFlags2 {
    vk::AccessFlags2::from_raw(accesses.bits())
}

pub(crate) fn usage(usage: Usage) -> vk::ImageUsageFlags {
    vk::ImageUsageFlags::from_raw(usage.bits())
}

pub(crate) fn aspects(aspects: Aspects) -> vk::ImageAspectFlags {
    vk::ImageAspectFlags::from_raw(aspects.bits())
}

pub(crate) fn samples(samples: u32) -> vk::SampleCountFlags {
    vk::SampleCountFlags::from_raw(samples)
}

pub(crate) fn range(range: Subresources) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: aspects(range.aspects),
        base_mip_level: range.base_mip,
        level_count: range.mips,
        base_array_layer: range.base_layer,
        layer_count: range.layers,
    }
}

/// The first mip level of `range`, for copies and resolves.
pub(crate) fn layers(range: Subresources) -> vk::ImageSubresourceLayers {
    vk::ImageSubresourceLayers {
        aspect_mask: aspects(range.aspects),
        mip_level: range.base_mip,
        base_array_layer: range.base_layer,
        layer_count: range.layers,
    }
}

pub(crate) fn layout(layout: Layout) -> vk::ImageLayout {
    match layout {
        Layout::Undefined => vk::ImageLayout::UNDEFINED,
        Layout::General => vk::ImageLayout::GENERAL,
        Layout::ColorAttachmentOptimal => vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        Layout::DepthStencilAttachmentOptimal => vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        Layout::DepthStencilReadOnlyOptimal => vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        Layout::ShaderReadOnlyOptimal => vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        Layout::TransferSrcOptimal => vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        Layout::TransferDstOptimal => vk::ImageLayout::TRANSFER_DST_OPTIMAL,
        Layout::PresentSrcKhr => vk::ImageLayout::PRESENT_SRC_KHR,
    }
}

pub(crate) fn load(load: LoadOp) -> vk::AttachmentLoadOp {
    match load {
        LoadOp::Load => vk::AttachmentLoadOp::LOAD,
        LoadOp::Clear => vk::AttachmentLoadOp::CLEAR,
        LoadOp::DontCare => vk::AttachmentLoadOp::DONT_CARE,
    }
}

pub(crate) fn store(store: StoreOp) -> vk::AttachmentStoreOp {
    match store {
        StoreOp::Store => vk::AttachmentStoreOp::STORE,
        StoreOp::DontCare => vk::AttachmentStoreOp::DONT_CARE,
        StoreOp::None => vk::AttachmentStoreOp::NONE,
    }
}

pub(crate) fn resolve(mode: ResolveMode) -> vk::ResolveModeFlags {
    match mode {
        ResolveMode::Average => vk::ResolveModeFlags::AVERAGE,
        ResolveMode::SampleZero => vk::ResolveModeFlags::SAMPLE_ZERO,
        ResolveMode::Min => vk::ResolveModeFlags::MIN,
        ResolveMode::Max => vk::ResolveModeFlags::MAX,
    }
}

pub(crate) fn compare(op: CompareOp) -> vk::CompareOp {
    match op {
        CompareOp::Never => vk::CompareOp::NEVER,
        CompareOp::Less => vk::CompareOp::LESS,
        CompareOp::Equal => vk::CompareOp::EQUAL,
        CompareOp::LessOrEqual => vk::CompareOp::LESS_OR_EQUAL,
        CompareOp::Greater => vk::CompareOp::GREATER,
        CompareOp::NotEqual => vk::CompareOp::NOT_EQUAL,
        CompareOp::GreaterOrEqual => vk::CompareOp::GREATER_OR_EQUAL,
        CompareOp::Always => vk::CompareOp::ALWAYS,
    }
}
