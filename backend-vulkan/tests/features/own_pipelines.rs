//! A pass as a scope in which a program binds pipelines of its own: several materials, by what the recorder says of the scope (EM-6).

use crate::frames::{Small, Uses, draw, on_each_driver, planned};
use ash::vk;
use framewright_graph::base::Span;
use framewright_graph::compile::Options;
use framewright_graph::frame::{DepthTarget, Draw, DrawList, Image};
use framewright_graph::shader::{DrawInterface, SuppliedKind, SuppliedResource};
use framewright_graph::vulkan::{CompareOp, Format, Subresources};
use framewright_vulkan::{
    BindGroup, BufferUsage, Device, DrawSource, Error, Executor, ExecutorOptions, Recorder, Resource, ScopeFormats,
    ShaderLibrary,
};
use std::collections::HashMap;

/// A triangle over all of the picture; the larger `depth`, the nearer.
const VERTICES: &str = "#version 460
    layout(push_constant) uniform Push { float depth; };
    void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, depth, 1.0); }";
/// Two materials: a colour, and stripes.
const MATERIALS: [&str; 2] = [
    "#version 460
    layout(location = 0) out vec4 color;
    void main() { color = vec4(1.0, 0.0, 0.0, 1.0); }",
    "#version 460
    layout(location = 0) out vec4 color;
    void main() {
        if ((int(gl_FragCoord.x) & 1) == 1) discard;
        color = vec4(0.0, 1.0, 0.0, 1.0);
    }",
];

/// The picture of four samples, shown.
const SHADERS: &[(&str, &str)] = &[
    (
        "full_screen.vert",
        "#version 460
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0); }",
    ),
    (
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D seen;
        layout(location = 0) out vec4 color;
        void main() { color = texelFetch(seen, ivec2(gl_FragCoord.xy), 0); }",
    ),
    (
        "objects.vert",
        "#version 460
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0); }",
    ),
    (
        "other.frag",
        "#version 460
        #ifdef LOCAL_READ_source
        layout(input_attachment_index = 0, set = 0, binding = 0) uniform subpassInput source;
        #define HERE subpassLoad(source)
        #else
        layout(set = 0, binding = 0) uniform sampler2D source;
        #define HERE texelFetch(source, ivec2(gl_FragCoord.xy), 0)
        #endif
        layout(location = 0) out vec4 color;
        void main() { color = vec4(1.0 - HERE.rgb, 1.0); }",
    ),
    (
        "white.frag",
        "#version 460
        layout(location = 0) out vec4 color;
        void main() { color = vec4(1.0); }",
    ),
];

/// An engine with materials, whose pipelines are made for the scopes in which they are drawn.
struct Engine<'d> {
    device: &'d Device,
    layout: vk::PipelineLayout,
    modules: [vk::ShaderModule; 3],
    pipelines: HashMap<ScopeFormats, [vk::Pipeline; 2]>,
}

impl Engine<'_> {
    fn new(device: &Device) -> Engine<'_> {
        let raw = device.raw();
        let compiler = shaderc::Compiler::new().expect("a compiler");
        let module = |kind, text: &str| {
            let spirv = compiler.compile_into_spirv(text, kind, "shader", "main", None).expect("it compiles");
            let info = vk::ShaderModuleCreateInfo::default().code(spirv.as_binary());
            // SAFETY: the device lives, and the SPIR-V comes from the compiler.
            unsafe { raw.create_shader_module(&info, None) }.expect("a module")
        };
        let [red, stripes] = MATERIALS.map(|text| module(shaderc::ShaderKind::Fragment, text));
        let modules = [module(shaderc::ShaderKind::Vertex, VERTICES), red, stripes];
        let depth = [vk::PushConstantRange::default().stage_flags(vk::ShaderStageFlags::VERTEX).size(4)];
        let info = vk::PipelineLayoutCreateInfo::default().push_constant_ranges(&depth);
        // SAFETY: the device lives.
        let layout = unsafe { raw.create_pipeline_layout(&info, None) }.expect("a layout");
        Engine { device, layout, modules, pipelines: HashMap::new() }
    }

    /// A pipeline for each material, which fits these scopes.
    fn pipelines(&self, formats: &ScopeFormats) -> [vk::Pipeline; 2] {
        let [vertex, materials @ ..] = self.modules;
        let stage =
            |stage, module| vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main");
        let input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly =
            vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(formats.samples);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(true)
            .depth_write_enable(true)
            .depth_compare_op(vk::CompareOp::GREATER);
        let local = formats.local.as_ref();
        // Of colours of the scope that aren't those of the pass nothing is written.
        let blends: Vec<_> = (0..formats.color.len())
            .map(|number| match local.is_none_or(|local| local.drawn[number]) {
                true => vk::ColorComponentFlags::RGBA,
                false => vk::ColorComponentFlags::empty(),
            })
            .map(|written| vk::PipelineColorBlendAttachmentState::default().color_write_mask(written))
            .collect();
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
        materials.map(|material| {
            let stages = [stage(vk::ShaderStageFlags::VERTEX, vertex), stage(vk::ShaderStageFlags::FRAGMENT, material)];
            let mut rendering = vk::PipelineRenderingCreateInfo::default()
                .view_mask(formats.view_mask)
                .color_attachment_formats(&formats.color)
                .depth_attachment_format(formats.depth)
                .stencil_attachment_format(formats.stencil);
            let (mut locations, mut inputs) = (
                vk::RenderingAttachmentLocationInfoKHR::default()
                    .color_attachment_locations(local.map_or(&[], |local| &local.locations)),
                vk::RenderingInputAttachmentIndexInfoKHR::default()
                    .color_attachment_input_indices(local.map_or(&[], |local| &local.inputs)),
            );
            let mut info = vk::GraphicsPipelineCreateInfo::default()
                .stages(&stages)
                .vertex_input_state(&input)
                .input_assembly_state(&assembly)
                .viewport_state(&viewport)
                .rasterization_state(&raster)
                .multisample_state(&samples)
                .depth_stencil_state(&depth)
                .color_blend_state(&blend)
                .dynamic_state(&dynamic)
                .layout(self.layout)
                .push_next(&mut rendering);
            if local.is_some() {
                info = info.push_next(&mut locations).push_next(&mut inputs);
            }
            // SAFETY: all that `info` points to outlives the call.
            let made = unsafe { self.device.raw().create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
            made.expect("a pipeline")[0]
        })
    }
}

