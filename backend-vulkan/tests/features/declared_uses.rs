//! Custom passes that declare what they do: their barriers are for that alone, and suffice; a wrong declaration is refuted (DO-8).

use crate::frames::{
    Custom, Small, Uses, draw, library, on_each_driver, on_each_driver_with, planned, texels, transfer, words,
};
use crate::testing::findings;
use ash::vk;
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{Profile, Queues};
use framewright_graph::frame::{DeclaredUse, Draw, Frame, Resource, Work};
use framewright_graph::plan::Queue;
use framewright_graph::vulkan::{Accesses, FillValue, Format, Layout, Sharing, Stages, State, Subresources};
use framewright_vulkan::{CustomRecorder, Device, Executor, ExecutorOptions};
use std::cell::RefCell;

const WHOLE: Subresources = Subresources::WHOLE;

const SHADERS: &[(&str, &str)] = &[(
    "next.frag",
    "#version 460
    layout(set = 0, binding = 0) uniform usampler2D source;
    layout(location = 0) out uint color;
    void main() { color = texelFetch(source, ivec2(gl_FragCoord.xy), 0).r + 1; }",
)];

const STORE: &str = "#version 460
    layout(local_size_x = 1) in;
    layout(set = 0, binding = 0, r32ui) uniform writeonly uimage2D image;
    void main() { imageStore(image, ivec2(gl_GlobalInvocationID.xy), uvec4(41)); }";

/// A compute pipeline of the program's own that writes a storage image.
struct Program<'d> {
    device: &'d Device,
    sets: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    pool: vk::DescriptorPool,
    views: RefCell<Vec<vk::ImageView>>,
}

impl Program<'_> {
    fn new(device: &Device) -> Program<'_> {
        let raw = device.raw();
        let compiler = shaderc::Compiler::new().expect("a compiler");
        let spirv = compiler.compile_into_spirv(STORE, shaderc::ShaderKind::Compute, "store", "main", None);
        let spirv = spirv.expect("it compiles");
        let kind = vk::DescriptorType::STORAGE_IMAGE;
        let bindings = [vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(kind)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::COMPUTE)];
        let sizes = [vk::DescriptorPoolSize::default().ty(kind).descriptor_count(64)];
        // SAFETY: the device lives, all that is pointed to outlives the calls, and the SPIR-V comes from the compiler.
        unsafe {
            let sets = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let sets = raw.create_descriptor_set_layout(&sets, None).expect("a layout");
            let layouts = [sets];
            let layout = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts);
            let layout = raw.create_pipeline_layout(&layout, None).expect("a layout");
            let pool = vk::DescriptorPoolCreateInfo::default().max_sets(64).pool_sizes(&sizes);
            let pool = raw.create_descriptor_pool(&pool, None).expect("a pool");
            let module = vk::ShaderModuleCreateInfo::default().code(spirv.as_binary());
            let module = raw.create_shader_module(&module, None).expect("a module");
            let stage = vk::PipelineShaderStageCreateInfo::default()
                .stage(vk::ShaderStageFlags::COMPUTE)
                .module(module)
                .name(c"main");
            let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout);
            let pipeline =
                raw.create_compute_pipelines(vk::PipelineCache::null(), &[info], None).expect("a pipeline")[0];
            raw.destroy_shader_module(module, None);
            Program { device, sets, layout, pipeline, pool, views: RefCell::default() }
        }
    }

    /// Writes 41 to all texels of `mask`, in the layout that the pass declares.
    fn store(&self, recorder: &mut CustomRecorder<'_>) {
        let image = recorder.image("mask").expect("the pass writes it");
        let (raw, commands) = (self.device.raw(), recorder.raw());
        let range = vk::ImageSubresourceRange {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            level_count: image.range.mips,
            layer_count: image.range.layers,
            ..vk::ImageSubresourceRange::default()
        };
        let view = vk::ImageViewCreateInfo::default()
            .image(image.raw)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(vk::Format::R32_UINT)
            .subresource_range(range);
        let layouts = [self.sets];
        let set = vk::DescriptorSetAllocateInfo::default().descriptor_pool(self.pool).set_layouts(&layouts);
        // SAFETY: the image is in this layout, and views and sets live as long as the program, which outlives the frames.
        unsafe {
            let view = raw.create_image_view(&view, None).expect("a view");
            self.views.borrow_mut().push(view);
            let set = raw.allocate_descriptor_sets(&set).expect("a set")[0];
            let written = [vk::DescriptorImageInfo::default().image_view(view).image_layout(image.layout)];
            let write = vk::WriteDescriptorSet::default()
                .dst_set(set)
                .descriptor_type(vk::DescriptorType::STORAGE_IMAGE)
                .image_info(&written);
            raw.update_descriptor_sets(&[write], &[]);
            let point = vk::PipelineBindPoint::COMPUTE;
            raw.cmd_bind_pipeline(commands, point, self.pipeline);
            raw.cmd_bind_descriptor_sets(commands, point, self.layout, 0, &[set], &[]);
            raw.cmd_dispatch(commands, image.extent[0], image.extent[1], 1);
        }
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        let raw = self.device.raw();
        // SAFETY: the frames were waited for.
        unsafe {
            self.views.borrow().iter().for_each(|view| raw.destroy_image_view(*view, None));
            raw.destroy_pipeline(self.pipeline, None);
            raw.destroy_pipeline_layout(self.layout, None);
            raw.destroy_descriptor_pool(self.pool, None);
            raw.destroy_descriptor_set_layout(self.sets, None);
        }
    }
}

