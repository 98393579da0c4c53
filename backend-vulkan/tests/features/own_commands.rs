//! Custom passes that read what the frame wrote by commands of the program's own: indirect, as vertices, as indices.

use crate::frames::{Custom, Small, Uses, dispatch, draw, on_each_driver, planned, texels, transfer, words};
use ash::vk;
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Frame, Groups, Resource, Work};
use framewright_graph::shader::DrawInterface;
use framewright_graph::vulkan::{FillValue, Format, Subresources};
use framewright_vulkan::{
    CustomRecorder, Device, DrawSource, Error, Executor, ExecutorOptions, Recorder, ScopeFormats, ShaderLibrary,
};

const WHOLE: Subresources = Subresources::WHOLE;

/// One indexed draw of a triangle over all of the picture, with its vertices and indices.
const SHADERS: &[(&str, &str)] = &[(
    "make.comp",
    "#version 460
    layout(local_size_x = 1) in;
    layout(set = 0, binding = 0) writeonly buffer Counts { uint counts[]; };
    layout(set = 0, binding = 1) writeonly buffer Places { vec2 places[]; };
    layout(set = 0, binding = 2) writeonly buffer Indices { uint indices[]; };
    void main() {
        for (uint i = 0; i < 3; ++i) {
            places[i] = vec2(i & 1, i >> 1) * 4.0 - 1.0;
            indices[i] = i;
            counts[i] = i < 1 ? 3 : i == 1 ? 1 : 0;
        }
        counts[3] = 0;
        counts[4] = 0;
    }",
)];

const VERTEX: &str = "#version 460
    layout(location = 0) in vec2 place;
    void main() { gl_Position = vec4(place, 0.0, 1.0); }";
const NUMBER: &str = "#version 460
    layout(location = 0) out uint color;
    void main() { color = 7; }";
const NOTHING: &str = "#version 460
    layout(local_size_x = 1) in;
    void main() {}";

/// The pipelines of the program, which has none of the pipeline file's.
struct Program<'d> {
    device: &'d Device,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
}

impl Program<'_> {
    fn module(device: &Device, kind: shaderc::ShaderKind, text: &str) -> vk::ShaderModule {
        let compiler = shaderc::Compiler::new().expect("a compiler");
        let spirv = compiler.compile_into_spirv(text, kind, "shader", "main", None).expect("it compiles");
        let info = vk::ShaderModuleCreateInfo::default().code(spirv.as_binary());
        // SAFETY: the device lives, and the SPIR-V comes from the compiler.
        unsafe { device.raw().create_shader_module(&info, None) }.expect("a module")
    }

    fn layout(device: &Device) -> vk::PipelineLayout {
        // SAFETY: the device lives.
        unsafe { device.raw().create_pipeline_layout(&vk::PipelineLayoutCreateInfo::default(), None) }
            .expect("a layout")
    }

    fn dispatching(device: &Device) -> Program<'_> {
        let (raw, layout) = (device.raw(), Program::layout(device));
        let module = Program::module(device, shaderc::ShaderKind::Compute, NOTHING);
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(c"main");
        let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout);
        // SAFETY: all that `info` points to outlives the call, and the module is used for it alone.
        let pipeline = unsafe {
            let made = raw.create_compute_pipelines(vk::PipelineCache::null(), &[info], None).expect("a pipeline")[0];
            raw.destroy_shader_module(module, None);
            made
        };
        Program { device, layout, pipeline }
    }

    fn drawing<'d>(device: &'d Device, formats: &ScopeFormats) -> Program<'d> {
        let (raw, layout) = (device.raw(), Program::layout(device));
        let modules = [(shaderc::ShaderKind::Vertex, VERTEX), (shaderc::ShaderKind::Fragment, NUMBER)];
        let modules = modules.map(|(kind, text)| Program::module(device, kind, text));
        let stages = [(vk::ShaderStageFlags::VERTEX, modules[0]), (vk::ShaderStageFlags::FRAGMENT, modules[1])];
        let stages = stages.map(|(stage, module)| {
            vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main")
        });
        let bindings = [vk::VertexInputBindingDescription::default().stride(8)];
        let attributes = [vk::VertexInputAttributeDescription::default().format(vk::Format::R32G32_SFLOAT)];
        let input = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&bindings)
            .vertex_attribute_descriptions(&attributes);
        let assembly =
            vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let samples =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let blends = [vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA)];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
        let mut rendering = vk::PipelineRenderingCreateInfo::default().color_attachment_formats(&formats.color);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout)
            .push_next(&mut rendering);
        // SAFETY: all that `info` points to outlives the call, and the modules are used for it alone.
        let pipeline = unsafe {
            let made = raw.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None).expect("a pipeline")[0];
            modules.iter().for_each(|module| raw.destroy_shader_module(*module, None));
            made
        };
        Program { device, layout, pipeline }
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        // SAFETY: the frames were waited for.
        unsafe {
            self.device.raw().destroy_pipeline(self.pipeline, None);
            self.device.raw().destroy_pipeline_layout(self.layout, None);
        }
    }
}

