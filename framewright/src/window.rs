//! Renderers that draw into windows.

use crate::error::Error;
use crate::renderer::Renderer;
use framewright_graph::frame::Stereo;
use framewright_graph::vulkan::Format;
use framewright_vulkan::{DrawSource, Executor, Overlay, Presentation, Swapchain};
use std::sync::Arc;

impl Renderer {
    /// Fits the frame to a window: to size, format and rotation of its images. Two eyes beside each other
    /// ([`Stereo::DoubleWide`], [`Stereo::Instanced`]) have half of its width each. While the window has no area nothing changes.
    ///
    /// # Errors
    /// Those of [`Renderer::set_extent`] and [`Renderer::set_stereo`].
    pub fn fit(&mut self, window: &Swapchain) -> Result<(), Error> {
        let (Some([width, height]), format) = (window.extent(), window.format()) else { return Ok(()) };
        let eyes = match self.chosen.frame.stereo_on(&self.profile)? {
            Stereo::DoubleWide | Stereo::Instanced => 2,
            Stereo::Off | Stereo::MultiPass | Stereo::Multiview => 1,
        };
        self.set_extent([(width / eyes).max(1), height])?;
        let rotation = window.rotation();
        self.take(|chosen| (chosen.frame.window, chosen.frame.rotation) = (format, rotation));
        Ok(())
    }

    /// Tells the format of the images that the program shows the first output in, as a swapchain of its own or of a runtime's: what the
    /// pipeline calls `format: Output`. `None`: the format that the pipeline has without a window. [`Renderer::fit`] does it for a
    /// [`Swapchain`].
    pub fn set_output_format(&mut self, format: Option<Format>) {
        self.take(|chosen| chosen.frame.window = format);
    }

    /// Draws a frame into the next image of a window that it [fits](Renderer::fit), and has it shown: the first output. See
    /// [`Executor::present`].
    ///
    /// # Errors
    /// Those of [`Renderer::prepare`] and [`Executor::present`].
    pub fn present(&mut self, source: &mut dyn DrawSource, window: &mut Swapchain) -> Result<Presentation, Error> {
        self.prepare()?;
        let executor = &mut self.drawn()?.executor;
        Ok(executor.present(source, window, &shown(executor))?)
    }

    /// Draws a frame into the next image of a window, then a frame of the renderer `over` over it, such as text, and has both shown: see
    /// [`Renderer::present`] and [`Overlay`]. The overlay is the first output of `over`, whose frames are counted by themselves.
    ///
    /// # Errors
    /// Those of [`Renderer::present`], of both renderers. If the overlay can't be drawn, the frame of this renderer is submitted all the
    /// same: it counts, and isn't shown.
    pub fn present_with_overlay(
        &mut self,
        source: &mut dyn DrawSource,
        window: &mut Swapchain,
        over: &mut Renderer,
        over_source: &mut dyn DrawSource,
    ) -> Result<Presentation, Error> {
        self.prepare()?;
        over.prepare()?;
        let over = &mut over.drawn()?.executor;
        let name = shown(over);
        let overlay = Overlay { executor: over, source: over_source, name: &name };
        let executor = &mut self.drawn()?.executor;
        Ok(executor.present_with_overlay(source, window, &shown(executor), overlay)?)
    }
}

/// The name of the output that windows show.
fn shown(executor: &Executor) -> Arc<str> {
    executor.plan().outputs.first().map_or_else(Arc::default, |output| output.name.clone())
}
