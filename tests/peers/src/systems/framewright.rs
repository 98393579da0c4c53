//! Framewright: a frame becomes a Plan.

use super::About;
use crate::Graph;
use crate::graphs::device;
use crate::measure::{Barriers, Candidate, Times, timed};
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::plan::Plan;

pub(super) const ABOUT: About = About {
    system: "framewright",
    package: "framewright-graph",
    does: "validates the frame, culls passes, orders them, tracks parts of images, shares memory among images, puts \
           barriers into few calls, and writes a Plan with names and reasons",
    lacks: "no Vulkan object is made: sizes of images in memory are estimates",
};

/// A frame that is compiled as the first one.
pub(super) struct Framewright {
    graph: Graph,
    device: Profile,
    barriers: Option<Barriers>,
}

impl Framewright {
    pub(super) fn new(graph: Graph) -> Framewright {
        Framewright { graph, device: device(), barriers: None }
    }
}

impl Candidate for Framewright {
    fn run(&mut self) -> Result<Times, String> {
        let (frame, build) = timed(|| self.graph.frame());
        let (plan, compile) =
            timed(|| compile(&frame, &self.device, &mut MemoryEstimate(&self.device), &Options::default()));
        self.barriers = Some(counted(&plan.map_err(|errors| format!("{errors:?}"))?));
        Ok(Times { build, compile })
    }

    fn barriers(&self) -> Option<Barriers> {
        self.barriers
    }
}

fn counted(plan: &Plan) -> Barriers {
    Barriers { images: u64::from(plan.totals.image_barriers), calls: u64::from(plan.totals.barrier_calls) }
}
