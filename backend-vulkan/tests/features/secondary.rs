//! Custom passes whose commands come in secondary command buffers, which threads of the program record (DO-8).

use crate::frames::{Custom, Small, Uses, draw, library, on_each_driver, planned, texels, transfer, words};
use crate::testing::{OVER_ALL, WHITE};
use ash::vk;
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Frame, Resource, Work};
use framewright_graph::plan;
use framewright_graph::vulkan::{FillValue, Format, Subresources};
use framewright_vulkan::{
    CustomRecorder, Device, DrawSource, Error, Executor, ExecutorOptions, Recorder, ScopeFormats, SecondaryRecorder,
};
use std::thread;

const WHOLE: Subresources = Subresources::WHOLE;

const SHADERS: &[(&str, &str)] = &[
    (
        "number.frag",
        "#version 460
        layout(location = 0) out vec4 color;
        void main() { color = vec4(gl_FragCoord.xy / 16.0, 0.0, 1.0); }",
    ),
    (
        "last.frag",
        "#version 460
        layout(location = 0) out vec4 color;
        void main() {
            if (any(greaterThan(gl_FragCoord.xy, vec2(1.0)))) { discard; }
            color = vec4(0.0, 0.0, 1.0, 1.0);
        }",
    ),
    (
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D source;
        layout(location = 0) out vec4 color;
        void main() { color = texelFetch(source, ivec2(gl_FragCoord.xy), 0); }",
    ),
    (
        "here.frag",
        "#version 460
        #ifdef LOCAL_READ_source
        layout(input_attachment_index = 0, set = 0, binding = 0) uniform subpassInput source;
        #define HERE subpassLoad(source)
        #else
        layout(set = 0, binding = 0) uniform sampler2D source;
        #define HERE texelFetch(source, ivec2(gl_FragCoord.xy), 0)
        #endif
        layout(location = 0) out vec4 color;
        void main() { color = HERE; }",
    ),
];

/// How many threads of the program record.
const THREADS: u32 = 4;
const SIZE: [u32; 2] = [8, 4];

/// Command pools, one for each thread, with a secondary command buffer each, and a pipeline that draws white.
struct Program<'d> {
    device: &'d Device,
    buffers: Vec<(vk::CommandPool, vk::CommandBuffer)>,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    /// What the scope's secondary command buffers are begun with, told before the frame.
    formats: ScopeFormats,
    way: Way,
}

/// How the program records its draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// Into the frame's own command buffer.
    Inline,
    /// On threads, anew in each frame.
    EachFrame,
    /// On threads, once before the first frame.
    Before,
}