fn state(stages: Stages, accesses: Accesses, layout: Layout) -> State {
    State { stages, accesses, layout }
}

/// A custom pass that writes `mask` as `state` says; a draw shows the next number.
fn frame(state: State) -> Frame {
    let mut small = Small::default();
    let [mask, shown] = ["mask", "shown"].map(|name| small.image(name, Format::R32_UINT, [4, 2]));
    let own = Work::Custom { callback: "own".into() };
    let mut pass = transfer("own", own, &[(Resource::Image(mask), WHOLE, true)]);
    pass.uses = vec![DeclaredUse::new(Resource::Image(mask), state)];
    small.pass(pass);
    let next = draw("next", Draw::FullScreen).samples("source", mask, WHOLE);
    small.pass(next.draws(shown, WHOLE, None));
    small.image_output(shown);
    small.frame
}

fn executor(device: &Device, frame: &Frame) -> Executor {
    let plan = planned(device, frame, &Options::default());
    Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default()).expect("an executor")
}

#[test]
fn barriers_for_what_is_declared_suffice() {
    let stored = state(Stages::COMPUTE_SHADER, Accesses::SHADER_STORAGE_WRITE, Layout::General);
    let frame = frame(stored);
    on_each_driver(|device| {
        let program = Program::new(device);
        let mut executor = executor(device, &frame);
        // Nothing waits for all commands.
        let barriers = executor.plan().steps.iter().flat_map(|step| &step.image_barriers);
        for barrier in barriers {
            assert!(!(barrier.src_stages | barrier.dst_stages).contains(Stages::ALL_COMMANDS), "{barrier:?}");
        }
        let mut record = Custom(|recorder: &mut CustomRecorder<'_>| {
            let image = recorder.image("mask").expect("the pass writes it");
            assert_eq!((image.stages, image.layout), (stored.stages, vk::ImageLayout::GENERAL));
            assert_eq!(recorder.targets().count(), 0, "nothing is written by transfer");
            program.store(recorder);
        });
        for _ in 0..3 {
            executor.frame(&mut record).expect("a frame");
            assert_eq!(texels(&mut executor, "shown", 0), [42; 8]);
        }
        drop(executor);
    });
}

