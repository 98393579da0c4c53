//! A program that records for both eyes at once, or for one after the other.

use super::watched::Lies;
use ash::vk;
use framewright_graph::frame::{Draw, Eye, EyeForm, Stereo};
use framewright_graph::vulkan::FillValue;
use framewright_vulkan::{
    CustomImage, CustomRecorder, Device, DrawSource, Error, Executor, EyeTarget, Recorder, ScopeFormats,
    SecondaryRecorder,
};
use std::collections::HashMap;

/// One eye's picture.
pub(super) const EXTENT: [u32; 2] = [8, 4];

/// A square of two by two texels, one texel further to the right for the right eye.
const SQUARE: &str = "
    layout(push_constant) uniform Push { int told; };
    layout(location = 0) flat out int eye;
    void main() {
        eye = EYE;
        LAYER
        vec2 texel = vec2(1 + eye, 1) + 2.0 * vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
        gl_Position = vec4(texel / vec2(4, 2) - 1.0, 0.0, 1.0);
    }";
const COLOR: &str = "#version 460
    layout(location = 0) flat in int eye;
    layout(location = 0) out vec4 color;
    void main() { color = eye == 0 ? vec4(1.0, 0.0, 0.0, 1.0) : vec4(0.0, 1.0, 0.0, 1.0); }";
/// Exchanges channels, for each eye others.
const STORE: &str = "#version 460
    layout(local_size_x = 1) in;
    layout(push_constant) uniform Push { int first; int layered; int width; };
    layout(set = 0, binding = 0) uniform sampler2DArray source;
    layout(set = 0, binding = 1, rgba8) uniform writeonly image2DArray target;
    void main() {
        ivec3 place = ivec3(gl_GlobalInvocationID.xy, 0);
        int number = int(gl_GlobalInvocationID.z);
        if (layered != 0) place.z = number; else place.x += number * width;
        vec4 texel = texelFetch(source, place, 0);
        imageStore(target, place, first + number == 0 ? texel.bgra : texel.brga);
    }";

/// How the program's vertices know their eye.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Way {
    Told,
    ByView,
    ByInstance,
}

impl Way {
    fn of(both: Option<(Stereo, EyeForm)>) -> Way {
        match both {
            Some((Stereo::Multiview, _)) => Way::ByView,
            Some((_, EyeForm::Layers)) => Way::ByInstance,
            Some((_, EyeForm::Halves)) | None => Way::Told,
        }
    }

    fn vertices(self) -> String {
        let (extension, eye, layer) = match self {
            Way::Told => ("", "told", ""),
            Way::ByView => ("#extension GL_EXT_multiview : require", "int(gl_ViewIndex)", ""),
            Way::ByInstance => {
                ("#extension GL_ARB_shader_viewport_layer_array : require", "gl_InstanceIndex", "gl_Layer = eye;")
            }
        };
        format!("#version 460\n{extension}\n{}", SQUARE.replace("EYE", eye).replace("LAYER", layer))
    }
}

/// A program that knows how both eyes are drawn from what it is told before the first frame.
pub(super) struct Engine<'d> {
    device: &'d Device,
    sets: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    store: vk::Pipeline,
    sampler: vk::Sampler,
    pool: vk::DescriptorPool,
    squares: HashMap<(ScopeFormats, Way), vk::Pipeline>,
    views: Vec<vk::ImageView>,
    /// The passes that were recorded, and for which eye.
    pub(super) recorded: Vec<(String, Option<Eye>)>,
    /// Where the command buffers come from in which the square is drawn; `None`: it is drawn into the frame's own.
    secondary: Option<vk::CommandPool>,
    pub(super) lies: Lies,
}

const CONSTANTS: vk::ShaderStageFlags =
    vk::ShaderStageFlags::from_raw(vk::ShaderStageFlags::VERTEX.as_raw() | vk::ShaderStageFlags::COMPUTE.as_raw());

