//! Attachments, pipelines and descriptor sets of passes.

use super::memory::Images;
use super::{Made, Pass, StepWork, convert};
use crate::workload::{Shaders, VERTEX_BYTES};
use ash::vk;
use framewright_graph::frame::{Blend, Draw, Groups};
use framewright_graph::plan::{self, Attachment, BindingKind, Plan, RenderScope};
use framewright_graph::vulkan::{Aspects, LoadOp};
use framewright_vulkan::Device;
use std::collections::HashMap;

/// Shader modules by the names of their files.
type Modules = HashMap<&'static str, vk::ShaderModule>;

/// Invocations of a workgroup along both axes.
const GROUP: u32 = 8;

/// Makes passes, and keeps what several of them share.
pub(super) struct PassMaker<'m> {
    device: &'m Device,
    plan: &'m Plan,
    images: &'m Images,
    object_sets: Option<[vk::DescriptorSetLayout; 2]>,
    modules: Modules,
    made: &'m mut Made,
    sampler: vk::Sampler,
    layouts: HashMap<LayoutKey, (vk::DescriptorSetLayout, vk::PipelineLayout)>,
    pipelines: HashMap<PipelineKey, vk::Pipeline>,
    bound: [Option<vk::Pipeline>; 2],
}

#[derive(PartialEq, Eq, Hash, Clone)]
struct LayoutKey {
    bindings: Vec<vk::DescriptorType>,
    compute: bool,
    objects: bool,
}

#[derive(PartialEq, Eq, Hash)]
struct PipelineKey {
    shader: String,
    layout: vk::PipelineLayout,
    color: Vec<(vk::Format, Blend)>,
    depth: Option<(vk::Format, plan::DepthState)>,
}

