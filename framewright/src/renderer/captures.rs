//! Captures of a frame that a program draws: what passes left in images. One frame is drawn by a Plan that copies them.

use super::{Change, DrawnPlan, Renderer};
use crate::error::Error;
use framewright_graph::dataflow::Dataflow;
use framewright_graph::frame::{Capture, CaptureName, Captures, Frame, Lifetime, capture_name};
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::{Aspects, Format};
use framewright_vulkan::{Executor, Texels};
use std::collections::HashSet;

/// The texels of each capture that was asked for; else why there are none, in words.
pub type CapturedTexels = Vec<(CaptureName, Result<Texels, String>)>;

/// What a renderer was asked to capture.
#[derive(Debug, Default)]
pub(super) struct CaptureState {
    /// What the next frame shall capture.
    asked: Option<Vec<CaptureName>>,
    /// What isn't captured, and why.
    refused: Vec<(CaptureName, String)>,
    /// The Plan that is drawn, where it has captures.
    drawn: Option<CapturedPlan>,
}

/// A Plan with captures.
#[derive(Debug)]
struct CapturedPlan {
    /// Those that nobody took yet, in their order.
    captures: Vec<Capture>,
    /// The Plan without them.
    own: Plan,
    /// The number of its first frame.
    first: u64,
}

impl CaptureState {
    /// Whether the next frame shall be captured.
    pub(super) fn is_asked(&self) -> bool {
        self.asked.is_some()
    }

    /// Whether the captures were taken, and the Plan of before is next.
    pub(super) fn is_over(&self) -> bool {
        self.drawn.as_ref().is_some_and(|drawn| drawn.captures.is_empty())
    }

    /// Ends it, since `plan` is next. Whether that is the Plan of before; `None`: nothing was captured.
    pub(super) fn end(&mut self, plan: &Plan) -> Option<bool> {
        let CapturedPlan { captures, own, .. } = self.drawn.take()?;
        let why = "the frame was planned anew before it was captured";
        self.refused.extend(captures.iter().map(|capture| (capture.name(), why.to_owned())));
        Some(own == *plan)
    }
}

impl Renderer {
    /// What can be captured of the frame that is drawn: see [`Frame::captures`]. Before the first Plan there is nothing.
    ///
    /// # Errors
    /// Those of [`Pipeline::frame`](crate::Pipeline::frame).
    pub fn captures(&mut self) -> Result<Captures, Error> {
        let Some(drawn) = &self.drawn else { return Ok(Captures::default()) };
        let choices = drawn.chosen.of(&self.pipeline.document);
        let frame = self.pipeline.frame(&choices, &self.profile)?;
        Ok(captures_of(&frame, drawn.executor.plan()))
    }

    /// Has the next frame captured: what passes leave in images. Another Plan draws that frame, which copies the images on the way, by another
    /// executor ([`Change::Executor`]); [`Renderer::captured`] has the texels then, and the frame after has the Plan of before. In both
    /// frames all passes run, also those that don't run in every frame.
    ///
    /// Nothing is captured where the program imports images or buffers, or where something that goes from frame to frame would be lost. What
    /// doesn't fit into 64 images or 256 MiB together isn't captured either.
    pub fn capture(&mut self, wanted: &[CaptureName]) {
        self.capturing.asked = Some(wanted.to_vec());
        self.capturing.refused.clear();
    }

    /// Whether the Plan that is drawn has captures: [`Renderer::plan`] is that one then.
    #[must_use]
    pub fn is_capturing(&self) -> bool {
        self.capturing.drawn.is_some()
    }

    /// What was asked for by [`Renderer::capture`]; the format of stencil is [`Format::R8_UINT`]. `None` until a frame was drawn. The frame
    /// that follows isn't captured.
    ///
    /// # Errors
    /// Those of [`Executor::read_image`].
    pub fn captured(&mut self) -> Result<Option<CapturedTexels>, Error> {
        if self.capturing.asked.is_some() {
            return Ok(None);
        }
        let mut all = Vec::new();
        if let (Some(captured), Some(drawn)) = (&mut self.capturing.drawn, &mut self.drawn) {
            if drawn.executor.frames() <= captured.first {
                return Ok(None);
            }
            self.changed = true;
            for (number, capture) in std::mem::take(&mut captured.captures).iter().enumerate() {
                all.push((capture.name(), Ok(texels(&mut drawn.executor, number, capture)?)));
            }
        }
        let refused = std::mem::take(&mut self.capturing.refused);
        all.extend(refused.into_iter().map(|(name, why)| (name, Err(why))));
        Ok(Some(all))
    }