impl Engine<'_> {
    pub(super) fn new(device: &Device) -> Engine<'_> {
        let raw = device.raw();
        let kinds = [vk::DescriptorType::COMBINED_IMAGE_SAMPLER, vk::DescriptorType::STORAGE_IMAGE];
        let binding = |(number, kind): (u32, vk::DescriptorType)| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(number)
                .descriptor_type(kind)
                .descriptor_count(1)
                .stage_flags(vk::ShaderStageFlags::COMPUTE)
        };
        let bindings: Vec<_> = (0..).zip(kinds).map(binding).collect();
        let sizes = kinds.map(|kind| vk::DescriptorPoolSize::default().ty(kind).descriptor_count(64));
        let pushed = [vk::PushConstantRange::default().stage_flags(CONSTANTS).size(12)];
        let module = module(device, shaderc::ShaderKind::Compute, STORE);
        // SAFETY: the device lives, all that is pointed to outlives the calls, and the SPIR-V comes from the compiler.
        unsafe {
            let sets = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let sets = raw.create_descriptor_set_layout(&sets, None).expect("a layout");
            let layouts = [sets];
            let layout = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts).push_constant_ranges(&pushed);
            let layout = raw.create_pipeline_layout(&layout, None).expect("a layout");
            let stage = stage(vk::ShaderStageFlags::COMPUTE, module);
            let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout);
            let store = raw.create_compute_pipelines(vk::PipelineCache::null(), &[info], None).expect("a pipeline")[0];
            raw.destroy_shader_module(module, None);
            let pool = vk::DescriptorPoolCreateInfo::default().max_sets(64).pool_sizes(&sizes);
            Engine {
                device,
                sets,
                layout,
                store,
                sampler: raw.create_sampler(&vk::SamplerCreateInfo::default(), None).expect("a sampler"),
                pool: raw.create_descriptor_pool(&pool, None).expect("a pool"),
                squares: HashMap::new(),
                views: Vec::new(),
                recorded: Vec::new(),
                secondary: None,
                lies: Lies::default(),
            }
        }
    }

    /// Has the square drawn in secondary command buffers.
    pub(super) fn by_secondary(mut self) -> Self {
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(self.device.graphics_queue_family());
        // SAFETY: the device lives.
        self.secondary = Some(unsafe { self.device.raw().create_command_pool(&info, None) }.expect("a pool"));
        self
    }

    /// Makes the pipeline of a pass before the first frame.
    pub(super) fn prepare(&mut self, executor: &Executor, pass: &str) {
        let (formats, way) = (executor.formats(pass).expect("it is in a scope"), Way::of(executor.both_eyes(pass)));
        let raw = self.device.raw();
        let modules = [
            module(self.device, shaderc::ShaderKind::Vertex, &way.vertices()),
            module(self.device, shaderc::ShaderKind::Fragment, COLOR),
        ];
        let stages =
            [stage(vk::ShaderStageFlags::VERTEX, modules[0]), stage(vk::ShaderStageFlags::FRAGMENT, modules[1])];
        let input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly =
            vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_STRIP);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(formats.samples);
        let all = vk::ColorComponentFlags::RGBA;
        let blends = vec![vk::PipelineColorBlendAttachmentState::default().color_write_mask(all); formats.color.len()];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .view_mask(formats.view_mask)
            .color_attachment_formats(&formats.color);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(self.layout)
            .push_next(&mut rendering);
        // SAFETY: all that `info` points to outlives the call.
        let made = unsafe {
            let made = raw.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None).expect("a pipeline");
            modules.iter().for_each(|module| raw.destroy_shader_module(*module, None));
            made[0]
        };
        let before = self.squares.insert((formats, way), made);
        // SAFETY: no frame uses it.
        before.into_iter().for_each(|before| unsafe { raw.destroy_pipeline(before, None) });
    }

    fn push(&self, commands: vk::CommandBuffer, words: &[i32]) {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
        // SAFETY: the command buffer is being recorded, and the layout has as many bytes for these stages.
        unsafe { self.device.raw().cmd_push_constants(commands, self.layout, CONSTANTS, 0, &bytes) };
    }

    /// A view of both eyes' layers, or of the one that there is.
    fn view(&mut self, image: &CustomImage) -> vk::ImageView {
        let range = vk::ImageSubresourceRange {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            level_count: image.range.mips,
            layer_count: image.range.layers,
            ..vk::ImageSubresourceRange::default()
        };
        let info = vk::ImageViewCreateInfo::default()
            .image(image.raw)
            .view_type(vk::ImageViewType::TYPE_2D_ARRAY)
            .format(vk::Format::R8G8B8A8_UNORM)
            .subresource_range(range);
        // SAFETY: the image lives, and the view is destroyed after the frames.
        let view = unsafe { self.device.raw().create_image_view(&info, None) }.expect("a view");
        self.views.push(view);
        view
    }

    /// Stores for both eyes by one dispatch, or for one.
    fn store(&mut self, recorder: &mut CustomRecorder<'_>) {
        let [source, target] = ["source", "target"].map(|name| recorder.image(name).expect("the pass names it"));
        let both = recorder.both_eyes();
        assert_eq!((source.eyes, target.eyes), (both.map(|it| it.1), both.map(|it| it.1)));
        assert_eq!((source.eye, target.eye), (None, None), "both eyes', or an image of its own");
        assert_eq!((source.extent, target.extent), ([8, 4, 1], [8, 4, 1]), "one eye's");
        assert_eq!(target.range.layers, if target.eyes == Some(EyeForm::Layers) { 2 } else { 1 });
        assert_eq!(recorder.eye(), recorder.view().and_then(|view| view.eye).map(|of| of.eye));
        assert_eq!(recorder.eye().is_none(), both.is_some());
        let eye = recorder.eye().map_or(0, |eye| eye as i32);
        let commands = recorder.raw();
        let views = [self.view(&source), self.view(&target)];
        let raw = self.device.raw();
        let layouts = [self.sets];
        let set = vk::DescriptorSetAllocateInfo::default().descriptor_pool(self.pool).set_layouts(&layouts);
        let described = [(views[0], source.layout), (views[1], target.layout)].map(|(view, layout)| {
            [vk::DescriptorImageInfo::default().sampler(self.sampler).image_view(view).image_layout(layout)]
        });
        let layered = i32::from(target.eyes == Some(EyeForm::Layers));
        self.push(commands, &[eye, layered, EXTENT[0].cast_signed()]);
        // SAFETY: the images are in these layouts, and views and sets live as long as the program, which outlives the frames.
        unsafe {
            let set = raw.allocate_descriptor_sets(&set).expect("a set")[0];
            let kinds = [vk::DescriptorType::COMBINED_IMAGE_SAMPLER, vk::DescriptorType::STORAGE_IMAGE];
            for (binding, (kind, described)) in (0..).zip(kinds.into_iter().zip(&described)) {
                let write = vk::WriteDescriptorSet::default().dst_set(set).dst_binding(binding);
                raw.update_descriptor_sets(&[write.descriptor_type(kind).image_info(described)], &[]);
            }
            let point = vk::PipelineBindPoint::COMPUTE;
            raw.cmd_bind_pipeline(commands, point, self.store);
            raw.cmd_bind_descriptor_sets(commands, point, self.layout, 0, &[set], &[]);
            raw.cmd_dispatch(commands, EXTENT[0], EXTENT[1], if both.is_some() { 2 } else { 1 });
        }
    }
}