#[test]
fn the_layer_refutes_a_wrong_declaration() {
    let frame = frame(state(Stages::VERTEX_SHADER, Accesses::SHADER_STORAGE_WRITE, Layout::General));
    on_each_driver_with(|device| {
        let messages = device.messages();
        {
            let program = Program::new(&device);
            let mut executor = executor(&device, &frame);
            let mut record = Custom(|recorder: &mut CustomRecorder<'_>| program.store(recorder));
            executor.frame(&mut record).expect("a frame");
            drop(executor);
        }
        let said = findings(&messages);
        assert!(said.iter().any(|it| it.id.contains("SYNC-HAZARD")), "{said:?}");

        // The debug mode leads it back to what the pass declares.
        let program = Program::new(&device);
        let plan = planned(&device, &frame, &Options { readable: true, ..Options::default() });
        let options = ExecutorOptions { check_uses: true, ..ExecutorOptions::default() };
        let mut executor = Executor::new(&device, &plan, &mut library(SHADERS), &options).expect("an executor");
        let mut record = Custom(|recorder: &mut CustomRecorder<'_>| program.store(recorder));
        let said = executor.frame(&mut record).expect_err("it is a lie").to_string();
        let declared = "pass `own` declares `mask` as VERTEX_SHADER, SHADER_STORAGE_WRITE, GENERAL, and the validation layer finds: ";
        assert!(said.starts_with(declared), "{said}");
        drop(executor);
    });
}

#[test]
fn the_recorder_refuses_what_is_not_declared() {
    let cleared = frame(state(Stages::CLEAR, Accesses::TRANSFER_WRITE, Layout::TransferDstOptimal));
    let stored = frame(state(Stages::COMPUTE_SHADER, Accesses::SHADER_STORAGE_WRITE, Layout::General));
    let copied = frame(state(Stages::COPY, Accesses::TRANSFER_WRITE, Layout::TransferDstOptimal));
    on_each_driver(|device| {
        let fill = |frame: &Frame| {
            let mut record =
                Custom(|recorder: &mut CustomRecorder<'_>| recorder.fill("mask", FillValue::Bits([6, 0, 0, 0])));
            let mut executor = executor(device, frame);
            let drawn = executor.frame(&mut record).map(|_| ()).map_err(|error| error.to_string());
            drawn.map(|()| texels(&mut executor, "shown", 0))
        };
        assert_eq!(fill(&cleared), Ok(vec![7; 8]));
        let said = fill(&stored).expect_err("it isn't transferred");
        assert!(said.contains("the pass writes no `mask` by transfer"), "{said}");
        let said = fill(&copied).expect_err("it isn't cleared");
        assert!(said.contains("the pass declares to use `mask` in COPY, and writes it in CLEAR"), "{said}");
    });
}

#[test]
fn a_pass_that_any_queue_may_run_is_told_its_queue() {
    let mut small = Small::default();
    let [seed, list, own] = ["seed", "list", "own"].map(|name| small.buffer(name, 3));
    let [large, shown] = ["large", "shown"].map(|name| small.image(name, Format::R32_UINT, [64, 64]));
    let [from, to, last] = [seed, list, own].map(Resource::Buffer);
    let four = FillValue::Bits([4, 0, 0, 0]);
    small.pass(transfer("first", Work::Fill { value: four }, &[(from, WHOLE, true)]));
    let custom = Work::Custom { callback: "own".into() };
    let mut pass = transfer("copy", custom, &[(from, WHOLE, false), (to, WHOLE, true)]);
    let declared = |resource, accesses| DeclaredUse::new(resource, state(Stages::COPY, accesses, Layout::Undefined));
    pass.uses = vec![declared(from, Accesses::TRANSFER_READ), declared(to, Accesses::TRANSFER_WRITE)];
    pass.any_queue = true;
    small.pass(pass);
    small.pass(draw("number", Draw::FullScreen).draws(large, WHOLE, None));
    small.pass(draw("next", Draw::FullScreen).samples("source", large, WHOLE).draws(shown, WHOLE, None));
    small.pass(transfer("take", Work::Copy, &[(to, WHOLE, false), (last, WHOLE, true)]));
    small.image_output(shown);
    small.buffer_output(own);
    on_each_driver(|device| {
        let queues = Queues { compute: true, transfer: false, sharing: Sharing::Concurrent, wait_bytes: 0 };
        let profile = Profile { queues, ..device.profile() };
        let plan = compile(&small.frame, &profile, &mut device.memory(), &Options::default());
        let plan = plan.unwrap_or_else(|errors| panic!("{errors:?}"));
        let mut executor =
            Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default()).expect("an executor");
        let mut told = Vec::new();
        for _ in 0..3 {
            let mut record = Custom(|recorder: &mut CustomRecorder<'_>| {
                told.push((recorder.queue(), recorder.queue_family()));
                recorder.copy("seed", "list");
            });
            executor.frame(&mut record).expect("a frame");
            assert_eq!(words(&mut executor, "own"), [4; 3]);
        }
        // Software drivers have one queue family, which is for both.
        assert!(told.iter().all(|(queue, _)| *queue == Queue::Compute), "{told:?}\n{}", plan.tree());
        assert!(told.iter().all(|(_, family)| *family == told[0].1), "{told:?}");
    });
}