impl<'m> PassMaker<'m> {
    pub(super) fn new(
        device: &'m Device,
        plan: &'m Plan,
        images: &'m Images,
        object_sets: Option<[vk::DescriptorSetLayout; 2]>,
        modules: Modules,
        made: &'m mut Made,
    ) -> PassMaker<'m> {
        let clamp = vk::SamplerAddressMode::CLAMP_TO_EDGE;
        let info = vk::SamplerCreateInfo::default().address_mode_u(clamp).address_mode_v(clamp).address_mode_w(clamp);
        // SAFETY: the device lives.
        let sampler = unsafe { device.raw().create_sampler(&info, None) }.expect("a sampler");
        made.samplers.push(sampler);
        PassMaker {
            device,
            plan,
            images,
            object_sets,
            modules,
            made,
            sampler,
            layouts: HashMap::new(),
            pipelines: HashMap::new(),
            bound: [None; 2],
        }
    }

    pub(super) fn attachment(&self, attachment: &Attachment) -> vk::RenderingAttachmentInfo<'static> {
        assert!(attachment.resolve.is_none(), "the frame has one sample");
        let info = vk::RenderingAttachmentInfo::default()
            .image_view(self.images.views[attachment.image.0 as usize])
            .image_layout(convert::layout(attachment.layout))
            .load_op(convert::load(attachment.load))
            .store_op(convert::store(attachment.store));
        match attachment.clear.filter(|_| attachment.load == LoadOp::Clear) {
            None => info,
            Some(value) if attachment.range.aspects == Aspects::COLOR => {
                info.clear_value(vk::ClearValue { color: vk::ClearColorValue { float32: value.map(|it| it as f32) } })
            }
            Some([depth, ..]) => info.clear_value(vk::ClearValue {
                depth_stencil: vk::ClearDepthStencilValue { depth: depth as f32, stencil: 0 },
            }),
        }
    }

    pub(super) fn draw(&mut self, scope: &RenderScope, pass: &plan::Pass) -> Pass {
        let draws_objects = matches!(pass.draw, Some(Draw::Objects(_)));
        let (layout, set) = self.set(pass, false);
        let format = |it: &Attachment| convert::format(self.plan.image(it.image).format);
        let key = PipelineKey {
            shader: pass.shader.to_string(),
            layout,
            color: scope.color().iter().map(format).zip(pass.blend.iter().copied()).collect(),
            depth: scope.depth().map(format).zip(pass.depth),
        };
        assert_eq!(key.color.len(), scope.color().len(), "a pass draws all attachments of its scope");
        let pipeline = match self.pipelines.get(&key) {
            Some(pipeline) => *pipeline,
            None => {
                let pipeline = graphics_pipeline(self.device, &key, &self.modules, draws_objects);
                self.made.pipelines.push(pipeline);
                self.pipelines.insert(key, pipeline);
                pipeline
            }
        };
        let new = self.bound[0].replace(pipeline) != Some(pipeline);
        Pass { pipeline: new.then_some(pipeline), layout, set, draws_objects }
    }

    pub(super) fn dispatch(&mut self, pass: &plan::Pass) -> StepWork {
        let (layout, set) = self.set(pass, true);
        let key = PipelineKey { shader: pass.shader.to_string(), layout, color: Vec::new(), depth: None };
        let pipeline = *self.pipelines.entry(key).or_insert_with(|| {
            let module = self.modules[&*format!("{}.comp", pass.shader)];
            let stage = stage(vk::ShaderStageFlags::COMPUTE, module);
            let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout);
            // SAFETY: module and layout live.
            let made = unsafe { self.device.raw().create_compute_pipelines(vk::PipelineCache::null(), &[info], None) };
            let pipeline = made.expect("a pipeline")[0];
            self.made.pipelines.push(pipeline);
            pipeline
        });
        let Some(Groups::Invocations(wanted)) = pass.groups else { panic!("a dispatch counts invocations") };
        let groups = [wanted[0].div_ceil(GROUP), wanted[1].div_ceil(GROUP), wanted[2]];
        let new = self.bound[1].replace(pipeline) != Some(pipeline);
        StepWork::Dispatch(Pass { pipeline: new.then_some(pipeline), layout, set, draws_objects: false }, groups)
    }

    /// The pass's own set, and the layout of its pipeline.
    fn set(&mut self, pass: &plan::Pass, compute: bool) -> (vk::PipelineLayout, Option<vk::DescriptorSet>) {
        let bound: Vec<_> = pass.accesses.iter().filter(|access| access.binding.is_some()).collect();
        // Sampled images come first, in the order of their numbers, and the stored one last.
        let kind = |access: &&plan::Access| match access.binding.as_ref().map(|binding| binding.kind) {
            Some(BindingKind::Storage) => vk::DescriptorType::STORAGE_IMAGE,
            _ => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        };
        let number = |access: &plan::Access| {
            let name = access.binding.as_ref().map(|binding| &*binding.name).unwrap_or_default();
            name.strip_prefix("source").and_then(|number| number.parse().ok()).unwrap_or(bound.len() - 1)
        };
        let mut sorted = bound.clone();
        sorted.sort_by_key(|access| number(access));
        let objects = matches!(pass.draw, Some(Draw::Objects(_)));
        let key = LayoutKey { bindings: sorted.iter().map(kind).collect(), compute, objects };
        let (set_layout, layout) = self.layouts(&key);
        if sorted.is_empty() {
            return (layout, None);
        }
        let set = set(self.device, set_layout, &key.bindings, self.made);
        for (binding, (access, ty)) in (0..).zip(sorted.iter().zip(&key.bindings)) {
            let info = [vk::DescriptorImageInfo {
                sampler: self.sampler,
                image_view: self.images.views[access.image.0 as usize],
                image_layout: convert::layout(access.layout),
            }];
            let write = vk::WriteDescriptorSet::default().dst_set(set).dst_binding(binding).descriptor_type(*ty);
            // SAFETY: the set is new, and the view lives.
            unsafe { self.device.raw().update_descriptor_sets(&[write.image_info(&info)], &[]) };
        }
        (layout, Some(set))
    }

    fn layouts(&mut self, key: &LayoutKey) -> (vk::DescriptorSetLayout, vk::PipelineLayout) {
        if let Some(known) = self.layouts.get(key) {
            return *known;
        }
        let stages = if key.compute { vk::ShaderStageFlags::COMPUTE } else { vk::ShaderStageFlags::FRAGMENT };
        let binding = |(number, ty): (u32, &vk::DescriptorType)| {
            let binding = vk::DescriptorSetLayoutBinding::default().binding(number).descriptor_type(*ty);
            binding.descriptor_count(1).stage_flags(stages)
        };
        let bindings: Vec<_> = (0..).zip(&key.bindings).map(binding).collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: the device lives, and so do all set layouts.
        let made = unsafe {
            let set = self.device.raw().create_descriptor_set_layout(&info, None).expect("a set layout");
            let more = self.object_sets.filter(|_| key.objects).unwrap_or_default();
            let sets = [set, more[0], more[1]];
            let sets = if key.objects { &sets[..] } else { &sets[..1] };
            let info = vk::PipelineLayoutCreateInfo::default().set_layouts(sets);
            (set, self.device.raw().create_pipeline_layout(&info, None).expect("a layout"))
        };
        self.made.set_layouts.push(made.0);
        self.made.layouts.push(made.1);
        self.layouts.insert(key.clone(), made);
        made
    }
}