/// Where the program draws its square.
struct Square {
    formats: ScopeFormats,
    both: Option<(Stereo, EyeForm)>,
    targets: Option<[EyeTarget; 2]>,
    extent: [u32; 2],
    /// The eye, where one is drawn for.
    own: Eye,
}

impl Engine<'_> {
    /// # Safety
    /// The command buffer is being recorded within the scope, or for it.
    unsafe fn square(&self, commands: vk::CommandBuffer, square: &Square) {
        let way = Way::of(square.both);
        assert_eq!(square.formats.view_mask, if way == Way::ByView { 0b11 } else { 0 });
        let pipeline = self.squares[&(square.formats.clone(), way)];
        let [width, height] = square.extent;
        let scissor = vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() };
        let [right, down] = square.extent.map(|side| side as f32);
        let viewport = vk::Viewport { width: right, height: down, max_depth: 1.0, ..Default::default() };
        let whole = (square.own, viewport, scissor, if way == Way::ByInstance { 2 } else { 1 });
        let each = square.targets.filter(|_| way == Way::Told);
        let each = each.map(|targets| targets.map(|it| (it.eye, it.viewport, it.scissor, 1)).to_vec());
        let raw = self.device.raw();
        // SAFETY: the caller's word; the pipeline fits the scope's formats.
        unsafe {
            raw.cmd_bind_pipeline(commands, vk::PipelineBindPoint::GRAPHICS, pipeline);
            for (eye, viewport, scissor, instances) in each.unwrap_or_else(|| vec![whole]) {
                self.push(commands, &[eye as i32, 0, 0]);
                raw.cmd_set_viewport(commands, 0, &[viewport]);
                raw.cmd_set_scissor(commands, 0, &[scissor]);
                raw.cmd_draw(commands, 4, instances, 0, 0);
            }
        }
    }
}