impl DrawSource for Program<'_> {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let [counts, places, indices] =
            ["counts", "places", "Indices"].map(|name| recorder.buffer(name).expect("the pass reads it"));
        assert!(recorder.buffer("nothing").is_none());
        let (commands, raw) = (recorder.raw(), self.device.raw());
        // SAFETY: within the scope, whose formats the pipeline fits; the buffers hold what the compute pass writes.
        unsafe {
            raw.cmd_bind_pipeline(commands, vk::PipelineBindPoint::GRAPHICS, self.pipeline);
            raw.cmd_bind_vertex_buffers(commands, 0, &[places], &[0]);
            raw.cmd_bind_index_buffer(commands, indices, 0, vk::IndexType::UINT32);
            raw.cmd_draw_indexed_indirect(commands, counts, 0, 1, 20);
        }
        Ok(1)
    }
}

fn executor(device: &Device, frame: &Frame) -> Executor {
    let plan = planned(device, frame, &Options::default());
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor")
}

#[test]
fn what_a_compute_pass_wrote_is_drawn_indirectly_by_a_program() {
    let mut small = Small::default();
    let [counts, places, indices] =
        [("counts", 5), ("places", 6), ("indices", 3)].map(|(name, words)| small.buffer(name, words));
    let shown = small.image("shown", Format::R32_UINT, [4, 2]);
    let written = (false, true);
    let make = dispatch("make", Groups::Count([1, 1, 1])).block("Counts", counts, written);
    small.pass(make.block("Places", places, written).block("Indices", indices, written));
    let read = (true, false);
    let own = draw("own", Draw::Custom).block("Counts", counts, read).block("Places", places, read);
    small.pass(own.block("Indices", indices, read).draws(shown, WHOLE, Some([0.0; 4])));
    small.image_output(shown);
    on_each_driver(|device| {
        let mut executor = executor(device, &small.frame);
        let mut program = Program::drawing(device, &executor.formats("own").expect("it draws"));
        for _ in 0..2 {
            executor.frame(&mut program).expect("a frame");
            assert_eq!(texels(&mut executor, "shown", 0), [7; 8]);
        }
        drop(executor);
    });
}

#[test]
fn what_a_fill_wrote_is_dispatched_indirectly_by_a_program() {
    let mut small = Small::default();
    let [counts, words_] = ["counts", "words"].map(|name| small.buffer(name, 3));
    let (from, to) = (Resource::Buffer(counts), Resource::Buffer(words_));
    let one = FillValue::Bits([1, 0, 0, 0]);
    small.pass(transfer("ones", Work::Fill { value: one }, &[(from, WHOLE, true)]));
    let custom = Work::Custom { callback: "own".into() };
    small.pass(transfer("own", custom, &[(from, WHOLE, false), (to, WHOLE, true)]));
    small.buffer_output(words_);
    on_each_driver(|device| {
        let mut executor = executor(device, &small.frame);
        let program = Program::dispatching(device);
        let mut record = Custom(|recorder: &mut CustomRecorder<'_>| {
            recorder.fill("words", FillValue::Bits([5, 0, 0, 0]));
            let counts = recorder.buffer("counts").expect("the pass reads it");
            let (commands, raw) = (recorder.raw(), device.raw());
            // SAFETY: outside of scopes; the buffer holds the counts of a dispatch.
            unsafe {
                raw.cmd_bind_pipeline(commands, vk::PipelineBindPoint::COMPUTE, program.pipeline);
                raw.cmd_dispatch_indirect(commands, counts, 0);
            }
        });
        for _ in 0..2 {
            executor.frame(&mut record).expect("a frame");
            assert_eq!(words(&mut executor, "words"), [5; 3]);
        }
        drop(executor);
    });
}