impl DrawSource for Engine<'_> {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let pipelines = self.pipelines.get(recorder.formats()).expect("made before the first frame");
        let commands = recorder.raw();
        let raw = self.device.raw();
        for (pipeline, depth) in pipelines.iter().zip([0.75_f32, 0.25]) {
            // SAFETY: within the scope; the pipelines fit its formats.
            unsafe {
                raw.cmd_bind_pipeline(commands, vk::PipelineBindPoint::GRAPHICS, *pipeline);
                let stage = vk::ShaderStageFlags::VERTEX;
                raw.cmd_push_constants(commands, self.layout, stage, 0, &depth.to_ne_bytes());
                raw.cmd_draw(commands, 3, 1, 0, 0);
            }
        }
        Ok(2)
    }
}

impl Drop for Engine<'_> {
    fn drop(&mut self) {
        let raw = self.device.raw();
        // SAFETY: the frames were waited for.
        unsafe {
            self.pipelines.values().flatten().for_each(|pipeline| raw.destroy_pipeline(*pipeline, None));
            raw.destroy_pipeline_layout(self.layout, None);
            self.modules.iter().for_each(|module| raw.destroy_shader_module(*module, None));
        }
    }
}

/// What a pass without a shader of the pipeline's can see, and can't.
struct Looks;

impl DrawSource for Looks {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let [seen, by_plan] = ["seen", "color"].map(|name| recorder.image(name).expect("the pass samples it"));
        assert!(seen.raw == by_plan.raw && seen.raw != vk::Image::null());
        assert_eq!((seen.layout, seen.extent), (vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL, [4, 2, 1]));
        assert_eq!(recorder.image("shown").expect("it draws it").layout, vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL);
        assert!(recorder.image("nothing").is_none() && recorder.param("nothing").is_none());
        Ok(0)
    }
}

/// Binds a group where no pipeline is bound.
struct Binds(BindGroup);

impl DrawSource for Binds {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        recorder.bind_group(1, &self.0);
        Ok(0)
    }
}

#[test]
fn a_pass_without_a_shader_sees_its_images_and_binds_no_groups() {
    let whole = Subresources::WHOLE;
    let mut small = Small::default();
    let [color, shown] = ["color", "shown"].map(|name| small.image(name, Format::R8G8B8A8_UNORM, [4, 2]));
    small.pass(draw("white", Draw::FullScreen).draws(color, whole, None));
    small.pass(draw("own", Draw::Custom).samples("seen", color, whole).draws(shown, whole, Some([0.0; 4])));
    small.image_output(shown);
    on_each_driver(|device| {
        let plan = planned(device, &small.frame, &Options::default());
        let interface = DrawInterface {
            supplied: vec![SuppliedResource::new(1, 0, "camera", SuppliedKind::UniformBlock)],
            ..DrawInterface::default()
        };
        let brought = interface.clone();
        let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, move |_| brought.clone());
        let mut executor =
            Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
        executor.frame(&mut Looks).expect("a frame");
        let camera = device.buffer(BufferUsage::Uniform, &[0; 16]).expect("a buffer");
        let group = device.bind_group(&interface, 1, &[(0, Resource::Buffer(&camera))]).expect("a group");
        let error = executor.frame(&mut Binds(group)).expect_err("there is no pipeline").to_string();
        assert_eq!(error, "pass `own`, while recording: a bind group without pipeline: there is no shader `own`");
    });
}

