//! What a program says of passes that don't run in every frame.

use crate::error::Error;
use crate::renderer::Renderer;

impl Renderer {
    /// Says that what passes with `run: WhenDirty("name")` write is out of date: they run in the next frame. Where anything changed, it is
    /// planned first.
    ///
    /// # Errors
    /// Those of [`Renderer::prepare`] and [`Executor::set_dirty`](framewright_vulkan::Executor::set_dirty).
    pub fn set_dirty(&mut self, name: &str) -> Result<(), Error> {
        Ok(self.executor_mut()?.set_dirty(name)?)
    }

    /// Has all passes run in the next frame, as in the first one, also those that run once.
    pub fn run_all(&mut self) {
        // An executor that is yet to be made runs all by itself.
        if let Some(executor) = self.current_executor_mut() {
            executor.run_all();
        }
    }

    /// Gives the next frame a number of the program's: see [`Executor::set_frame_number`](framewright_vulkan::Executor::set_frame_number). Where
    /// anything changed, it is planned first.
    ///
    /// # Errors
    /// Those of [`Renderer::prepare`].
    pub fn set_frame_number(&mut self, number: u64) -> Result<(), Error> {
        self.executor_mut()?.set_frame_number(number);
        Ok(())
    }

    /// Sets the time of frames from the next one on, in seconds: see [`Executor::set_time`](framewright_vulkan::Executor::set_time). Where anything
    /// changed, it is planned first.
    ///
    /// # Errors
    /// Those of [`Renderer::prepare`] and [`Executor::set_time`](framewright_vulkan::Executor::set_time).
    pub fn set_time(&mut self, seconds: f64) -> Result<(), Error> {
        Ok(self.executor_mut()?.set_time(seconds)?)
    }
}
