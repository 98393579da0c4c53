//! Framewright: a frame becomes a Plan.

use super::About;
use crate::Graph;
use crate::changed::with_sizes;
use crate::graphs::device;
use crate::measure::{Barriers, Candidate, Times, timed};
use framewright_graph::compile::{Compiler, Options, Reuse, compile};
use framewright_graph::device::{Estimated, Profile};
use framewright_graph::frame::Frame;
use framewright_graph::plan::Plan;
use std::sync::Arc;
use std::time::Duration;

pub(super) const ANEW: About = About {
    system: "framewright",
    package: "framewright-graph",
    does: "validates the frame, culls passes, orders them, tracks parts of images, shares memory among images, puts \
           barriers into few calls, and writes a Plan with names and reasons",
    lacks: "no Vulkan object is made: sizes of images in memory are estimates",
};

pub(super) const OTHER_SIZES: About = About {
    system: "framewright, sizes",
    package: "framewright-graph",
    does: "a compiler that has compiled the frame compiles it with other sizes of images: memory and barriers are found anew",
    lacks: "the structure of the frame is taken from the run before; building the changed frame is not measured",
};

/// A frame that is compiled as the first one.
pub(super) struct Anew {
    graph: Graph,
    device: Profile,
    barriers: Option<Barriers>,
}

impl Anew {
    pub(super) fn new(graph: Graph) -> Anew {
        Anew { graph, device: device(), barriers: None }
    }
}

impl Candidate for Anew {
    fn run(&mut self) -> Result<Times, String> {
        let (frame, build) = timed(|| self.graph.frame());
        let (plan, compile) =
            timed(|| compile(&frame, &self.device, &mut Estimated(&self.device), &Options::default()));
        self.barriers = Some(counted(&plan.map_err(|errors| format!("{errors:?}"))?));
        Ok(Times { build: Some(build), compile })
    }

    fn barriers(&self) -> Option<Barriers> {
        self.barriers
    }
}

/// A frame that is compiled in two sizes by turns.
pub(super) struct OtherSizes {
    frames: [Arc<Frame>; 2],
    device: Arc<Profile>,
    compiler: Compiler,
    barriers: Option<Barriers>,
}

impl OtherSizes {
    pub(super) fn new(graph: Graph) -> OtherSizes {
        let frame = graph.frame();
        let frames = [with_sizes(&frame), frame].map(Arc::new);
        OtherSizes { frames, device: Arc::new(device()), compiler: Compiler::new(), barriers: None }
    }

    fn compile(&mut self) -> Result<Duration, String> {
        self.frames.swap(0, 1);
        let [frame, _] = &self.frames;
        let memory = &mut Estimated(&self.device);
        let (plan, compile) = timed(|| self.compiler.compile(frame, &self.device, memory, &Options::default()));
        self.barriers = Some(counted(plan.map_err(|errors| format!("{errors:?}"))?));
        Ok(compile)
    }
}

impl Candidate for OtherSizes {
    fn run(&mut self) -> Result<Times, String> {
        // The first frame of all has nothing to follow.
        if self.barriers.is_none() {
            self.compile()?;
        }
        let compile = self.compile()?;
        if self.compiler.reuse() < Reuse::Structure {
            return Err(format!("compiled anew: {:?} was reused", self.compiler.reuse()));
        }
        Ok(Times { build: None, compile })
    }

    fn barriers(&self) -> Option<Barriers> {
        self.barriers
    }
}

fn counted(plan: &Plan) -> Barriers {
    Barriers { images: u64::from(plan.totals.image_barriers), calls: u64::from(plan.totals.barrier_calls) }
}
