//! A program with an upscaler of its own, which records it where the pipeline says `custom: "upscale"`.

use ash::vk;
use framewright_graph::frame::Draw;
use framewright_passes::draw::SceneDrawSource;
use framewright_vulkan::{CustomRecorder, Device, DrawSource, Error, Recorder};

/// Repeats texels; beside red and green it keeps what else it was given.
const SHADER: &str = "#version 460
    layout(local_size_x = 8, local_size_y = 8) in;
    layout(set = 0, binding = 0) uniform sampler2D color;
    layout(set = 0, binding = 1) uniform sampler2D depth;
    layout(set = 0, binding = 2) uniform sampler2D motion;
    layout(set = 0, binding = 3, rgba16f) writeonly uniform image2D upscaled;
    layout(push_constant) uniform Frame { vec2 jitter; ivec2 rendered; } frame;
    void main() {
        const ivec2 size = imageSize(upscaled);
        const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
        if (any(greaterThanEqual(at, size))) {
            return;
        }
        const ivec2 texel = at * frame.rendered / size;
        const float moved = texelFetch(motion, texel, 0).r;
        const float distance = texelFetch(depth, texel, 0).r;
        imageStore(upscaled, at, vec4(texelFetch(color, texel, 0).rg, distance, moved + frame.jitter.x));
    }";

/// Images that the upscaler reads and writes: the pass's names for them, their formats and parts.
const IMAGES: [(&str, vk::Format, vk::ImageAspectFlags); 4] = [
    ("color", vk::Format::R16G16B16A16_SFLOAT, vk::ImageAspectFlags::COLOR),
    ("depth", vk::Format::D32_SFLOAT, vk::ImageAspectFlags::DEPTH),
    ("motion", vk::Format::R16G16_SFLOAT, vk::ImageAspectFlags::COLOR),
    ("upscaled", vk::Format::R16G16B16A16_SFLOAT, vk::ImageAspectFlags::COLOR),
];

/// Draws a scene, and upscales.
pub(crate) struct Upscaler {
    device: Device,
    pub(crate) objects: SceneDrawSource,
    set_layout: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    sampler: vk::Sampler,
    /// Pools of every frame that was recorded.
    pools: Vec<vk::DescriptorPool>,
    views: Vec<vk::ImageView>,
    /// By how many texels each frame was shifted.
    pub(crate) told: Vec<[f64; 2]>,
}

fn kind(binding: usize) -> vk::DescriptorType {
    if binding == 3 { vk::DescriptorType::STORAGE_IMAGE } else { vk::DescriptorType::COMBINED_IMAGE_SAMPLER }
}

