//! The yardstick: a Plan's frame as an expert writes it by hand, in raw Vulkan.
//!
//! It does the same work on the device as the executor: images at the same places of memory, the same barriers in as many calls,
//! the same attachments, pipelines and descriptors, one submission that signals a timeline. All that doesn't change from frame to
//! frame is prepared before: recording walks a list, and records no state that is set already. What this framework must be able
//! to do and this frame doesn't need is left out: faces are culled by the pipeline, and nothing is timed, labelled or checked.

#[path = "../../../src/base/convert.rs"]
#[allow(dead_code, reason = "it serves the whole crate")]
mod convert;
mod memory;
mod objects;
mod passes;

use crate::workload::{MATERIAL_SET, Workload};
use ash::vk;
use framewright_graph::plan::{ImageBarrier, MemoryBarrier, Plan, Resource, Role, Work};
use framewright_graph::vulkan::{Layout, Stages, Subresources};
use framewright_vulkan::Device;
use memory::Images;
use objects::ObjectBuffers;
use passes::{PassMaker, shader_modules};

/// A frame that is recorded by hand.
pub(crate) struct ByHand {
    device: Device,
    queue: vk::Queue,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    timeline: vk::Semaphore,
    submitted: u64,
    /// What the program that reads the output does before the next frame.
    output_read: vk::MemoryBarrier2<'static>,
    steps: Vec<Step>,
    objects: Option<ObjectBuffers>,
    images: Images,
    output: (usize, vk::ImageLayout),
    /// Everything else that was made.
    made: Made,
}

/// A step's commands.
struct Step {
    memory: Vec<vk::MemoryBarrier2<'static>>,
    images: Vec<vk::ImageMemoryBarrier2<'static>>,
    work: StepWork,
}

enum StepWork {
    Render {
        color: Vec<vk::RenderingAttachmentInfo<'static>>,
        depth: Option<vk::RenderingAttachmentInfo<'static>>,
        area: vk::Rect2D,
        /// Whether the scope before has drawn into another size.
        new_size: bool,
        passes: Vec<Pass>,
    },
    Dispatch(Pass, [u32; 3]),
    Nothing,
}

/// The bindings of a pass.
struct Pass {
    /// `None`: it is bound already.
    pipeline: Option<vk::Pipeline>,
    layout: vk::PipelineLayout,
    /// `None`: the shader reads nothing of the pass's own.
    set: Option<vk::DescriptorSet>,
    draws_objects: bool,
}

/// Vulkan's objects that only have to be destroyed.
#[derive(Default)]
struct Made {
    pipelines: Vec<vk::Pipeline>,
    layouts: Vec<vk::PipelineLayout>,
    set_layouts: Vec<vk::DescriptorSetLayout>,
    modules: Vec<vk::ShaderModule>,
    samplers: Vec<vk::Sampler>,
    pools: Vec<vk::DescriptorPool>,
}

impl ByHand {
    pub(crate) fn new(device: &Device, workload: &Workload, plan: &Plan) -> ByHand {
        let raw = device.raw();
        let (instance, physical) = device.raw_physical();
        // SAFETY: the physical device is the instance's.
        let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
        let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        let family = families.iter().position(|it| it.queue_flags.contains(wanted)).expect("a graphics queue") as u32;
        let images = Images::new(device, plan);
        let mut made = Made::default();
        let objects = workload.objects.as_ref().map(|objects| ObjectBuffers::new(device, objects, &mut made));
        let steps = steps(device, workload, plan, &images, objects.as_ref(), &mut made);
        let Resource::Image(output) = plan.outputs[0].resource else { panic!("the output is an image") };
        let Role::External { before, after, .. } = &plan.image(output).role else { panic!("the output is external") };
        assert_eq!(before.layout, Layout::Undefined, "each frame draws the output anew");
        let next = if before.stages.is_empty() { Stages::ALL_COMMANDS } else { before.stages };
        let output_read = vk::MemoryBarrier2::default()
            .src_stage_mask(convert::stages(after.stages))
            .src_access_mask(convert::accesses(after.accesses))
            .dst_stage_mask(convert::stages(next))
            .dst_access_mask(convert::accesses(before.accesses));
        let mut ty = vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
        // SAFETY: the device has a queue of this family, which the executor uses on this thread alone; it lives as long as this.
        let (queue, pool, commands, timeline) = unsafe {
            let info = vk::CommandPoolCreateInfo::default().queue_family_index(family);
            let pool = raw.create_command_pool(&info, None).expect("a pool");
            let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
            let commands = raw.allocate_command_buffers(&info).expect("a command buffer")[0];
            let info = vk::SemaphoreCreateInfo::default().push_next(&mut ty);
            (raw.get_device_queue(family, 0), pool, commands, raw.create_semaphore(&info, None).expect("a semaphore"))
        };
        let output = (output.0 as usize, convert::layout(after.layout));
        let mut by_hand = ByHand {
            device: device.clone(),
            queue,
            pool,
            commands,
            timeline,
            submitted: 0,
            output_read,
            steps,
            objects,
            images,
            output,
            made,
        };
        by_hand.bring_into_first_layouts(plan);
        by_hand
    }