    /// Plans the next frame with the captures that were asked for, and has an executor of it. `None`: it has none, and is planned as always.
    pub(super) fn renew_captured(&mut self) -> Result<Option<Change>, Error> {
        let Some(asked) = self.capturing.asked.take() else { return Ok(None) };
        let (captured, mut executor) = match self.captured_plan(&asked) {
            Ok(made) => made,
            Err(why) => {
                let refused: HashSet<CaptureName> =
                    self.capturing.refused.iter().map(|(name, _)| name.clone()).collect();
                let others = asked.into_iter().filter(|name| !refused.contains(name));
                self.capturing.refused.extend(others.map(|name| (name, why.clone())));
                self.changed |= self.is_capturing();
                return Ok(None);
            }
        };
        let Some(before) = self.drawn.take() else { return Ok(None) };
        let was = self.capturing.drawn.take().map(|earlier| earlier.own);
        self.plans += u64::from(was.as_ref().unwrap_or(before.executor.plan()) != &captured.own);
        // Without an executor the next frame is planned anew.
        self.changed = true;
        let carried_over = executor.migrate_from(before.executor)?;
        self.capturing.drawn = Some(CapturedPlan { first: executor.frames(), ..captured });
        self.drawn = Some(DrawnPlan { executor, chosen: self.chosen.clone() });
        self.changed = false;
        Ok(Some(Change::Executor { carried_over }))
    }

    /// The Plan with the captures, and its executor; else why there is none, in words. Captures that there are none of are noted.
    fn captured_plan(&mut self, asked: &[CaptureName]) -> Result<(CapturedPlan, Executor), String> {
        let Renderer { device, profile, options, pipeline, chosen, compiler, sets, drawn, capturing, .. } = self;
        let Some(drawn) = drawn else { return Err("no frame was drawn yet".to_owned()) };
        let words = |error: Error| error.to_string();
        let choices = chosen.of(&pipeline.document);
        let own = pipeline.plan(compiler, device, profile, &choices, &options.compile).map_err(words)?.clone();
        let frame = pipeline.frame(&choices, profile).map_err(words)?;
        let (mut captures, mut missing) = captures_of(&frame, &own).named(asked);
        let fitting = Capture::batches(&captures).next().map_or(0, <[Capture]>::len);
        let beyond = captures.split_off(fitting);
        let too_many = "beside the others it takes too much memory: ask for fewer at once";
        missing.extend(beyond.iter().map(|capture| (capture.name(), too_many.to_owned())));
        capturing.refused.extend(missing);
        if captures.is_empty() {
            return Err("nothing is left to capture".to_owned());
        }
        if let Some(name) = imported(&frame, &own) {
            return Err(format!("the program imports `{name}`, and would have to do so again for a captured frame"));
        }
        let captured = frame.with_captures(&captures);
        let plan = pipeline.compile(&captured, profile, &mut device.memory(), &options.compile).map_err(words)?;
        pipeline.fits(&plan, &captured, profile).map_err(words)?;
        drawn.executor.check_owners(&plan).map_err(|error| error.to_string())?;
        let mut executor = pipeline.assets.executor(device, &plan, &options.executor).map_err(words)?;
        let lost = executor.would_lose(&drawn.executor);
        if !lost.is_empty() {
            return Err(format!("a captured frame would lose what goes on in `{}`", lost.join("`, `")));
        }
        sets.iter().for_each(|(number, (set, offsets))| executor.bind_set(*number, *set, offsets));
        Ok((CapturedPlan { captures, own, first: 0 }, executor))
    }
}

/// What the passes of `plan` write in `frame`, which it was made of.
fn captures_of(frame: &Frame, plan: &Plan) -> Captures {
    let flow = Dataflow::of(plan);
    let runs: HashSet<&str> = flow.nodes.iter().map(|node| node.name.as_str()).collect();
    frame.captures(|pass| runs.contains(pass))
}

/// The name of something of the program's that the Plan uses.
fn imported<'f>(frame: &'f Frame, plan: &Plan) -> Option<&'f str> {
    let is_imported = |lifetime: &Lifetime| matches!(lifetime, Lifetime::Imported { .. });
    let images = frame.images.iter().filter(|it| is_imported(&it.lifetime)).map(|it| &*it.name);
    let buffers = frame.buffers.iter().filter(|it| is_imported(&it.lifetime)).map(|it| &*it.name);
    let used = plan.images.iter().map(|it| &*it.name).chain(plan.buffers.iter().map(|it| &*it.name));
    let used: HashSet<&str> = used.collect();
    images.chain(buffers).find(|name| used.contains(name))
}

fn texels(executor: &mut Executor, number: usize, capture: &Capture) -> Result<Texels, Error> {
    let plane = capture.range.aspects;
    let texels = executor.read_image(&capture_name(number), plane, 0)?;
    // Stencil is read as bytes.
    let format = if plane == Aspects::STENCIL { Format::R8_UINT } else { texels.format };
    Ok(Texels { format, ..texels })
}