impl Program<'_> {
    fn new<'d>(device: &'d Device, formats: ScopeFormats, samples: vk::SampleCountFlags, way: Way) -> Program<'d> {
        let (raw, family) = (device.raw(), device.graphics_queue_family());
        let flags = vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER;
        let buffers = (0..THREADS).map(|_| {
            let pool = vk::CommandPoolCreateInfo::default().queue_family_index(family).flags(flags);
            // SAFETY: the device lives, and the pool is new.
            unsafe {
                let pool = raw.create_command_pool(&pool, None).expect("a pool");
                let info = vk::CommandBufferAllocateInfo::default()
                    .command_pool(pool)
                    .level(vk::CommandBufferLevel::SECONDARY)
                    .command_buffer_count(1);
                (pool, raw.allocate_command_buffers(&info).expect("a command buffer")[0])
            }
        });
        let buffers = buffers.collect();
        // SAFETY: the device lives.
        let layout = unsafe { raw.create_pipeline_layout(&vk::PipelineLayoutCreateInfo::default(), None) };
        let layout = layout.expect("a layout");
        let pipeline = white(device, layout, &formats, samples);
        let program = Program { device, buffers, layout, pipeline, formats, way };
        if way == Way::Before {
            program.record_on_threads();
        }
        program
    }

    /// Each thread draws two columns of the right half: white in the uppermost row, and red by a clear below it.
    fn record_on_threads(&self) {
        thread::scope(|scope| {
            for (number, (_, commands)) in (0..).zip(&self.buffers) {
                scope.spawn(move || self.record(*commands, number));
            }
        });
    }

    fn record(&self, commands: vk::CommandBuffer, number: i32) {
        let raw = self.device.raw();
        let mut scope = self.formats.inheritance();
        let inherited = vk::CommandBufferInheritanceInfo::default().push_next(&mut scope);
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::RENDER_PASS_CONTINUE)
            .inheritance_info(&inherited);
        // SAFETY: this thread alone uses the pool, and the scope is of these formats.
        unsafe {
            raw.begin_command_buffer(commands, &begin).expect("begun");
            self.draw(commands, number);
            raw.end_command_buffer(commands).expect("ended");
        }
    }

    /// # Safety
    /// The command buffer is being recorded within the scope, or for it.
    unsafe fn draw(&self, commands: vk::CommandBuffer, number: i32) {
        let raw = self.device.raw();
        let column = |y, height| vk::Rect2D {
            offset: vk::Offset2D { x: 4 + number, y },
            extent: vk::Extent2D { width: 1, height },
        };
        let red = vk::ClearValue { color: vk::ClearColorValue { float32: [1.0, 0.0, 0.0, 1.0] } };
        let red =
            [vk::ClearAttachment { aspect_mask: vk::ImageAspectFlags::COLOR, color_attachment: 0, clear_value: red }];
        let below = [vk::ClearRect { rect: column(1, 3), base_array_layer: 0, layer_count: 1 }];
        let viewport = [vk::Viewport { width: 8.0, height: 4.0, max_depth: 1.0, ..vk::Viewport::default() }];
        // SAFETY: the caller's word.
        unsafe {
            raw.cmd_clear_attachments(commands, &red, &below);
            raw.cmd_bind_pipeline(commands, vk::PipelineBindPoint::GRAPHICS, self.pipeline);
            raw.cmd_set_viewport(commands, 0, &viewport);
            raw.cmd_set_scissor(commands, 0, &[column(0, 1)]);
            raw.cmd_draw(commands, 3, 1, 0, 0);
        }
    }
}

/// A pipeline that draws white over everything.
fn white(
    device: &Device,
    layout: vk::PipelineLayout,
    formats: &ScopeFormats,
    samples: vk::SampleCountFlags,
) -> vk::Pipeline {
    let raw = device.raw();
    let compiler = shaderc::Compiler::new().expect("a compiler");
    let stage = |kind, stage, text| {
        let spirv = compiler.compile_into_spirv(text, kind, "shader", "main", None).expect("it compiles");
        let info = vk::ShaderModuleCreateInfo::default().code(spirv.as_binary());
        // SAFETY: the device lives, and the SPIR-V comes from the compiler.
        let module = unsafe { raw.create_shader_module(&info, None) }.expect("a module");
        vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main")
    };
    let stages = [
        stage(shaderc::ShaderKind::Vertex, vk::ShaderStageFlags::VERTEX, OVER_ALL),
        stage(shaderc::ShaderKind::Fragment, vk::ShaderStageFlags::FRAGMENT, WHITE),
    ];
    let input = vk::PipelineVertexInputStateCreateInfo::default();
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let multisample = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(samples);
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
        .multisample_state(&multisample)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut rendering);
    // SAFETY: all that `info` points to outlives the call, and the modules are used for it alone.
    unsafe {
        let made = raw.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None).expect("a pipeline")[0];
        stages.iter().for_each(|stage| raw.destroy_shader_module(stage.module, None));
        made
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        let raw = self.device.raw();
        // SAFETY: the frames were waited for.
        unsafe {
            self.buffers.iter().for_each(|(pool, _)| raw.destroy_command_pool(*pool, None));
            raw.destroy_pipeline(self.pipeline, None);
            raw.destroy_pipeline_layout(self.layout, None);
        }
    }
}

impl DrawSource for Program<'_> {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        assert_eq!(self.way, Way::Inline);
        let commands = recorder.raw();
        // SAFETY: the command buffer is being recorded within the scope.
        (0..4).for_each(|number| unsafe { self.draw(commands, number) });
        Ok(2 * THREADS)
    }

    fn has_secondary(&mut self, callback: &str) -> bool {
        self.way != Way::Inline && callback == "own"
    }

    fn secondary(&mut self, callback: &str, recorder: &mut SecondaryRecorder<'_>) -> Result<u32, Error> {
        assert_eq!((callback, recorder.pass(), recorder.target_extent()), ("own", "own", SIZE));
        assert_eq!(recorder.queue_family(), self.device.graphics_queue_family());
        assert_eq!(*recorder.formats(), self.formats);
        if self.way == Way::EachFrame {
            self.record_on_threads();
        }
        let buffers: Vec<_> = self.buffers.iter().map(|(_, buffer)| *buffer).collect();
        // SAFETY: they were recorded for this scope, and live as long as the program, which waits for the frames.
        unsafe { recorder.execute(&buffers) };
        Ok(2 * THREADS)
    }
}

