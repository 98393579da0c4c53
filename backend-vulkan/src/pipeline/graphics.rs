//! Graphics pipelines.

use super::create::created;
use super::shader_module::ShaderModule;
use crate::base::{Error, convert};
use crate::gpu::{Gpu, GraphicsDescriptor, RotationConstants, VertexAttribute, VertexBinding};
use ash::vk;
use framewright_graph::frame::{Blend, RasterState};
use framewright_graph::shader::VertexRate;
use framewright_graph::vulkan::ColorComponents;

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

pub(super) fn create(gpu: &Gpu, descriptor: &GraphicsDescriptor) -> Result<(vk::Pipeline, bool), Error> {
    let vertex = ShaderModule::new(gpu, &descriptor.vertex)?;
    let fragment = descriptor.fragment.as_ref().map(|fragment| ShaderModule::new(gpu, fragment)).transpose()?;
    let formats = &descriptor.formats;
    let (entries, constants) = (RotationConstants::entries(), descriptor.turned.map(RotationConstants::constants));
    let constants = constants.as_deref();
    let specialization = constants.map(|data| vk::SpecializationInfo::default().map_entries(&entries).data(data));
    let stage = |stage, module: &ShaderModule<'_>| {
        let info = module.stage(stage);
        specialization.as_ref().map_or(info, |specialization| info.specialization_info(specialization))
    };
    let fragment = fragment.as_ref().map(|fragment| stage(vk::ShaderStageFlags::FRAGMENT, fragment));
    let stages: Vec<_> = [stage(vk::ShaderStageFlags::VERTEX, &vertex)].into_iter().chain(fragment).collect();
    let bindings: Vec<_> = descriptor.vertex_buffers.iter().map(vertex_buffer).collect();
    let divisors: Vec<_> = descriptor.vertex_buffers.iter().filter_map(divisor).collect();
    let mut divided = vk::PipelineVertexInputDivisorStateCreateInfoKHR::default().vertex_binding_divisors(&divisors);
    let attributes: Vec<_> = descriptor.attributes.iter().map(attribute).collect();
    let mut vertex_input = vk::PipelineVertexInputStateCreateInfo::default()
        .vertex_attribute_descriptions(&attributes)
        .vertex_binding_descriptions(&bindings);
    if !divisors.is_empty() {
        vertex_input = vertex_input.push_next(&mut divided);
    }
    let input_assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
        .topology(convert::topology(descriptor.raster.topology))
        .primitive_restart_enable(descriptor.raster.primitive_restart);
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let raster = raster_state(&descriptor.raster);
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
    let blend = vk::PipelineColorBlendStateCreateInfo::default()
        .attachments(&blends)
        .blend_constants(descriptor.raster.blend_constants.map(f32::from));
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
    let local = formats.local.as_ref();
    let mut locations = vk::RenderingAttachmentLocationInfoKHR::default()
        .color_attachment_locations(local.map_or(&[][..], |local| &local.locations[..]));
    let mut inputs = vk::RenderingInputAttachmentIndexInfoKHR::default()
        .color_attachment_input_indices(local.map_or(&[][..], |local| &local.inputs[..]));
    let mut feedback = vk::PipelineCreationFeedback::default();
    let mut told = vk::PipelineCreationFeedbackCreateInfo::default().pipeline_creation_feedback(&mut feedback);
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
        .push_next(&mut rendering)
        .push_next(&mut told);
    if local.is_some() {
        info = info.push_next(&mut locations).push_next(&mut inputs);
    }
    // SAFETY: everything that `info` points to outlives the call; interfaces were matched with the layout.
    let made = unsafe { gpu.raw.create_graphics_pipelines(gpu.pipeline_cache.raw, &[info], None) };
    created(made, feedback)
}

/// Items of the colour attachments of a scope or its pipelines; where there is none, one that is unused, without image or
/// format. After a pipeline of no colour attachment lavapipe 25 blends all attachments like the first, until the end of the
/// command buffer.
pub(crate) fn or_unused<T: Default>(attachments: impl Iterator<Item = T>) -> Vec<T> {
    let attachments: Vec<T> = attachments.collect();
    if attachments.is_empty() { vec![T::default()] } else { attachments }
}

fn vertex_buffer(buffer: &VertexBinding) -> vk::VertexInputBindingDescription {
    let VertexBinding { binding, stride, rate } = *buffer;
    let by_instance = rate.is_by_instance();
    let input_rate = if by_instance { vk::VertexInputRate::INSTANCE } else { vk::VertexInputRate::VERTEX };
    vk::VertexInputBindingDescription { binding, stride, input_rate }
}

/// How many instances share an element, where that is more than one.
fn divisor(buffer: &VertexBinding) -> Option<vk::VertexInputBindingDivisorDescriptionKHR> {
    match buffer.rate {
        VertexRate::Instance { divisor } if divisor > 1 => {
            Some(vk::VertexInputBindingDivisorDescriptionKHR { binding: buffer.binding, divisor })
        }
        VertexRate::Instance { .. } | VertexRate::Vertex => None,
    }
}

fn attribute(attribute: &VertexAttribute) -> vk::VertexInputAttributeDescription {
    let VertexAttribute { location, binding, format, offset } = *attribute;
    vk::VertexInputAttributeDescription { location, binding, format, offset }
}

/// Cull mode and front face are set while recording.
fn raster_state(raster: &RasterState) -> vk::PipelineRasterizationStateCreateInfo<'static> {
    let state = vk::PipelineRasterizationStateCreateInfo::default()
        .line_width(raster.line_width.into())
        .depth_clamp_enable(raster.depth_clamp);
    match raster.depth_bias {
        None => state,
        Some(bias) => state
            .depth_bias_enable(true)
            .depth_bias_constant_factor(bias.constant.into())
            .depth_bias_slope_factor(bias.slope.into())
            .depth_bias_clamp(bias.clamp.into()),
    }
}

/// Where a pass doesn't draw, nothing is written.
fn blend_state(blend: Option<(Blend, ColorComponents)>) -> vk::PipelineColorBlendAttachmentState {
    let Some((blend, written)) = blend else { return vk::PipelineColorBlendAttachmentState::default() };
    let state = vk::PipelineColorBlendAttachmentState::default()
        .color_write_mask(convert::color_components(written))
        .color_blend_op(vk::BlendOp::ADD)
        .alpha_blend_op(vk::BlendOp::ADD);
    let Some(equation) = blend.equation() else { return state };
    state
        .blend_enable(true)
        .src_color_blend_factor(convert::blend_factor(equation.src_color))
        .dst_color_blend_factor(convert::blend_factor(equation.dst_color))
        .color_blend_op(convert::blend_op(equation.color_op))
        .src_alpha_blend_factor(convert::blend_factor(equation.src_alpha))
        .dst_alpha_blend_factor(convert::blend_factor(equation.dst_alpha))
        .alpha_blend_op(convert::blend_op(equation.alpha_op))
}