impl DrawSource for Engine<'_> {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        self.recorded.push((recorder.shader().to_owned(), recorder.eye()));
        if recorder.shader() == "noted_eye" {
            // The recorder's own draws are for both eyes by themselves.
            recorder.draw(0..3, 0..1);
            return Ok(1);
        }
        assert_eq!((recorder.extent(), recorder.eye_targets().is_some()), (EXTENT, recorder.both_eyes().is_some()));
        self.lies.keep(recorder.image("screen"));
        let square = Square {
            formats: recorder.formats().clone(),
            both: recorder.both_eyes(),
            targets: recorder.eye_targets(),
            extent: recorder.target_extent(),
            own: recorder.eye().unwrap_or(Eye::Left),
        };
        let commands = recorder.raw();
        // SAFETY: within the scope.
        unsafe { self.square(commands, &square) };
        Ok(1)
    }

    fn has_secondary(&mut self, callback: &str) -> bool {
        self.secondary.is_some() && callback == "draw"
    }

    fn secondary(&mut self, callback: &str, recorder: &mut SecondaryRecorder<'_>) -> Result<u32, Error> {
        self.recorded.push((callback.to_owned(), recorder.eye()));
        assert_eq!(
            (recorder.target_extent(), recorder.eye_targets().is_some()),
            (EXTENT, recorder.both_eyes().is_some())
        );
        let square = Square {
            formats: recorder.formats().clone(),
            both: recorder.both_eyes(),
            targets: recorder.eye_targets(),
            extent: recorder.target_extent(),
            own: recorder.eye().unwrap_or(Eye::Left),
        };
        let raw = self.device.raw();
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(self.secondary.expect("it says that it has some"))
            .level(vk::CommandBufferLevel::SECONDARY)
            .command_buffer_count(1);
        let mut scope = recorder.inheritance();
        let inherited = vk::CommandBufferInheritanceInfo::default().push_next(&mut scope);
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::RENDER_PASS_CONTINUE)
            .inheritance_info(&inherited);
        // SAFETY: it is begun for this scope, sets all state that its draws need, and its pool outlives the frames.
        unsafe {
            let commands = raw.allocate_command_buffers(&info).expect("a command buffer")[0];
            raw.begin_command_buffer(commands, &begin).expect("begun");
            self.square(commands, &square);
            raw.end_command_buffer(commands).expect("ended");
            recorder.execute(&[commands]);
        }
        Ok(1)
    }

    fn custom(&mut self, callback: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        let eye = recorder.view().and_then(|view| view.eye).map(|of| of.eye);
        self.recorded.push((callback.to_owned(), eye));
        let named = |name: Option<&str>| name.expect("the pass names one").to_owned();
        match callback {
            "clear" => {
                let target = named(recorder.targets().next());
                recorder.fill(&target, FillValue::Color([0.0, 0.0, 0.0, 1.0]));
                self.lies.tell(self.device, recorder, [&target, &target]);
            }
            "keep" => {
                let [source, target] = [named(recorder.sources().next()), named(recorder.targets().next())];
                if !self.lies.leaves_one_eye(self.device, recorder, [&source, &target]) {
                    recorder.copy(&source, &target);
                }
                self.lies.tell(self.device, recorder, [&source, &target]);
            }
            _ => self.store(recorder),
        }
        Ok(())
    }
}

impl Drop for Engine<'_> {
    fn drop(&mut self) {
        let raw = self.device.raw();
        // SAFETY: the frames were waited for.
        unsafe {
            self.views.iter().for_each(|view| raw.destroy_image_view(*view, None));
            self.squares.values().chain([&self.store]).for_each(|pipeline| raw.destroy_pipeline(*pipeline, None));
            raw.destroy_pipeline_layout(self.layout, None);
            raw.destroy_descriptor_pool(self.pool, None);
            raw.destroy_descriptor_set_layout(self.sets, None);
            raw.destroy_sampler(self.sampler, None);
            self.secondary.into_iter().for_each(|pool| raw.destroy_command_pool(pool, None));
        }
    }
}

fn module(device: &Device, kind: shaderc::ShaderKind, text: &str) -> vk::ShaderModule {
    let compiler = shaderc::Compiler::new().expect("a compiler");
    let mut options = shaderc::CompileOptions::new().expect("options");
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_3 as u32);
    let spirv = compiler.compile_into_spirv(text, kind, "shader", "main", Some(&options)).expect("it compiles");
    let info = vk::ShaderModuleCreateInfo::default().code(spirv.as_binary());
    // SAFETY: the device lives, and the SPIR-V comes from the compiler.
    unsafe { device.raw().create_shader_module(&info, None) }.expect("a module")
}

fn stage(stage: vk::ShaderStageFlags, module: vk::ShaderModule) -> vk::PipelineShaderStageCreateInfo<'static> {
    vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main")
}
