//! What a program records for both eyes at once (DO-12): transfers, and pipelines of its own within a rendering scope and outside of one.
//! In each way to draw for two eyes the pictures are those of one eye after the other, and what is known of them beforehand.

use crate::frames::on_each_driver;
use ash::vk;
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Eye, EyeForm, Stereo};
use framewright_graph::plan::{Plan, Resource};
use framewright_graph::vulkan::{FillValue, Rotation};
use framewright_tests::render::{Setup, Ways, library, plan_for};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::{
    CustomImage, CustomRecorder, Device, DrawSource, Error, Executor, ExecutorOptions, Recorder, ScopeFormats,
};
use std::collections::HashMap;

/// One eye's picture.
const EXTENT: [u32; 2] = [8, 4];

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
struct Engine<'d> {
    device: &'d Device,
    sets: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    store: vk::Pipeline,
    sampler: vk::Sampler,
    pool: vk::DescriptorPool,
    squares: HashMap<(ScopeFormats, Way), vk::Pipeline>,
    views: Vec<vk::ImageView>,
    /// The passes that were recorded, and for which eye.
    recorded: Vec<(String, Option<Eye>)>,
}

const CONSTANTS: vk::ShaderStageFlags =
    vk::ShaderStageFlags::from_raw(vk::ShaderStageFlags::VERTEX.as_raw() | vk::ShaderStageFlags::COMPUTE.as_raw());

impl Engine<'_> {
    fn new(device: &Device) -> Engine<'_> {
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
        let sizes = kinds.map(|kind| vk::DescriptorPoolSize::default().ty(kind).descriptor_count(8));
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
            let pool = vk::DescriptorPoolCreateInfo::default().max_sets(8).pool_sizes(&sizes);
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
            }
        }
    }

    /// Makes the pipeline of a pass before the first frame.
    fn prepare(&mut self, executor: &Executor, pass: &str) {
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

impl DrawSource for Engine<'_> {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        self.recorded.push((recorder.shader().to_owned(), recorder.eye()));
        if recorder.shader() == "noted_eye" {
            // The recorder's own draws are for both eyes by themselves.
            recorder.draw(0..3, 0..1);
            return Ok(1);
        }
        assert_eq!((recorder.extent(), recorder.eye_targets().is_some()), (EXTENT, recorder.both_eyes().is_some()));
        let way = Way::of(recorder.both_eyes());
        assert_eq!(recorder.formats().view_mask, if way == Way::ByView { 0b11 } else { 0 });
        let square = self.squares[&(recorder.formats().clone(), way)];
        let targets = recorder.eye_targets().filter(|_| way == Way::Told);
        let own = recorder.eye().unwrap_or(Eye::Left) as i32;
        let (commands, raw) = (recorder.raw(), self.device.raw());
        // SAFETY: within the scope; the pipeline fits its formats, and viewport and scissor are set.
        unsafe {
            raw.cmd_bind_pipeline(commands, vk::PipelineBindPoint::GRAPHICS, square);
            match targets {
                None => {
                    self.push(commands, &[own, 0, 0]);
                    raw.cmd_draw(commands, 4, if way == Way::ByInstance { 2 } else { 1 }, 0, 0);
                }
                Some(targets) => {
                    for target in targets {
                        self.push(commands, &[target.eye as i32, 0, 0]);
                        raw.cmd_set_viewport(commands, 0, &[target.viewport]);
                        raw.cmd_set_scissor(commands, 0, &[target.scissor]);
                        raw.cmd_draw(commands, 4, 1, 0, 0);
                    }
                }
            }
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
            }
            "keep" => {
                let [source, target] = [named(recorder.sources().next()), named(recorder.targets().next())];
                recorder.copy(&source, &target);
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

/// What each eye sees: its square, in its colour, with the blue that tells the eye, and channels exchanged.
fn expected() -> [Vec<[u8; 4]>; 2] {
    [0, 1].map(|eye| {
        let texel = |at: u32| {
            let (x, y) = (at % EXTENT[0], at / EXTENT[0]);
            let inside = (1 + eye..3 + eye).contains(&x) && (1..3).contains(&y);
            let blue = 51 * (1 + eye as u8);
            let [red, green] = if inside { [[255, 0], [0, 255]][eye as usize] } else { [0, 0] };
            if eye == 0 { [blue, green, red, 255] } else { [blue, red, green, 255] }
        };
        (0..EXTENT[0] * EXTENT[1]).map(texel).collect()
    })
}

/// Both eyes' parts of the one output.
fn pictures(plan: &Plan, executor: &mut Executor) -> [Vec<[u8; 4]>; 2] {
    let read = |executor: &mut Executor, at| executor.read(at).expect("a picture").bytes.as_chunks().0.to_vec();
    let first = read(executor, 0);
    let Resource::Image(image) = plan.outputs[0].resource else { panic!("an image") };
    let run = match plan.image(image).eyes {
        None => return [first, read(executor, 1)],
        Some(EyeForm::Layers) => first.len() / 2,
        Some(EyeForm::Halves) => EXTENT[0] as usize,
    };
    [0, 1].map(|eye| first.chunks(run).skip(eye).step_by(2).flatten().copied().collect())
}

#[test]
fn do_12_a_program_records_both_eyes_at_once_and_shows_what_it_shows_one_after_the_other() {
    let scene = empty_scene();
    let setup =
        Setup { pipeline: "tests/pipelines/recorded_for_both_eyes.ron", set: &[], scene: &scene, extent: EXTENT };
    on_each_driver(|device| {
        let all = [Stereo::MultiPass, Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview];
        let mut seen = 0;
        for stereo in all.into_iter().filter(|stereo| stereo.lacks(&device.profile()).is_none()) {
            let ways = Ways { stereo, rotation: Rotation::Identity };
            let mut shaders = library();
            let plan = plan_for(device, &setup, ways, &mut shaders, &Options::default());
            let plan = plan.unwrap_or_else(|error| panic!("{stereo:?}: {error}"));
            let mut executor =
                Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
            let mut engine = Engine::new(device);
            let at_once = stereo != Stereo::MultiPass;
            let passes: &[&str] = if at_once { &["draw"] } else { &["draw (left)", "draw (right)"] };
            for pass in passes {
                assert_eq!(executor.both_eyes(pass).map(|it| it.0), at_once.then_some(stereo));
                engine.prepare(&executor, pass);
            }
            assert_eq!(executor.both_eyes("store"), executor.both_eyes("draw"), "{}", plan.tree());
            executor.frame(&mut engine).expect("a frame");
            let names = ["clear", "draw", "noted_eye", "store", "keep"];
            let eyes: &[Option<Eye>] = if at_once { &[None] } else { &[Some(Eye::Left), Some(Eye::Right)] };
            for name in names {
                let by = engine.recorded.iter().filter(|(of, _)| of == name).map(|it| it.1);
                assert_eq!(by.collect::<Vec<_>>(), eyes, "{stereo:?}: {name}");
            }
            assert_eq!(pictures(&plan, &mut executor), expected(), "{stereo:?}\n{}", plan.tree());
            seen += 1;
        }
        assert!(seen >= 2, "{:?}", device.profile());
    });
}
