//! A Plan that is ready to be drawn.

use super::diagnostics;
use crate::error::Error;
use crate::planning::Assets;
use framewright_graph::frame::{Draw, Frame};
use framewright_graph::plan::{Pass, Plan};
use framewright_passes::draw::SceneDrawSource;
use framewright_passes::scene::Scene;
use framewright_vulkan::{Device, Executor, ExecutorOptions, FrameReport};

/// A Plan, and all that drawing it takes.
pub(crate) struct Prepared<'p> {
    pub(crate) plan: &'p Plan,
    pub(crate) executor: Executor,
    pub(crate) source: SceneDrawSource,
}

impl<'p> Prepared<'p> {
    /// Uploads the scene, and makes pipelines and memory. `frame` is the one that the Plan was made of, if there is one: it
    /// knows the places of mistakes.
    ///
    /// # Errors
    /// Custom passes, which another program records; mistakes of textures and shaders, or of the device.
    pub(crate) fn new(
        device: &Device,
        (plan, frame): (&'p Plan, Option<&Frame>),
        assets: &mut Assets,
        scene: &Scene,
        options: &ExecutorOptions,
    ) -> Result<Prepared<'p>, Error> {
        if let Some(pass) = custom(plan) {
            return Err(Error::CustomPass { pass: pass.name.to_string(), name: pass.shader.to_string() });
        }
        let source = SceneDrawSource::for_plan(device, scene, plan.extent, plan)?;
        let Assets { shaders, textures, .. } = assets;
        let executor = Executor::with_textures(device, plan, shaders, textures, options)
            .map_err(|problem| diagnostics::texture(frame, problem))?;
        Ok(Prepared { plan, executor, source })
    }

    /// Draws a frame and waits for it.
    ///
    /// # Errors
    /// Those of the device.
    pub(crate) fn draw(&mut self) -> Result<FrameReport, Error> {
        let frame = self.executor.frame(&mut self.source)?;
        Ok(self.executor.report(frame)?)
    }
}

/// The first pass that only the program of another draw source can record.
fn custom(plan: &Plan) -> Option<&Pass> {
    plan.steps.iter().find_map(|step| {
        let custom = step.work.is_custom();
        step.work.passes().iter().find(|pass| custom || pass.draw.is_some_and(Draw::is_custom))
    })
}
