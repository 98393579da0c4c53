//! From the graph's words to Vulkan's enumerants. Flags and formats share their values; the rest are tables.

use ash::vk;
use framewright_graph::vulkan::{
    Accesses, Aspects, BlendFactor, BlendOp, BorderColor, BufferUsage, ColorComponents, CompareOp, CullMode, FillValue,
    Filter, Format, FrontFace, Layout, LoadOp, Numeric, OutsideOwner, PrimitiveTopology, ResolveMode,
    SamplerReductionMode, Stages, StencilOp, StoreOp, Subresources, Usage,
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

pub(crate) fn buffer_usage(usage: BufferUsage) -> vk::BufferUsageFlags {
    vk::BufferUsageFlags::from_raw(usage.bits())
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
        Layout::DepthAttachmentOptimal => vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL,
        Layout::DepthReadOnlyOptimal => vk::ImageLayout::DEPTH_READ_ONLY_OPTIMAL,
        Layout::StencilAttachmentOptimal => vk::ImageLayout::STENCIL_ATTACHMENT_OPTIMAL,
        Layout::StencilReadOnlyOptimal => vk::ImageLayout::STENCIL_READ_ONLY_OPTIMAL,
        Layout::ShaderReadOnlyOptimal => vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        Layout::TransferSrcOptimal => vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        Layout::TransferDstOptimal => vk::ImageLayout::TRANSFER_DST_OPTIMAL,
        Layout::PresentSrcKhr => vk::ImageLayout::PRESENT_SRC_KHR,
        Layout::RenderingLocalReadKhr => vk::ImageLayout::RENDERING_LOCAL_READ_KHR,
        Layout::FragmentShadingRateAttachmentOptimalKhr => {
            vk::ImageLayout::FRAGMENT_SHADING_RATE_ATTACHMENT_OPTIMAL_KHR
        }
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

pub(crate) fn stencil(op: StencilOp) -> vk::StencilOp {
    match op {
        StencilOp::Keep => vk::StencilOp::KEEP,
        StencilOp::Zero => vk::StencilOp::ZERO,
        StencilOp::Replace => vk::StencilOp::REPLACE,
        StencilOp::IncrementAndClamp => vk::StencilOp::INCREMENT_AND_CLAMP,
        StencilOp::DecrementAndClamp => vk::StencilOp::DECREMENT_AND_CLAMP,
        StencilOp::Invert => vk::StencilOp::INVERT,
    }
}

pub(crate) fn filter(filter: Filter) -> vk::Filter {
    match filter {
        Filter::Nearest => vk::Filter::NEAREST,
        Filter::Linear => vk::Filter::LINEAR,
    }
}

pub(crate) fn extent([width, height, depth]: [u32; 3]) -> vk::Extent3D {
    vk::Extent3D { width, height, depth }
}

/// Left and upper edge, width and height.
pub(crate) fn rectangle([x, y, width, height]: [u32; 4]) -> vk::Rect2D {
    let offset = vk::Offset2D { x: x.cast_signed(), y: y.cast_signed() };
    vk::Rect2D { offset, extent: vk::Extent2D { width, height } }
}

/// A colour attachment's clear value in the form that its components need. The format holds it.
pub(crate) fn clear_color(format: Format, value: [f64; 4]) -> vk::ClearColorValue {
    match format.numeric() {
        Numeric::Uint => {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the format holds it")]
            let uint32 = value.map(|component| component as u32);
            vk::ClearColorValue { uint32 }
        }
        Numeric::Sint => {
            #[allow(clippy::cast_possible_truncation, reason = "the format holds it")]
            let int32 = value.map(|component| component as i32);
            vk::ClearColorValue { int32 }
        }
        Numeric::Sfloat | Numeric::Ufloat | Numeric::Unorm | Numeric::Snorm | Numeric::Srgb => {
            #[allow(clippy::cast_possible_truncation, reason = "no format holds more")]
            let float32 = value.map(|component| component as f32);
            vk::ClearColorValue { float32 }
        }
    }
}

/// The value of a clear by transfer.
#[derive(Clone, Copy)]
pub(crate) enum Clear {
    /// Into an image of colours.
    Color(vk::ClearColorValue),
    /// Into an image of depth or stencil.
    DepthStencil(vk::ClearDepthStencilValue),
    /// Into a buffer, word by word.
    Word(u32),
}

/// The clear that writes `value` into an image of `format`, or (`None`) into a buffer. A value of another kind than the format
/// counts by its components: the checker has refused it before.
pub(crate) fn clear(format: Option<Format>, value: FillValue) -> Clear {
    match (format, value) {
        (None, FillValue::Bits([word, ..])) => Clear::Word(word),
        (None, FillValue::Color([value, ..]) | FillValue::Depth(value, _)) => Clear::Word(value.to_bits()),
        (Some(format), value) if !format.aspects().contains(Aspects::COLOR) => {
            let (depth, stencil) = match value {
                FillValue::Depth(depth, stencil) => (depth, stencil.into()),
                FillValue::Color([depth, ..]) => (depth, 0),
                FillValue::Bits([_, stencil, ..]) => (0.0, stencil.min(u8::MAX.into())),
            };
            Clear::DepthStencil(vk::ClearDepthStencilValue { depth, stencil })
        }
        (Some(_), FillValue::Bits(uint32)) => Clear::Color(vk::ClearColorValue { uint32 }),
        (Some(format), FillValue::Color(color)) => Clear::Color(clear_color(format, color.map(f64::from))),
        (Some(format), FillValue::Depth(value, _)) => Clear::Color(clear_color(format, [value.into(); 4])),
    }
}

pub(crate) fn color_components(components: ColorComponents) -> vk::ColorComponentFlags {
    vk::ColorComponentFlags::from_raw(components.bits().into())
}

pub(crate) fn cull_mode(mode: CullMode) -> vk::CullModeFlags {
    match mode {
        CullMode::None => vk::CullModeFlags::NONE,
        CullMode::Front => vk::CullModeFlags::FRONT,
        CullMode::Back => vk::CullModeFlags::BACK,
        CullMode::FrontAndBack => vk::CullModeFlags::FRONT_AND_BACK,
    }
}

pub(crate) fn front_face(face: FrontFace) -> vk::FrontFace {
    match face {
        FrontFace::CounterClockwise => vk::FrontFace::COUNTER_CLOCKWISE,
        FrontFace::Clockwise => vk::FrontFace::CLOCKWISE,
    }
}

pub(crate) fn topology(topology: PrimitiveTopology) -> vk::PrimitiveTopology {
    match topology {
        PrimitiveTopology::PointList => vk::PrimitiveTopology::POINT_LIST,
        PrimitiveTopology::LineList => vk::PrimitiveTopology::LINE_LIST,
        PrimitiveTopology::LineStrip => vk::PrimitiveTopology::LINE_STRIP,
        PrimitiveTopology::TriangleList => vk::PrimitiveTopology::TRIANGLE_LIST,
        PrimitiveTopology::TriangleStrip => vk::PrimitiveTopology::TRIANGLE_STRIP,
        PrimitiveTopology::TriangleFan => vk::PrimitiveTopology::TRIANGLE_FAN,
    }
}

/// The queue family that stands for an outside owner.
pub(crate) fn outside_family(owner: OutsideOwner) -> u32 {
    match owner {
        OutsideOwner::External => vk::QUEUE_FAMILY_EXTERNAL,
        OutsideOwner::Foreign => vk::QUEUE_FAMILY_FOREIGN_EXT,
    }
}

pub(crate) fn blend_factor(factor: BlendFactor) -> vk::BlendFactor {
    match factor {
        BlendFactor::Zero => vk::BlendFactor::ZERO,
        BlendFactor::One => vk::BlendFactor::ONE,
        BlendFactor::SrcColor => vk::BlendFactor::SRC_COLOR,
        BlendFactor::OneMinusSrcColor => vk::BlendFactor::ONE_MINUS_SRC_COLOR,
        BlendFactor::DstColor => vk::BlendFactor::DST_COLOR,
        BlendFactor::OneMinusDstColor => vk::BlendFactor::ONE_MINUS_DST_COLOR,
        BlendFactor::SrcAlpha => vk::BlendFactor::SRC_ALPHA,
        BlendFactor::OneMinusSrcAlpha => vk::BlendFactor::ONE_MINUS_SRC_ALPHA,
        BlendFactor::DstAlpha => vk::BlendFactor::DST_ALPHA,
        BlendFactor::OneMinusDstAlpha => vk::BlendFactor::ONE_MINUS_DST_ALPHA,
        BlendFactor::ConstantColor => vk::BlendFactor::CONSTANT_COLOR,
        BlendFactor::OneMinusConstantColor => vk::BlendFactor::ONE_MINUS_CONSTANT_COLOR,
        BlendFactor::ConstantAlpha => vk::BlendFactor::CONSTANT_ALPHA,
        BlendFactor::OneMinusConstantAlpha => vk::BlendFactor::ONE_MINUS_CONSTANT_ALPHA,
        BlendFactor::SrcAlphaSaturate => vk::BlendFactor::SRC_ALPHA_SATURATE,
        BlendFactor::Src1Color => vk::BlendFactor::SRC1_COLOR,
        BlendFactor::OneMinusSrc1Color => vk::BlendFactor::ONE_MINUS_SRC1_COLOR,
        BlendFactor::Src1Alpha => vk::BlendFactor::SRC1_ALPHA,
        BlendFactor::OneMinusSrc1Alpha => vk::BlendFactor::ONE_MINUS_SRC1_ALPHA,
    }
}

pub(crate) fn blend_op(op: BlendOp) -> vk::BlendOp {
    match op {
        BlendOp::Add => vk::BlendOp::ADD,
        BlendOp::Subtract => vk::BlendOp::SUBTRACT,
        BlendOp::ReverseSubtract => vk::BlendOp::REVERSE_SUBTRACT,
        BlendOp::Min => vk::BlendOp::MIN,
        BlendOp::Max => vk::BlendOp::MAX,
    }
}

pub(crate) fn border_color(border: BorderColor) -> vk::BorderColor {
    match border {
        BorderColor::FloatTransparentBlack => vk::BorderColor::FLOAT_TRANSPARENT_BLACK,
        BorderColor::IntTransparentBlack => vk::BorderColor::INT_TRANSPARENT_BLACK,
        BorderColor::FloatOpaqueBlack => vk::BorderColor::FLOAT_OPAQUE_BLACK,
        BorderColor::IntOpaqueBlack => vk::BorderColor::INT_OPAQUE_BLACK,
        BorderColor::FloatOpaqueWhite => vk::BorderColor::FLOAT_OPAQUE_WHITE,
        BorderColor::IntOpaqueWhite => vk::BorderColor::INT_OPAQUE_WHITE,
    }
}

pub(crate) fn sampler_reduction(mode: SamplerReductionMode) -> vk::SamplerReductionMode {
    match mode {
        SamplerReductionMode::WeightedAverage => vk::SamplerReductionMode::WEIGHTED_AVERAGE,
        SamplerReductionMode::Min => vk::SamplerReductionMode::MIN,
        SamplerReductionMode::Max => vk::SamplerReductionMode::MAX,
    }
}
