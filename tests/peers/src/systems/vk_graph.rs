//! vk-graph, which was screen-13: a graph is resolved while its commands are recorded.

use super::About;
use super::barrier_calls::{self, Driver};
use crate::accesses::Accesses;
use crate::measure::{Barriers, Candidate, Times, timed};
use ash::vk;
use std::rc::Rc;
use std::sync::Arc;
use vk_graph::Graph;
use vk_graph::driver::cmd_buf::{CommandBuffer, CommandBufferInfo};
use vk_graph::driver::device::Device as VulkanDevice;
use vk_graph::driver::image::{Image, ImageInfo};
use vk_graph::driver::instance::Instance;
use vk_graph::driver::sync::AccessType;
use vk_graph::pool::hash::HashPool;
use vk_graph::submission::RecordSelection;

pub(super) const SKIPPED: About = About {
    system: "vk-graph",
    package: "vk-graph",
    does: "puts commands that depend on each other side by side, tracks parts of images and the queue that owns them, finds \
           barriers, and records them into a command buffer; here the calls of vkCmdPipelineBarrier end before the driver",
    lacks: "no validation of accesses, no culling, no memory shared; images exist before, their state is kept in them from \
            frame to frame, and every frame is resolved anew; commands do nothing, and nothing is submitted",
};

pub(super) const CALLED: About = About {
    system: "vk-graph, driver",
    package: "vk-graph",
    does: "the same, and the driver is called",
    lacks: "the same",
};

/// Only a part of Vulkan's families of queues do work for a graph; the first one of lavapipe does all.
const FAMILY: u32 = 0;

/// A device whose calls of `vkCmdPipelineBarrier` are counted.
pub(super) struct Device(VulkanDevice);

impl Device {
    pub(super) fn find() -> Result<Device, String> {
        let entry = barrier_calls::loader()?;
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
        let info = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: The loader is kept until the process ends, and so is the instance.
        let handle = unsafe { entry.create_instance(&info, None) }.map_err(|error| error.to_string())?.handle();
        let instance = Instance::try_from_entry(entry, handle).map_err(|error| error.to_string())?;
        let devices = Instance::physical_devices(&instance).map_err(|error| error.to_string())?;
        let device = devices.into_iter().next().ok_or("no Vulkan device that vk-graph takes")?;
        VulkanDevice::try_from_physical_device(device).map(Device).map_err(|error| error.to_string())
    }
}

/// A graph with its images, and the command buffer that it is recorded into.
#[derive(Clone)]
pub(super) struct Commands<'a> {
    accesses: &'a Accesses,
    images: Rc<[Arc<Image>]>,
    buffer: Rc<CommandBuffer>,
    device: &'a Device,
}

impl<'a> Commands<'a> {
    pub(super) fn new(device: &'a Device, accesses: &'a Accesses) -> Result<Commands<'a>, String> {
        let images = accesses.images.iter().map(|image| {
            let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::STORAGE;
            let [width, height, _] = image.extent;
            let format = vk::Format::from_raw(image.format.vulkan());
            Image::create(&device.0, ImageInfo::image_2d(width, height, format, usage)).map(Arc::new)
        });
        let images = images.collect::<Result<_, _>>().map_err(|error| format!("images: {error}"))?;
        let buffer = CommandBuffer::create(&device.0, CommandBufferInfo::new(FAMILY));
        let buffer = Rc::new(buffer.map_err(|error| format!("command buffer: {error}"))?);
        let commands = Commands { accesses, images, buffer, device };
        commands.submit_one()?;
        Ok(commands)
    }

    /// Makes the queue the owner of all images, as it is in every frame but the first.
    fn submit_one(&self) -> Result<(), String> {
        barrier_calls::begin(Driver::Called);
        let submitted = self.graph().finalize().queue_submit(&mut HashPool::new(&self.device.0), FAMILY, 0);
        let waited = submitted.and_then(|mut fence| fence.wait().map(drop));
        waited.map_err(|error| format!("first frame: {error}"))
    }

    fn graph(&self) -> Graph {
        let mut graph = Graph::new();
        let images: Vec<_> = self.images.iter().map(|image| graph.bind_resource(image)).collect();
        for pass in &self.accesses.passes {
            let mut command = graph.begin_cmd();
            let mut access = |image: u32, access| command.set_resource_access(images[image as usize], access);
            let sample = AccessType::ComputeShaderReadSampledImageOrUniformTexelBuffer;
            pass.sampled.iter().for_each(|image| access(*image, sample));
            pass.written.iter().for_each(|image| access(*image, AccessType::ComputeShaderWrite));
            pass.changed.iter().for_each(|image| access(*image, AccessType::ComputeShaderReadWrite));
            command.record_cmd(|_| {}).end_cmd();
        }
        graph
    }
}

/// A graph that is recorded with or without the driver.
pub(super) struct Recorded<'a> {
    pub(super) commands: Commands<'a>,
    pub(super) driver: Driver,
}

impl Candidate for Recorded<'_> {
    fn run(&mut self) -> Result<Times, String> {
        let Commands { buffer, device, .. } = &self.commands;
        let mut pool = HashPool::new(&device.0);
        barrier_calls::begin(self.driver);
        let once = vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT;
        buffer.begin(&vk::CommandBufferBeginInfo::default().flags(once)).map_err(|error| error.to_string())?;
        let (graph, build) = timed(|| self.commands.graph());
        let (recording, compile) = timed(|| graph.finalize().record(&mut pool, buffer.as_ref(), RecordSelection::All));
        recording.map(drop).map_err(|error| error.to_string())?;
        buffer.end().map_err(|error| error.to_string())?;
        Ok(Times { build, compile })
    }

    fn barriers(&self) -> Option<Barriers> {
        let (calls, images) = barrier_calls::counted();
        Some(Barriers { images, calls })
    }
}