impl Upscaler {
    pub(crate) fn new(device: &Device, objects: SceneDrawSource) -> Upscaler {
        let compiler = shaderc::Compiler::new().expect("a compiler");
        let spirv = compiler.compile_into_spirv(SHADER, shaderc::ShaderKind::Compute, "upscale.comp", "main", None);
        let spirv = spirv.expect("it compiles");
        let bindings: Vec<_> = (0..4)
            .map(|binding| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(binding)
                    .descriptor_type(kind(binding as usize))
                    .descriptor_count(1)
                    .stage_flags(vk::ShaderStageFlags::COMPUTE)
            })
            .collect();
        let raw = device.raw();
        // SAFETY: the device lives as long as this, everything given to it is valid, and drop destroys what is made.
        unsafe {
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let set_layout = raw.create_descriptor_set_layout(&info, None).expect("a set layout");
            let (layouts, constants) =
                ([set_layout], [vk::PushConstantRange::default().stage_flags(vk::ShaderStageFlags::COMPUTE).size(16)]);
            let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts).push_constant_ranges(&constants);
            let layout = raw.create_pipeline_layout(&info, None).expect("a layout");
            let info = vk::ShaderModuleCreateInfo::default().code(spirv.as_binary());
            let module = raw.create_shader_module(&info, None).expect("a module");
            let stage = vk::PipelineShaderStageCreateInfo::default()
                .stage(vk::ShaderStageFlags::COMPUTE)
                .module(module)
                .name(c"main");
            let infos = [vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout)];
            let made = raw.create_compute_pipelines(vk::PipelineCache::null(), &infos, None).expect("a pipeline");
            raw.destroy_shader_module(module, None);
            let sampler = raw.create_sampler(&vk::SamplerCreateInfo::default(), None).expect("a sampler");
            let (device, pipeline) = (device.clone(), made[0]);
            let (pools, views, told) = (Vec::new(), Vec::new(), Vec::new());
            Upscaler { device, objects, set_layout, layout, pipeline, sampler, pools, views, told }
        }
    }

    /// A set with the pass's images.
    fn set(&mut self, recorder: &CustomRecorder<'_>) -> vk::DescriptorSet {
        let raw = self.device.raw();
        let sizes = [
            vk::DescriptorPoolSize { ty: kind(0), descriptor_count: 3 },
            vk::DescriptorPoolSize { ty: kind(3), descriptor_count: 1 },
        ];
        let layouts = [self.set_layout];
        // SAFETY: as above; the images are the pass's own, and the views go before them.
        unsafe {
            let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
            let pool = raw.create_descriptor_pool(&info, None).expect("a pool");
            self.pools.push(pool);
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
            let set = raw.allocate_descriptor_sets(&info).expect("a set")[0];
            for (binding, (name, format, aspect_mask)) in IMAGES.into_iter().enumerate() {
                let image = recorder.image(name).expect("the pass names it");
                let info = vk::ImageViewCreateInfo::default()
                    .image(image.raw)
                    .view_type(vk::ImageViewType::TYPE_2D)
                    .format(format)
                    .subresource_range(vk::ImageSubresourceRange {
                        aspect_mask,
                        base_mip_level: image.range.base_mip,
                        level_count: 1,
                        base_array_layer: image.range.base_layer,
                        layer_count: 1,
                    });
                let view = raw.create_image_view(&info, None).expect("a view");
                self.views.push(view);
                let info =
                    [vk::DescriptorImageInfo { sampler: self.sampler, image_view: view, image_layout: image.layout }];
                let write = vk::WriteDescriptorSet::default()
                    .dst_set(set)
                    .dst_binding(binding as u32)
                    .descriptor_type(kind(binding))
                    .image_info(&info);
                raw.update_descriptor_sets(&[write], &[]);
            }
            set
        }
    }
}

impl DrawSource for Upscaler {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        self.objects.record(draw, recorder)
    }

    fn custom(&mut self, callback: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        assert_eq!(callback, "upscale");
        assert_eq!(recorder.frame(), self.told.len() as u64);
        let [width, height] = recorder.view().expect("the pipeline has a view").extent;
        let jitter = recorder.jitter();
        self.told.push(jitter);
        let set = self.set(recorder);
        let [across, down, _] = recorder.image("color").expect("the pass names it").extent;
        let jitter = jitter.map(|part| (part as f32).to_ne_bytes());
        let bytes: Vec<u8> = jitter.into_iter().chain([across, down].map(u32::to_ne_bytes)).flatten().collect();
        let (raw, commands) = (self.device.raw(), recorder.raw());
        // SAFETY: the commands are recorded outside of rendering scopes, and touch the images as the pass declares them.
        unsafe {
            raw.cmd_bind_pipeline(commands, vk::PipelineBindPoint::COMPUTE, self.pipeline);
            raw.cmd_bind_descriptor_sets(commands, vk::PipelineBindPoint::COMPUTE, self.layout, 0, &[set], &[]);
            raw.cmd_push_constants(commands, self.layout, vk::ShaderStageFlags::COMPUTE, 0, &bytes);
            raw.cmd_dispatch(commands, width.div_ceil(8), height.div_ceil(8), 1);
        }
        Ok(())
    }
}

impl Drop for Upscaler {
    fn drop(&mut self) {
        let raw = self.device.raw();
        // SAFETY: every frame was waited for, and nothing uses these afterwards.
        unsafe {
            self.views.iter().for_each(|view| raw.destroy_image_view(*view, None));
            self.pools.iter().for_each(|pool| raw.destroy_descriptor_pool(*pool, None));
            raw.destroy_pipeline(self.pipeline, None);
            raw.destroy_pipeline_layout(self.layout, None);
            raw.destroy_descriptor_set_layout(self.set_layout, None);
            raw.destroy_sampler(self.sampler, None);
        }
    }
}