    /// Images that outlive frames are in the layouts that the first frame finds.
    fn bring_into_first_layouts(&mut self, plan: &Plan) {
        let barriers = plan.images.iter().zip(&self.images.raw).filter_map(|(image, raw)| {
            let (Role::Persistent { before, .. } | Role::External { before, .. }) = &image.role else { return None };
            (before.layout != Layout::Undefined).then(|| {
                let range = Subresources::all(image.format, image.mips, image.layers);
                vk::ImageMemoryBarrier2::default()
                    .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                    .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                    .new_layout(convert::layout(before.layout))
                    .image(*raw)
                    .subresource_range(convert::range(range))
            })
        });
        let barriers: Vec<_> = barriers.collect();
        self.once(|raw, commands| {
            let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
            // SAFETY: the command buffer is being recorded, and the images live.
            unsafe { raw.cmd_pipeline_barrier2(commands, &info) };
        });
    }

    /// Records a frame. The frame before must have been waited for.
    #[inline(never)]
    pub(crate) fn encode(&mut self) {
        let (raw, commands) = (self.device.raw(), self.commands);
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the frame before was waited for; steps and barriers are those of a Plan that was verified.
        unsafe {
            raw.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty()).expect("a pool that is reset");
            raw.begin_command_buffer(commands, &begin).expect("a command buffer that begins");
            let info = vk::DependencyInfo::default().memory_barriers(std::slice::from_ref(&self.output_read));
            raw.cmd_pipeline_barrier2(commands, &info);
            for step in &self.steps {
                if !step.memory.is_empty() {
                    let info = vk::DependencyInfo::default().memory_barriers(&step.memory);
                    raw.cmd_pipeline_barrier2(commands, &info);
                }
                if !step.images.is_empty() {
                    let info = vk::DependencyInfo::default().image_memory_barriers(&step.images);
                    raw.cmd_pipeline_barrier2(commands, &info);
                }
                match &step.work {
                    StepWork::Render { color, depth, area, new_size, passes } => {
                        let mut rendering = vk::RenderingInfo::default().render_area(*area).layer_count(1);
                        if !color.is_empty() {
                            rendering = rendering.color_attachments(color);
                        }
                        if let Some(depth) = depth {
                            rendering = rendering.depth_attachment(depth);
                        }
                        raw.cmd_begin_rendering(commands, &rendering);
                        if *new_size {
                            let vk::Extent2D { width, height } = area.extent;
                            let (width, height) = (width as f32, height as f32);
                            let viewport = vk::Viewport { width, height, max_depth: 1.0, ..vk::Viewport::default() };
                            raw.cmd_set_viewport(commands, 0, &[viewport]);
                            raw.cmd_set_scissor(commands, 0, &[*area]);
                        }
                        for pass in passes {
                            bind(raw, commands, vk::PipelineBindPoint::GRAPHICS, pass);
                            match &self.objects {
                                Some(objects) if pass.draws_objects => objects.draw(raw, commands, pass.layout),
                                _ => raw.cmd_draw(commands, 3, 1, 0, 0),
                            }
                        }
                        raw.cmd_end_rendering(commands);
                    }
                    StepWork::Dispatch(pass, [x, y, z]) => {
                        bind(raw, commands, vk::PipelineBindPoint::COMPUTE, pass);
                        raw.cmd_dispatch(commands, *x, *y, *z);
                    }
                    StepWork::Nothing => {}
                }
            }
            raw.end_command_buffer(commands).expect("a command buffer that ends");
        }
    }

    /// Submits what was recorded.
    #[inline(never)]
    pub(crate) fn submit(&mut self) {
        self.submitted += 1;
        let signal = [vk::SemaphoreSubmitInfo::default()
            .semaphore(self.timeline)
            .value(self.submitted)
            .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
        let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands)];
        let submits = [vk::SubmitInfo2::default().command_buffer_infos(&buffers).signal_semaphore_infos(&signal)];
        // SAFETY: the commands are recorded, what they use lives, and no other thread uses the queue.
        unsafe { self.device.raw().queue_submit2(self.queue, &submits, vk::Fence::null()) }.expect("a submission");
    }

    /// Waits for what was submitted.
    pub(crate) fn wait(&self) {
        let (semaphores, values) = ([self.timeline], [self.submitted]);
        let info = vk::SemaphoreWaitInfo::default().semaphores(&semaphores).values(&values);
        // SAFETY: the semaphore lives.
        unsafe { self.device.raw().wait_semaphores(&info, u64::MAX) }.expect("the device answers");
    }

    /// The bytes of the output.
    pub(crate) fn read(&mut self) -> Vec<u8> {
        let (image, layout) = self.output;
        let (image, extent) = (self.images.raw[image], self.images.extents[image]);
        let buffer = memory::HostBuffer::new(
            &self.device,
            u64::from(extent.width * extent.height * 4),
            vk::BufferUsageFlags::TRANSFER_DST,
        );
        self.once(|raw, commands| {
            let subresource = vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                layer_count: 1,
                ..vk::ImageSubresourceLayers::default()
            };
            let region = vk::BufferImageCopy::default().image_subresource(subresource).image_extent(extent);
            // SAFETY: the command buffer is being recorded, the buffer is large enough, and the image can be copied from.
            unsafe {
                let all = vk::PipelineStageFlags2::ALL_COMMANDS;
                let barrier = |old: vk::ImageLayout, new: vk::ImageLayout| {
                    vk::ImageMemoryBarrier2::default()
                        .src_stage_mask(all)
                        .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
                        .dst_stage_mask(all)
                        .dst_access_mask(vk::AccessFlags2::MEMORY_READ)
                        .old_layout(old)
                        .new_layout(new)
                        .image(image)
                        .subresource_range(convert::range(Subresources::all(
                            framewright_graph::vulkan::Format::R8G8B8A8_UNORM,
                            1,
                            1,
                        )))
                };
                let source = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
                let there = [barrier(layout, source)];
                raw.cmd_pipeline_barrier2(commands, &vk::DependencyInfo::default().image_memory_barriers(&there));
                raw.cmd_copy_image_to_buffer(commands, image, source, buffer.raw, &[region]);
                let back = [barrier(source, layout)];
                raw.cmd_pipeline_barrier2(commands, &vk::DependencyInfo::default().image_memory_barriers(&back));
            }
        });
        buffer.bytes()
    }

    /// Records and submits commands, and waits for them.
    fn once(&mut self, record: impl FnOnce(&ash::Device, vk::CommandBuffer)) {
        let (raw, commands) = (self.device.raw(), self.commands);
        let begin = vk::CommandBufferBeginInfo::default();
        // SAFETY: nothing is in flight.
        unsafe {
            raw.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty()).expect("a pool that is reset");
            raw.begin_command_buffer(commands, &begin).expect("a command buffer that begins");
            record(raw, commands);
            raw.end_command_buffer(commands).expect("a command buffer that ends");
        }
        self.submit();
        self.wait();
    }
}

