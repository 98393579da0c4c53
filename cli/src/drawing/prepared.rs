//! A planned frame that is ready to be drawn.

use super::diagnostics;
use crate::command_line::values::Size;
use crate::error::Error;
use crate::planning::{Loaded, Planned};
use framewright_passes::draw::SceneDrawSource;
use framewright_passes::scene::Scene;
use framewright_vulkan::{Device, Executor, ExecutorOptions, FrameReport};

/// A planned frame, and all that drawing it takes.
pub(crate) struct Prepared<'p> {
    pub(crate) planned: &'p Planned,
    pub(crate) executor: Executor,
    pub(crate) source: SceneDrawSource,
}

impl<'p> Prepared<'p> {
    /// Uploads the scene, and makes pipelines and memory.
    ///
    /// # Errors
    /// Mistakes of textures and shaders, or of the device.
    pub(crate) fn new(
        device: &Device,
        planned: &'p Planned,
        pipeline: &mut Loaded,
        scene: &Scene,
        size: Size,
        options: &ExecutorOptions,
    ) -> Result<Prepared<'p>, Error> {
        let source = SceneDrawSource::for_plan(device, scene, [size.width, size.height], &planned.plan)?;
        let Loaded { shaders, textures, .. } = pipeline;
        let executor = Executor::with_textures(device, &planned.plan, shaders, textures, options)
            .map_err(|problem| diagnostics::texture(&planned.frame, problem))?;
        Ok(Prepared { planned, executor, source })
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