/// A scope of three passes, of which the second is the program's.
fn frame(samples: u32) -> Frame {
    let mut small = Small::default();
    let [width, height] = SIZE;
    let drawn = framewright_graph::frame::Image {
        samples,
        ..framewright_graph::frame::Image::new("drawn", Format::R8G8B8A8_UNORM, width, height)
    };
    let (drawn, shown) = (small.image_like(drawn), small.image("shown", Format::R8G8B8A8_UNORM, SIZE));
    let target = if samples > 1 { drawn } else { shown };
    small.pass(draw("number", Draw::FullScreen).draws(target, WHOLE, None));
    small.pass(draw("own", Draw::Custom).draws(target, WHOLE, None));
    let mut last = draw("last", Draw::FullScreen);
    last.work = Work::Draw { draw: Draw::FullScreen, shader: "last".into(), discards: true, per_sample: false };
    small.pass(last.draws(target, WHOLE, None));
    if samples > 1 {
        small.pass(draw("show", Draw::FullScreen).samples("source", drawn, WHOLE).draws(shown, WHOLE, None));
    }
    small.image_output(shown);
    small.frame
}

/// The texel of a place of the picture.
fn expected([x, y]: [u32; 2]) -> [u8; 4] {
    let part = |at: u32| u8::try_from((f64::from(2 * at + 1) * 255.0 / 32.0).round() as u32).expect("a byte");
    match (x, y) {
        (0, 0) => [0, 0, 255, 255],
        (4.., 0) => [255; 4],
        (4.., _) => [255, 0, 0, 255],
        _ => [part(x), part(y), 0, 255],
    }
}

#[test]
fn do_8_threads_draw_within_a_scope_that_other_passes_share() {
    on_each_driver(|device| {
        for samples in [1, 4] {
            let [inline, each, before] =
                [Way::Inline, Way::EachFrame, Way::Before].map(|way| shown(device, samples, way));
            assert!(inline == each && inline == before, "{samples}: {inline:?}, {each:?}, {before:?}");
            for (number, texel) in (0..).zip(each).filter(|_| samples == 1) {
                let at = [number % SIZE[0], number / SIZE[0]];
                let (texel, wanted) = (texel.to_ne_bytes(), expected(at));
                let near = texel.into_iter().zip(wanted).all(|(a, b)| a.abs_diff(b) <= 1);
                assert!(near, "{at:?}: {texel:?}, {wanted:?}");
            }
        }
    });
}

/// The picture that each of two frames shows.
fn shown(device: &Device, samples: u32, way: Way) -> Vec<u32> {
    let plan = planned(device, &frame(samples), &Options::default());
    let scopes: Vec<_> = plan.steps.iter().filter_map(|step| step.work.scope()).map(|it| it.passes.len()).collect();
    assert_eq!(scopes[0], 3, "{}", plan.tree());
    let options = ExecutorOptions { timestamps: true, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &plan, &mut library(SHADERS), &options).expect("an executor");
    let formats = executor.formats("own").expect("it draws");
    let mut program = Program::new(device, formats, vk::SampleCountFlags::from_raw(samples), way);
    let pictures = [(); 2].map(|()| {
        let drawn = executor.frame(&mut program).expect("a frame");
        let report = executor.report(drawn).expect("a report");
        let draws: Vec<_> = report.steps[0].passes.iter().map(|pass| pass.draws).collect();
        assert_eq!(draws, [1, 2 * THREADS, 1]);
        texels(&mut executor, "shown", 0)
    });
    drop(executor);
    let [first, second] = pictures;
    assert_eq!(first, second);
    first
}

