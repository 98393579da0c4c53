//! Graphics pipelines, one for each description.

use crate::convert;
use crate::device::Shared;
use crate::error::Error;
use crate::shaders::Spirv;
use ash::vk;
use framewright_graph::format::Format;
use framewright_graph::frame::Blend;
use framewright_graph::plan::DepthState;

/// Everything that a pipeline is made of. Viewport, scissor, cull mode and front face are set while recording.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct PipelineDescriptor {
    pub(crate) vertex: Spirv,
    pub(crate) fragment: Spirv,
    pub(crate) layout: vk::PipelineLayout,
    /// Bytes from vertex to vertex; 0 without vertex buffer.
    pub(crate) vertex_stride: u32,
    pub(crate) attributes: Vec<VertexAttribute>,
    /// Format and blending of each colour attachment.
    pub(crate) color: Vec<(Format, Blend)>,
    pub(crate) depth_format: Option<Format>,
    pub(crate) depth: Option<DepthState>,
    pub(crate) samples: u32,
}

/// A vertex attribute of 32-bit floats.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct VertexAttribute {
    pub(crate) location: u32,
    /// 1 to 4.
    pub(crate) components: u32,
    pub(crate) offset: u32,
}

impl Shared {
    /// The pipeline of this description. It bears the name of who first asked for it: others may be using it already.
    pub(crate) fn pipeline(&self, name: &str, descriptor: PipelineDescriptor) -> Result<vk::Pipeline, Error> {
        self.caches.pipelines.get(descriptor, |descriptor| {
            let vertex = Module::new(self, &descriptor.vertex)?;
            let fragment = Module::new(self, &descriptor.fragment)?;
            let pipeline = create(self, descriptor, &vertex, &fragment)?;
            self.name(pipeline, name);
            Ok(pipeline)
        })
    }
}

/// A shader module, needed only while a pipeline is created.
struct Module<'d> {
    shared: &'d Shared,
    raw: vk::ShaderModule,
}

impl<'d> Module<'d> {
    fn new(shared: &'d Shared, spirv: &[u32]) -> Result<Module<'d>, Error> {
        let info = vk::ShaderModuleCreateInfo::default().code(spirv);
        // SAFETY: the SPIR-V comes from the shader compiler, for Vulkan 1.3.
        let raw = unsafe { shared.raw.create_shader_module(&info, None) }
            .map_err(Error::vulkan("creating a shader module"))?;
        Ok(Module { shared, raw })
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines don't need their modules any more.
        unsafe { self.shared.raw.destroy_shader_module(self.raw, None) };
    }
}

fn create(
    shared: &Shared,
    descriptor: &PipelineDescriptor,
    vertex: &Module<'_>,
    fragment: &Module<'_>,
) -> Result<vk::Pipeline, Error> {
    let stage = |stage, module: &Module<'_>| {
        vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module.raw).name(c"main")
    };
    let stages = [stage(vk::ShaderStageFlags::VERTEX, vertex), stage(vk::ShaderStageFlags::FRAGMENT, fragment)];
    let bindings = [vk::VertexInputBindingDescription {
        binding: 0,
        stride: descriptor.vertex_stride,
        input_rate: vk::VertexInputRate::VERTEX,
    }];
    let attributes: Vec<_> = descriptor.attributes.iter().map(attribute).collect();
    let mut vertex_input = vk::PipelineVertexInputStateCreateInfo::default().vertex_attribute_descriptions(&attributes);
    if !attributes.is_empty() {
        vertex_input = vertex_input.vertex_binding_descriptions(&bindings);
    }
    let input_assembly =
        vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let multisample =
        vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(convert::samples(descriptor.samples));
    let mut depth = vk::PipelineDepthStencilStateCreateInfo::default();
    if let Some(state) = descriptor.depth {
        depth = depth
            .depth_test_enable(true)
            .depth_write_enable(state.write)
            .depth_compare_op(convert::compare(state.test));
    }
    let blends: Vec<_> = descriptor.color.iter().map(|(_, blend)| blend_state(*blend)).collect();
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let dynamic = [
        vk::DynamicState::VIEWPORT,
        vk::DynamicState::SCISSOR,
        vk::DynamicState::CULL_MODE,
        vk::DynamicState::FRONT_FACE,
    ];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
    let formats: Vec<_> = descriptor.color.iter().map(|(format, _)| convert::format(*format)).collect();
    let mut rendering = vk::PipelineRenderingCreateInfo::default()
        .color_attachment_formats(&formats)
        .depth_attachment_format(descriptor.depth_format.map_or(vk::Format::UNDEFINED, convert::format));
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(&vertex_input)
        .input_assembly_state(&input_assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(descriptor.layout)
        .push_next(&mut rendering);
    // SAFETY: everything that `info` points to outlives the call; interfaces were matched with the layout.
    let pipelines = unsafe { shared.raw.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
    let doing = "creating a pipeline";
    let pipelines = pipelines.map_err(|(_, result)| Error::vulkan(doing)(result))?;
    pipelines.first().copied().ok_or(Error::Vulkan { doing, result: vk::Result::ERROR_UNKNOWN })
}

fn attribute(attribute: &VertexAttribute) -> vk::VertexInputAttributeDescription {
    vk::VertexInputAttributeDescription {
        location: attribute.location,
        binding: 0,
        format: match attribute.components {
            1 => vk::Format::R32_SFLOAT,
            2 => vk::Format::R32G32_SFLOAT,
            3 => vk::Format::R32G32B32_SFLOAT,
            _ => vk::Format::R32G32B32A32_SFLOAT,
        },
        offset: attribute.offset,
    }
}

/// Alpha blends like colour, with its own new value taken whole.
fn blend_state(blend: Blend) -> vk::PipelineColorBlendAttachmentState {
    use vk::BlendFactor as Factor;
    let state = vk::PipelineColorBlendAttachmentState::default()
        .color_write_mask(vk::ColorComponentFlags::RGBA)
        .color_blend_op(vk::BlendOp::ADD)
        .alpha_blend_op(vk::BlendOp::ADD);
    let factors = match blend {
        Blend::Replace => return state,
        Blend::Alpha => [Factor::SRC_ALPHA, Factor::ONE_MINUS_SRC_ALPHA, Factor::ONE, Factor::ONE_MINUS_SRC_ALPHA],
        Blend::Premultiplied => [Factor::ONE, Factor::ONE_MINUS_SRC_ALPHA, Factor::ONE, Factor::ONE_MINUS_SRC_ALPHA],
        Blend::Additive => [Factor::ONE, Factor::ONE, Factor::ONE, Factor::ONE],
    };
    state
        .blend_enable(true)
        .src_color_blend_factor(factors[0])
        .dst_color_blend_factor(factors[1])
        .src_alpha_blend_factor(factors[2])
        .dst_alpha_blend_factor(factors[3])
}
