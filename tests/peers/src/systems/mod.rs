//! The systems, each with its way of compiling a graph.

mod barrier_calls;
mod framewright;
mod vk_graph;
mod vulkano;

use crate::Graph;
use crate::accesses::Accesses;
use crate::measure::Candidate;
use barrier_calls::Driver;
use vulkano::Origin;

/// The work of a system in the part "compile", and the work that it leaves out.
pub(crate) struct About {
    /// Its name in the table.
    pub(crate) system: &'static str,
    /// The package that it is.
    pub(crate) package: &'static str,
    pub(crate) does: &'static str,
    pub(crate) lacks: &'static str,
}

/// All systems, in the order of [`candidates`].
pub(crate) const ALL: [About; 5] =
    [framewright::ABOUT, vulkano::GIVEN, vulkano::FOUND, vk_graph::SKIPPED, vk_graph::CALLED];

/// Devices of the peers. `Err`: why there is none.
pub(crate) struct Devices {
    vulkano: Result<vulkano::Device, String>,
    vk_graph: Result<vk_graph::Device, String>,
}

impl Devices {
    pub(crate) fn find() -> Devices {
        Devices { vulkano: vulkano::Device::find(), vk_graph: vk_graph::Device::find() }
    }

    /// The name of the Vulkan device.
    pub(crate) fn name(&self) -> Option<&str> {
        self.vulkano.as_ref().ok().map(vulkano::Device::name)
    }
}

/// A graph in every system, or why a system can't have it; in the order of [`ALL`].
pub(crate) fn candidates<'a>(
    graph: Graph,
    accesses: &'a Accesses,
    devices: &'a Devices,
) -> [Result<Box<dyn Candidate + 'a>, String>; 5] {
    let taskgraph = |origin| -> Result<Box<dyn Candidate + 'a>, String> {
        let device = devices.vulkano.as_ref().map_err(Clone::clone)?;
        Ok(Box::new(vulkano::Taskgraph::new(device, accesses, origin)))
    };
    let commands = devices.vk_graph.as_ref().map_err(Clone::clone);
    let commands = commands.and_then(|device| vk_graph::Commands::new(device, accesses));
    let recorded = |driver| -> Result<Box<dyn Candidate + 'a>, String> {
        Ok(Box::new(vk_graph::Recorded { commands: commands.clone()?, driver }))
    };
    [
        Ok(Box::new(framewright::Framewright::new(graph))),
        taskgraph(Origin::Given),
        taskgraph(Origin::Found),
        recorded(Driver::Skipped),
        recorded(Driver::Called),
    ]
}