#[test]
fn do_8_threads_record_outside_of_scopes() {
    let mut small = Small::default();
    let list = small.buffer("list", THREADS.into());
    let own = Work::Custom { callback: "own".into() };
    small.pass(transfer("own", own, &[(Resource::Buffer(list), WHOLE, true)]));
    small.buffer_output(list);
    on_each_driver(|device| {
        let plan = planned(device, &small.frame, &Options::default());
        let mut executor =
            Executor::new(device, &plan, &mut library(&[]), &ExecutorOptions::default()).expect("an executor");
        let (raw, family) = (device.raw(), device.graphics_queue_family());
        let pools: Vec<_> = (0..THREADS)
            .map(|_| {
                let pool = vk::CommandPoolCreateInfo::default().queue_family_index(family);
                // SAFETY: the device lives.
                unsafe { raw.create_command_pool(&pool, None) }.expect("a pool")
            })
            .collect();
        let mut record = Custom(|recorder: &mut CustomRecorder<'_>| {
            let buffer = recorder.buffer("list").expect("the pass writes it");
            let one = |number: u32, pool: vk::CommandPool| {
                let info = vk::CommandBufferAllocateInfo::default()
                    .command_pool(pool)
                    .level(vk::CommandBufferLevel::SECONDARY)
                    .command_buffer_count(1);
                let inherited = vk::CommandBufferInheritanceInfo::default();
                let begin = vk::CommandBufferBeginInfo::default().inheritance_info(&inherited);
                // SAFETY: this thread alone uses the pool, and the buffer holds as many words.
                unsafe {
                    let commands = raw.allocate_command_buffers(&info).expect("a command buffer")[0];
                    raw.begin_command_buffer(commands, &begin).expect("begun");
                    raw.cmd_fill_buffer(commands, buffer, 4 * u64::from(number), 4, number + 7);
                    raw.end_command_buffer(commands).expect("ended");
                    commands
                }
            };
            let recorded: Vec<_> = thread::scope(|scope| {
                let started: Vec<_> =
                    (0..).zip(&pools).map(|(number, pool)| scope.spawn(move || one(number, *pool))).collect();
                started.into_iter().map(|it| it.join().expect("recorded")).collect()
            });
            // SAFETY: they fill what the pass names, and their pools live until the frame was waited for.
            unsafe { recorder.execute(&recorded) };
        });
        for _ in 0..2 {
            executor.frame(&mut record).expect("a frame");
            assert_eq!(words(&mut executor, "list"), [7, 8, 9, 10]);
        }
        // SAFETY: the frames were waited for.
        pools.iter().for_each(|pool| unsafe { raw.destroy_command_pool(*pool, None) });
        drop(executor);
    });
}

/// Says in turn whether it has secondary command buffers of a pass, and doesn't know them.
struct Forgetful {
    says: Vec<bool>,
}

impl DrawSource for Forgetful {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, Error> {
        Ok(0)
    }

    fn has_secondary(&mut self, callback: &str) -> bool {
        assert_eq!(callback, "own");
        self.says.pop().expect("it isn't asked again")
    }
}

const NOBODY: &str = "nobody has secondary command buffers of `own`, which the custom pass `own` asks for";
const COUNTED: &str = "pass `own`, while recording: secondary command buffers while fragments are counted, which \
                       they would have to inherit";

/// Whether the device counts fragments.
fn counts(device: &Device) -> bool {
    let (instance, physical) = device.raw_physical();
    // SAFETY: the physical device is the instance's.
    unsafe { instance.get_physical_device_features(physical) }.pipeline_statistics_query == vk::TRUE
}

#[test]
fn secondary_command_buffers_that_cannot_be_are_errors() {
    on_each_driver(|device| {
        let plan = planned(device, &frame(1), &Options::default());
        let said = |fragment_counts, says: &[bool]| {
            let options = ExecutorOptions { fragment_counts, ..ExecutorOptions::default() };
            let mut executor = Executor::new(device, &plan, &mut library(SHADERS), &options).expect("an executor");
            let drawn = executor.frame(&mut Forgetful { says: says.to_vec() });
            drawn.expect_err("it has none").to_string()
        };
        assert_eq!(said(false, &[true]), NOBODY);
        assert_eq!(said(true, &[true]), if counts(device) { COUNTED } else { NOBODY });
        // What it said when the scope began holds, also where it would say another thing later.
        assert_eq!(said(false, &[false, true]), NOBODY);
        let panicked = "pass `own`, while recording: the program panicked: it isn't asked again";
        assert_eq!(said(false, &[]), panicked);
    });
}