#[test]
fn several_materials_are_drawn_in_one_pass_by_pipelines_that_were_made_before() {
    let whole = Subresources::WHOLE;
    let mut small = Small::default();
    let image = |name, samples, format| Image { samples, ..Image::new(name, format, 4, 2) };
    let color = small.image_like(image("color", 4, Format::R16G16B16A16_SFLOAT));
    let depth = small.image_like(image("depth", 4, Format::D32_SFLOAT));
    let flat = small.image("flat", Format::R8G8B8A8_UNORM, [4, 2]);
    let shown = small.image("shown", Format::R8G8B8A8_UNORM, [4, 2]);
    let tested = DepthTarget {
        image: depth,
        range: whole,
        span: Span::NONE,
        clear: Some(0.0),
        test: CompareOp::Greater,
        write: true,
        stencil: None,
    };
    small.pass(draw("deep", Draw::Custom).tests(tested).draws(color, whole, Some([0.0; 4])));
    small.pass(draw("shallow", Draw::Custom).draws(flat, whole, Some([0.0, 0.0, 1.0, 1.0])));
    small.pass(draw("show", Draw::FullScreen).samples("seen", color, whole).draws(shown, whole, None));
    [flat, shown].into_iter().for_each(|image| small.image_output(image));
    on_each_driver(|device| {
        let plan = planned(device, &small.frame, &Options::default());
        let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
        let mut executor =
            Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
        let mut engine = Engine::new(device);
        for pass in ["deep", "shallow"] {
            let formats = executor.formats(pass).expect("it is in a scope");
            let made = engine.pipelines(&formats);
            engine.pipelines.insert(formats, made);
        }
        assert_eq!(engine.pipelines.len(), 2, "the scopes differ");
        assert_eq!(executor.formats("nobody"), None);
        executor.frame(&mut engine).expect("a frame");
        let [flat, deep] = [0, 1].map(|output| executor.read(output).expect("a picture").bytes);
        let (red, green) = ([255, 0, 0, 255], [0, 255, 0, 255]);
        assert_eq!(flat.as_chunks().0, [[green, red], [green, red]].repeat(2).concat(), "what came last is seen");
        assert_eq!(deep.as_chunks().0, [red; 8], "what is nearest is seen");
        drop(executor);
    });
}

/// A scope with local reads has colours that aren't those of each pass (DO-5): pipelines of the program's own draw into theirs alone.
#[test]
fn in_a_scope_with_local_reads_pipelines_of_the_programs_own_draw_into_their_colours_alone() {
    let whole = Subresources::WHOLE;
    let mut small = Small::default();
    let [a, b] = ["a", "b"].map(|name| small.image(name, Format::R8G8B8A8_UNORM, [4, 2]));
    small.pass(draw("white", Draw::FullScreen).draws(a, whole, None));
    let mut other =
        draw("other", Draw::Objects(DrawList::Opaque)).samples("source", a, whole).draws(b, whole, Some([0.0; 4]));
    other.sampled[0].own_pixel = true;
    small.pass(other);
    [a, b].into_iter().for_each(|image| small.image_output(image));
    on_each_driver(|device| {
        let plan = planned(device, &small.frame, &Options::default());
        let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
        let mut executor =
            Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
        let mut engine = Engine::new(device);
        let formats = executor.formats("other").expect("it is in a scope");
        let mut scopes = plan.steps.iter().filter_map(|step| step.work.scope());
        let together = scopes.any(|scope| scope.passes.len() == 2);
        assert_eq!(formats.local.is_some(), together, "{}", plan.tree());
        assert_eq!(together, device.profile().local_read, "{}", plan.tree());
        if let Some(local) = &formats.local {
            assert_eq!((formats.color.len(), &local.drawn[..]), (2, &[false, true][..]));
            assert_eq!(local.locations[1], 0, "the pass's first output is the scope's second colour");
        }
        let made = engine.pipelines(&formats);
        engine.pipelines.insert(formats, made);
        executor.frame(&mut engine).expect("a frame");
        let pictures = [0, 1].map(|output| executor.read(output).expect("a picture").bytes);
        let (red, green) = ([255, 0, 0, 255], [0, 255, 0, 255]);
        assert_eq!(pictures[0].as_chunks().0, [[255; 4]; 8]);
        assert_eq!(pictures[1].as_chunks().0, [[green, red], [green, red]].repeat(2).concat());
        drop(executor);
    });
}