fn bind(raw: &ash::Device, commands: vk::CommandBuffer, point: vk::PipelineBindPoint, pass: &Pass) {
    // SAFETY: the command buffer is being recorded, and the set is made for the layout.
    unsafe {
        if let Some(pipeline) = pass.pipeline {
            raw.cmd_bind_pipeline(commands, point, pipeline);
        }
        if let Some(set) = pass.set {
            bind_set(raw, commands, point, pass.layout, 0, set);
        }
    }
}

/// Binds a set. Without dynamic offsets there is no list of them: for an empty one this driver would allocate.
fn bind_set(
    raw: &ash::Device,
    commands: vk::CommandBuffer,
    point: vk::PipelineBindPoint,
    layout: vk::PipelineLayout,
    number: u32,
    set: vk::DescriptorSet,
) {
    let bind = raw.fp_v1_0().cmd_bind_descriptor_sets;
    // SAFETY: the command buffer is being recorded, and the set is made for the layout.
    unsafe { bind(commands, point, layout, number, 1, &raw const set, 0, std::ptr::null()) };
}

/// The commands of a Plan's steps.
fn steps(
    device: &Device,
    workload: &Workload,
    plan: &Plan,
    images: &Images,
    objects: Option<&ObjectBuffers>,
    made: &mut Made,
) -> Vec<Step> {
    let modules = shader_modules(device, workload.shaders, made);
    let mut maker = PassMaker::new(device, plan, images, objects.map(|it| it.set_layouts), modules, made);
    let mut size = None;
    let steps = plan.steps.iter().map(|step| {
        let memory = step.memory_barriers.iter().map(memory_barrier).collect();
        let barriers = step.image_barriers.iter().map(|it| image_barrier(images, it)).collect();
        let work = match &step.work {
            Work::Render(scope) => {
                let new_size = size.replace(scope.extent) != Some(scope.extent);
                let [width, height] = scope.extent;
                StepWork::Render {
                    color: scope.color().iter().map(|it| maker.attachment(it)).collect(),
                    depth: scope.depth().map(|it| maker.attachment(it)),
                    area: vk::Rect2D { extent: vk::Extent2D { width, height }, ..vk::Rect2D::default() },
                    new_size,
                    passes: scope.passes.iter().map(|pass| maker.draw(scope, pass)).collect(),
                }
            }
            Work::Dispatch(pass) => maker.dispatch(pass),
            Work::Export => StepWork::Nothing,
            _ => panic!("the frame has draws and dispatches alone"),
        };
        Step { memory, images: barriers, work }
    });
    steps.collect()
}