#[test]
fn secondary_command_buffers_outside_of_scopes_need_that_no_fragments_are_counted() {
    let mut small = Small::default();
    let list = small.buffer("list", THREADS.into());
    let own = Work::Custom { callback: "own".into() };
    small.pass(transfer("own", own, &[(Resource::Buffer(list), WHOLE, true)]));
    small.buffer_output(list);
    on_each_driver(|device| {
        let plan = planned(device, &small.frame, &Options::default());
        let options = ExecutorOptions { fragment_counts: true, ..ExecutorOptions::default() };
        let mut executor = Executor::new(device, &plan, &mut library(&[]), &options).expect("an executor");
        let pool = vk::CommandPoolCreateInfo::default().queue_family_index(device.graphics_queue_family());
        let raw = device.raw();
        // SAFETY: the device lives, and the pool is new; the command buffer holds nothing.
        let (pool, empty) = unsafe {
            let pool = raw.create_command_pool(&pool, None).expect("a pool");
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .level(vk::CommandBufferLevel::SECONDARY)
                .command_buffer_count(1);
            let empty = raw.allocate_command_buffers(&info).expect("a command buffer")[0];
            let inherited = vk::CommandBufferInheritanceInfo::default();
            let begin = vk::CommandBufferBeginInfo::default()
                .flags(vk::CommandBufferUsageFlags::SIMULTANEOUS_USE)
                .inheritance_info(&inherited);
            raw.begin_command_buffer(empty, &begin).expect("begun");
            raw.end_command_buffer(empty).expect("ended");
            (pool, empty)
        };
        let mut record = Custom(|recorder: &mut CustomRecorder<'_>| {
            recorder.fill("list", FillValue::Bits([4, 0, 0, 0]));
            // SAFETY: it was recorded for the family, touches nothing, and lives until the frame was waited for.
            unsafe { recorder.execute(&[empty]) };
        });
        let drawn = executor.frame(&mut record).map(drop).map_err(|error| error.to_string());
        assert_eq!(drawn, if counts(device) { Err(COUNTED.to_owned()) } else { Ok(()) });
        drop(executor);
        // SAFETY: the frame was waited for, or never submitted.
        unsafe { raw.destroy_command_pool(pool, None) };
    });
}

/// A scope whose passes read what it drew can't be suspended: how passes see its attachments would be lost. The compiler makes none with a
/// custom pass, and a Plan by hand may.
#[test]
fn secondary_command_buffers_beside_local_reads_are_errors() {
    let mut small = Small::default();
    let [drawn, shown] = ["drawn", "shown"].map(|name| small.image(name, Format::R8G8B8A8_UNORM, SIZE));
    small.pass(draw("number", Draw::FullScreen).draws(drawn, WHOLE, None));
    let mut own = draw("own", Draw::FullScreen);
    own.work = Work::Draw { draw: Draw::FullScreen, shader: "own".into(), discards: true, per_sample: false };
    small.pass(own.draws(drawn, WHOLE, None));
    let mut read = draw("here", Draw::FullScreen).samples("source", drawn, WHOLE).draws(shown, WHOLE, None);
    read.sampled[0].own_pixel = true;
    small.pass(read);
    small.image_output(shown);
    on_each_driver(|device| {
        let mut plan = planned(device, &small.frame, &Options::default());
        if !device.profile().local_read {
            return eprintln!("SKIPPED: {} has no local reads", device.summary().name);
        }
        let plan::Work::Render(scope) = &mut plan.steps[0].work else { panic!("it draws") };
        assert_eq!(scope.passes.len(), 3);
        scope.passes[1].draw = Some(Draw::Custom);
        let mut executor =
            Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default()).expect("an executor");
        let drawn = executor.frame(&mut Forgetful { says: vec![true; 2] }).expect_err("it can't be").to_string();
        let wanted = "pass `own`, while recording: secondary command buffers in a scope whose passes read what it drew, or \
                      draw into others of its attachments";
        assert_eq!(drawn, wanted);
    });
}
