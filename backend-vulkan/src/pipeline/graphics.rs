//! Pipelines, one for each description.

use crate::base::{Error, convert};
use crate::gpu::{Gpu, PipelineDescriptor, RotationConstants, VertexAttribute};
use crate::shaders::Spirv;
use ash::vk;
use framewright_graph::frame::Blend;

impl RotationConstants {
    /// The number of the first of its constants.
    const FIRST: u32 = 100;

    fn constants(self) -> Vec<u8> {
        let [width, height] = self.extent;
        [self.rotation.quarters(), width, height].into_iter().flat_map(u32::to_ne_bytes).collect()
    }

    fn entries() -> [vk::SpecializationMapEntry; 3] {
        [0, 1, 2].map(|at| vk::SpecializationMapEntry {
            constant_id: RotationConstants::FIRST + at,
            offset: 4 * at,
            size: 4,
        })
    }
}

impl Gpu {
    /// The graphics pipeline of this description. It bears the name of who first asked for it: others may be using it
    /// already.
    pub(crate) fn pipeline(&self, name: &str, descriptor: PipelineDescriptor) -> Result<vk::Pipeline, Error> {
        self.caches.pipelines.get(descriptor, |descriptor| self.own_pipeline(name, descriptor))
    }

    /// A graphics pipeline of this description that belongs to the caller, who destroys it.
    pub(crate) fn own_pipeline(&self, name: &str, descriptor: &PipelineDescriptor) -> Result<vk::Pipeline, Error> {
        let vertex = ShaderModule::new(self, &descriptor.vertex)?;
        let fragment = descriptor.fragment.as_ref().map(|fragment| ShaderModule::new(self, fragment)).transpose()?;
        let pipeline = create(self, descriptor, &vertex, fragment.as_ref())?;
        self.name(pipeline, name);
        Ok(pipeline)
    }

    /// The compute pipeline of a shader and a layout, named likewise.
    pub(crate) fn compute_pipeline(
        &self,
        name: &str,
        shader: Spirv,
        layout: vk::PipelineLayout,
    ) -> Result<vk::Pipeline, Error> {
        self.caches.compute_pipelines.get((shader, layout), |(shader, layout)| {
            let module = ShaderModule::new(self, shader)?;
            let stage = vk::PipelineShaderStageCreateInfo::default()
                .stage(vk::ShaderStageFlags::COMPUTE)
                .module(module.raw)
                .name(c"main");
            let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(*layout);
            // SAFETY: everything that `info` points to outlives the call; the interface was matched with the layout.
            let made = unsafe { self.raw.create_compute_pipelines(vk::PipelineCache::null(), &[info], None) };
            let pipeline = only(made)?;
            self.name(pipeline, name);
            Ok(pipeline)
        })
    }
}

/// The one pipeline that was asked for.
fn only(made: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>) -> Result<vk::Pipeline, Error> {
    let doing = "creating a pipeline";
    let made = made.map_err(|(_, result)| Error::vulkan(doing)(result))?;
    made.first().copied().ok_or(Error::Vulkan { doing, result: vk::Result::ERROR_UNKNOWN })
}

/// A shader module, needed only while a pipeline is created.
struct ShaderModule<'d> {
    gpu: &'d Gpu,
    raw: vk::ShaderModule,
}

impl<'d> ShaderModule<'d> {
    fn new(gpu: &'d Gpu, spirv: &[u32]) -> Result<ShaderModule<'d>, Error> {
        let info = vk::ShaderModuleCreateInfo::default().code(spirv);
        // SAFETY: the SPIR-V comes from the shader compiler, for Vulkan 1.3, or was built for it.
        let raw =
            unsafe { gpu.raw.create_shader_module(&info, None) }.map_err(Error::vulkan("creating a shader module"))?;
        Ok(ShaderModule { gpu, raw })
    }
}

impl Drop for ShaderModule<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines don't need their modules any more.
        unsafe { self.gpu.raw.destroy_shader_module(self.raw, None) };
    }
}

