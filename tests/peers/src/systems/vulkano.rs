//! vulkano-taskgraph: a graph of tasks and edges becomes an executable graph.

use super::About;
use crate::accesses::{Accesses, Edges};
use crate::measure::{Barriers, Candidate, Times, timed};
use ash::vk;
use std::marker::PhantomData;
use std::sync::Arc;
use std::time::Duration;
use vulkano::VulkanLibrary;
use vulkano::device::{Device as VulkanDevice, DeviceCreateInfo, Queue, QueueCreateInfo, QueueFlags};
use vulkano::format::Format;
use vulkano::image::{ImageCreateInfo, ImageUsage};
use vulkano::instance::{Instance, InstanceCreateInfo};
use vulkano_taskgraph::QueueFamilyType;
use vulkano_taskgraph::graph::{CompileInfo, ExecutableTaskGraph, TaskGraph};
use vulkano_taskgraph::resource::{AccessTypes, ImageLayoutType, Resources, ResourcesCreateInfo};

pub(super) const GIVEN: About = About {
    system: "vulkano-taskgraph",
    package: "vulkano-taskgraph",
    does: "checks that the graph is connected and has no cycle, sorts it by its edges, and finds barriers; images are virtual",
    lacks: "the caller finds the edges; no validation of accesses, no culling, no memory shared, no parts of images; recording \
            and executing are not measured",
};

pub(super) const FOUND: About = About {
    system: "taskgraph, edges",
    package: "vulkano-taskgraph",
    does: "the same, and before it the edges are found from the accesses, by this program",
    lacks: "the same, but for the edges",
};

/// Where edges come from.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Origin {
    /// They were known before.
    Given,
    /// They are found in each run.
    Found,
}

/// A queue, and where resources of graphs are registered.
pub(super) struct Device {
    name: String,
    queue: Arc<Queue>,
    resources: Arc<Resources>,
}

impl Device {
    pub(super) fn find() -> Result<Device, String> {
        let library = VulkanLibrary::new().map_err(|error| error.to_string())?;
        let instance = Instance::new(library, InstanceCreateInfo::default()).map_err(|error| error.to_string())?;
        let mut devices = instance.enumerate_physical_devices().map_err(|error| error.to_string())?;
        let physical = devices.next().ok_or("no Vulkan device")?;
        let computes = |flags: QueueFlags| flags.contains(QueueFlags::GRAPHICS | QueueFlags::COMPUTE);
        let families = physical.queue_family_properties();
        let family = families.iter().position(|family| computes(family.queue_flags)).ok_or("no queue computes")?;
        let name = physical.properties().device_name.clone();
        let info = DeviceCreateInfo {
            queue_create_infos: vec![QueueCreateInfo { queue_family_index: family as u32, ..Default::default() }],
            ..Default::default()
        };
        let (device, mut queues) = VulkanDevice::new(physical, info).map_err(|error| error.to_string())?;
        let queue = queues.next().ok_or("no queue")?;
        let resources = Resources::new(&device, &ResourcesCreateInfo::default());
        Ok(Device { name, queue, resources })
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }
}

/// A graph, and what came out of the last run.
pub(super) struct Taskgraph<'a> {
    device: &'a Device,
    accesses: &'a Accesses,
    edges: Edges,
    origin: Origin,
    compiled: Option<ExecutableTaskGraph<()>>,
}

impl<'a> Taskgraph<'a> {
    pub(super) fn new(device: &'a Device, accesses: &'a Accesses, origin: Origin) -> Taskgraph<'a> {
        Taskgraph { device, accesses, edges: accesses.edges(), origin, compiled: None }
    }

    fn graph(&self) -> TaskGraph<()> {
        let Accesses { images, passes } = self.accesses;
        let mut graph = TaskGraph::new(&self.device.resources, passes.len() as u32, images.len() as u32);
        let add = |image: &framewright_graph::frame::Image| {
            graph.add_image(&ImageCreateInfo {
                format: Format::try_from(vk::Format::from_raw(image.format.vulkan())).expect("a format of Vulkan 1.0"),
                extent: image.extent,
                usage: ImageUsage::SAMPLED | ImageUsage::STORAGE,
                ..Default::default()
            })
        };
        let images: Vec<_> = images.iter().map(add).collect();
        let write = AccessTypes::COMPUTE_SHADER_STORAGE_WRITE;
        let mut nodes = Vec::with_capacity(passes.len());
        for pass in passes {
            let task = PhantomData::<fn() -> ()>;
            let mut node = graph.create_task_node("pass", QueueFamilyType::Compute, task);
            let mut access = |image: u32, types| {
                node.image_access(images[image as usize], types, ImageLayoutType::Optimal);
            };
            pass.sampled.iter().for_each(|image| access(*image, AccessTypes::COMPUTE_SHADER_SAMPLED_READ));
            pass.written.iter().for_each(|image| access(*image, write));
            pass.changed.iter().for_each(|image| access(*image, AccessTypes::COMPUTE_SHADER_STORAGE_READ | write));
            nodes.push(node.build());
        }
        for [before, after] in &self.edges {
            graph.add_edge(nodes[*before as usize], nodes[*after as usize]).expect("each edge is there once");
        }
        graph
    }
}

impl Candidate for Taskgraph<'_> {
    fn run(&mut self) -> Result<Times, String> {
        let mut finding = Duration::ZERO;
        if self.origin == Origin::Found {
            (self.edges, finding) = timed(|| self.accesses.edges());
        }
        let (graph, build) = timed(|| self.graph());
        let info = CompileInfo { queues: &[&self.device.queue], ..Default::default() };
        // SAFETY: Edges order all conflicting accesses, and the queue computes. The compiled graph is never executed.
        let (compiled, compile) = timed(|| unsafe { graph.compile(&info) }.map_err(|error| error.to_string()));
        self.compiled = Some(compiled?);
        Ok(Times { build, compile: finding + compile })
    }

    /// Counted in the debug text of the compiled graph, which shows its instructions and barriers.
    fn barriers(&self) -> Option<Barriers> {
        let text = format!("{:?}", self.compiled.as_ref()?);
        let count = |part: &str| text.matches(part).count() as u64;
        let first_transitions = count("initial_barrier_range: ") - count("initial_barrier_range: 0..0");
        Some(Barriers { images: count("MemoryBarrier {"), calls: count("PipelineBarrier {") + first_transitions })
    }
}