fn memory_barrier(barrier: &MemoryBarrier) -> vk::MemoryBarrier2<'static> {
    vk::MemoryBarrier2::default()
        .src_stage_mask(convert::stages(barrier.src_stages))
        .src_access_mask(convert::accesses(barrier.src_accesses))
        .dst_stage_mask(convert::stages(barrier.dst_stages))
        .dst_access_mask(convert::accesses(barrier.dst_accesses))
}

fn image_barrier(images: &Images, barrier: &ImageBarrier) -> vk::ImageMemoryBarrier2<'static> {
    vk::ImageMemoryBarrier2::default()
        .src_stage_mask(convert::stages(barrier.src_stages))
        .src_access_mask(convert::accesses(barrier.src_accesses))
        .dst_stage_mask(convert::stages(barrier.dst_stages))
        .dst_access_mask(convert::accesses(barrier.dst_accesses))
        .old_layout(convert::layout(barrier.old_layout))
        .new_layout(convert::layout(barrier.new_layout))
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .image(images.raw[barrier.image.0 as usize])
        .subresource_range(convert::range(barrier.range))
}

impl Drop for ByHand {
    fn drop(&mut self) {
        let raw = self.device.raw();
        // SAFETY: every frame was waited for, and nothing is used again.
        unsafe {
            raw.destroy_command_pool(self.pool, None);
            raw.destroy_semaphore(self.timeline, None);
            self.made.pools.iter().for_each(|it| raw.destroy_descriptor_pool(*it, None));
            self.made.pipelines.iter().for_each(|it| raw.destroy_pipeline(*it, None));
            self.made.layouts.iter().for_each(|it| raw.destroy_pipeline_layout(*it, None));
            self.made.set_layouts.iter().for_each(|it| raw.destroy_descriptor_set_layout(*it, None));
            self.made.modules.iter().for_each(|it| raw.destroy_shader_module(*it, None));
            self.made.samplers.iter().for_each(|it| raw.destroy_sampler(*it, None));
        }
    }
}