fn create(
    gpu: &Gpu,
    descriptor: &PipelineDescriptor,
    vertex: &ShaderModule<'_>,
    fragment: Option<&ShaderModule<'_>>,
) -> Result<vk::Pipeline, Error> {
    let formats = &descriptor.formats;
    let (entries, constants) = (RotationConstants::entries(), descriptor.turned.map(RotationConstants::constants));
    let constants = constants.as_deref();
    let specialization = constants.map(|data| vk::SpecializationInfo::default().map_entries(&entries).data(data));
    let stage = |stage, module: &ShaderModule<'_>| {
        let info = vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module.raw).name(c"main");
        specialization.as_ref().map_or(info, |specialization| info.specialization_info(specialization))
    };
    let fragment = fragment.map(|fragment| stage(vk::ShaderStageFlags::FRAGMENT, fragment));
    let stages: Vec<_> = [stage(vk::ShaderStageFlags::VERTEX, vertex)].into_iter().chain(fragment).collect();
    let bindings: Vec<_> = (0..)
        .zip(&descriptor.strides)
        .map(|(binding, stride)| {
            let input_rate = vk::VertexInputRate::VERTEX;
            vk::VertexInputBindingDescription { binding, stride: *stride, input_rate }
        })
        .collect();
    let attributes: Vec<_> = descriptor.attributes.iter().map(attribute).collect();
    let mut vertex_input = vk::PipelineVertexInputStateCreateInfo::default().vertex_attribute_descriptions(&attributes);
    if !attributes.is_empty() {
        vertex_input = vertex_input.vertex_binding_descriptions(&bindings);
    }
    let input_assembly =
        vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let multisample = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(formats.samples)
        .alpha_to_coverage_enable(descriptor.alpha_to_coverage);
    let mut depth = vk::PipelineDepthStencilStateCreateInfo::default();
    if let Some(state) = descriptor.depth {
        depth = depth
            .depth_test_enable(true)
            .depth_write_enable(state.write)
            .depth_compare_op(convert::compare(state.test));
    }
    if let Some(state) = descriptor.stencil {
        let face = vk::StencilOpState {
            fail_op: vk::StencilOp::KEEP,
            pass_op: convert::stencil(state.pass),
            depth_fail_op: vk::StencilOp::KEEP,
            compare_op: convert::compare(state.test),
            compare_mask: u32::from(u8::MAX),
            write_mask: u32::from(u8::MAX),
            reference: u32::from(state.reference),
        };
        depth = depth.stencil_test_enable(true).front(face).back(face);
    }
    let blends = or_unused(descriptor.blend.iter().map(|blend| blend_state(*blend)));
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let dynamic = [
        vk::DynamicState::VIEWPORT,
        vk::DynamicState::SCISSOR,
        vk::DynamicState::CULL_MODE,
        vk::DynamicState::FRONT_FACE,
    ];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
    let mut rendering = vk::PipelineRenderingCreateInfo::default()
        .view_mask(formats.view_mask)
        .color_attachment_formats(&formats.color)
        .depth_attachment_format(formats.depth)
        .stencil_attachment_format(formats.stencil);
    let local = descriptor.local.as_ref();
    let mut locations = vk::RenderingAttachmentLocationInfoKHR::default()
        .color_attachment_locations(local.map_or(&[][..], |local| &local.locations[..]));
    let mut inputs = vk::RenderingInputAttachmentIndexInfoKHR::default()
        .color_attachment_input_indices(local.map_or(&[][..], |local| &local.inputs[..]));
    let mut info = vk::GraphicsPipelineCreateInfo::default()
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
    if local.is_some() {
        info = info.push_next(&mut locations).push_next(&mut inputs);
    }
    // SAFETY: everything that `info` points to outlives the call; interfaces were matched with the layout.
    only(unsafe { gpu.raw.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) })
}

/// Items of the colour attachments of a scope or its pipelines; where there is none, one that is unused, without image or
/// format. After a pipeline of no colour attachment lavapipe 25 blends all attachments like the first, until the end of the
/// command buffer.
pub(crate) fn or_unused<T: Default>(attachments: impl Iterator<Item = T>) -> Vec<T> {
    let attachments: Vec<T> = attachments.collect();
    if attachments.is_empty() { vec![T::default()] } else { attachments }
}

fn attribute(attribute: &VertexAttribute) -> vk::VertexInputAttributeDescription {
    let VertexAttribute { location, binding, format, offset } = *attribute;
    vk::VertexInputAttributeDescription { location, binding, format, offset }
}

/// Alpha blends like colour, with its own new value taken whole. Without blending nothing is written.
fn blend_state(blend: Option<Blend>) -> vk::PipelineColorBlendAttachmentState {
    use vk::BlendFactor as Factor;
    let Some(blend) = blend else { return vk::PipelineColorBlendAttachmentState::default() };
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