/// A set of these descriptors, in a pool of its own.
pub(super) fn set(
    device: &Device,
    layout: vk::DescriptorSetLayout,
    descriptors: &[vk::DescriptorType],
    made: &mut Made,
) -> vk::DescriptorSet {
    let sizes: Vec<_> = descriptors.iter().map(|ty| vk::DescriptorPoolSize { ty: *ty, descriptor_count: 1 }).collect();
    let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
    // SAFETY: the device and the layout live.
    unsafe {
        let pool = device.raw().create_descriptor_pool(&info, None).expect("a descriptor pool");
        made.pools.push(pool);
        let layouts = [layout];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
        device.raw().allocate_descriptor_sets(&info).expect("a descriptor set")[0]
    }
}

/// The modules of all shaders.
pub(super) fn shader_modules(device: &Device, shaders: Shaders, made: &mut Made) -> Modules {
    let compiler = shaderc::Compiler::new().expect("a compiler");
    let mut options = shaderc::CompileOptions::new().expect("options");
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_3 as u32);
    let module = |(name, text): &(&'static str, &'static str)| {
        let kind = match name.rsplit_once('.') {
            Some((_, "vert")) => shaderc::ShaderKind::Vertex,
            Some((_, "frag")) => shaderc::ShaderKind::Fragment,
            _ => shaderc::ShaderKind::Compute,
        };
        let compiled = compiler.compile_into_spirv(text, kind, name, "main", Some(&options)).expect("a shader");
        let info = vk::ShaderModuleCreateInfo::default().code(compiled.as_binary());
        // SAFETY: the code was compiled for Vulkan 1.3.
        let module = unsafe { device.raw().create_shader_module(&info, None) }.expect("a module");
        made.modules.push(module);
        (*name, module)
    };
    shaders.iter().map(module).collect()
}

fn stage(stage: vk::ShaderStageFlags, module: vk::ShaderModule) -> vk::PipelineShaderStageCreateInfo<'static> {
    vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main")
}

fn graphics_pipeline(device: &Device, key: &PipelineKey, modules: &Modules, objects: bool) -> vk::Pipeline {
    let vertex = if objects { "objects.vert" } else { "full_screen.vert" };
    let stages = [
        stage(vk::ShaderStageFlags::VERTEX, modules[vertex]),
        stage(vk::ShaderStageFlags::FRAGMENT, modules[&*format!("{}.frag", key.shader)]),
    ];
    let bindings = [vk::VertexInputBindingDescription { stride: VERTEX_BYTES, ..Default::default() }];
    let attributes = [vk::VertexInputAttributeDescription { format: vk::Format::R32G32_SFLOAT, ..Default::default() }];
    let mut vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
    if objects {
        vertex_input = vertex_input.vertex_binding_descriptions(&bindings).vertex_attribute_descriptions(&attributes);
    }
    let input_assembly =
        vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let multisample =
        vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(vk::SampleCountFlags::TYPE_1);
    let mut depth = vk::PipelineDepthStencilStateCreateInfo::default();
    if let Some((_, state)) = key.depth {
        depth = depth
            .depth_test_enable(true)
            .depth_write_enable(state.write)
            .depth_compare_op(convert::compare(state.test));
    }
    let blends: Vec<_> = key.color.iter().map(|(_, blend)| blend_state(*blend)).collect();
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
    let formats: Vec<_> = key.color.iter().map(|(format, _)| *format).collect();
    let mut rendering = vk::PipelineRenderingCreateInfo::default()
        .color_attachment_formats(&formats)
        .depth_attachment_format(key.depth.map_or(vk::Format::UNDEFINED, |(format, _)| format));
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
        .layout(key.layout)
        .push_next(&mut rendering);
    // SAFETY: everything that `info` points to outlives the call, and the shaders fit the layout.
    let made = unsafe { device.raw().create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
    made.expect("a pipeline")[0]
}

fn blend_state(blend: Blend) -> vk::PipelineColorBlendAttachmentState {
    let state = vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA);
    match blend {
        Blend::Alpha => state
            .blend_enable(true)
            .src_color_blend_factor(vk::BlendFactor::SRC_ALPHA)
            .dst_color_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA),
        _ => state,
    }
}
