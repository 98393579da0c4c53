//! Frames of a Plan that are shown in a window.

use super::handle::SwapchainHandle;
use super::swapchain::{Shown, Swapchain};
use crate::base::{Error, convert};
use crate::execute::{Executor, SemaphorePoint, Submission};
use crate::record::DrawSource;
use std::any::Any;
use std::sync::Arc;

/// What became of a frame that was to be shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Presentation {
    /// The frame of this number is shown.
    Shown(u64),
    /// It is shown, and the surface has changed: [`Swapchain::resize`] makes images that fit.
    Suboptimal(u64),
    /// Nothing is shown, since the surface has changed: [`Swapchain::resize`] makes images that fit.
    OutOfDate,
    /// Nothing is shown or drawn, since the surface has no area, as that of a minimised window. [`Swapchain::resize`] tells when it
    /// has.
    NoArea,
}

impl Executor {
    /// Draws a frame into the next image of a window, and has it shown. `name` is the output that is shown: the frame must have been
    /// made with the swapchain's format, size and rotation, and leave it as `Present`.
    ///
    /// Nothing is waited for but a free image, the oldest frame on its way if as many are as may be, and for an
    /// [overlay](Swapchain::set_overlay) that changed the one before.
    ///
    /// # Errors
    /// Those of [`Executor::submit`]; [`Error::BadResource`] if there is no such output or the window's images are none for it or for
    /// the overlay;
    /// [`Error::SurfaceLost`]; [`Error::Timeout`] if no image becomes free.
    pub fn present(
        &mut self,
        source: &mut dyn DrawSource,
        swapchain: &mut Swapchain,
        name: &str,
    ) -> Result<Presentation, Error> {
        let used =
            self.plan().images.iter().find(|image| *image.name == *name).map(|image| convert::usage(image.usage));
        let as_before = used.map_or(Ok(true), |used| swapchain.allow(used))?;
        let Some(current) = swapchain.current().cloned() else { return Ok(Presentation::NoArea) };
        if !as_before {
            return Ok(Presentation::OutOfDate);
        }
        self.show_in(&current, name)?;
        self.make_room()?;
        let laid_over = swapchain.ready_overlay()?;
        let Some(image) = swapchain.acquire()? else { return Ok(Presentation::OutOfDate) };
        let (done, value) = image.done;
        let images = [(name, image.number as usize)];
        let waits = [SemaphorePoint::binary(image.free)];
        let signals = [SemaphorePoint::timeline(done, value), SemaphorePoint::binary(image.drawn)];
        // Under an overlay the image isn't drawn yet when the frame is done.
        let signals = if laid_over { &signals[..1] } else { &signals[..] };
        let among = Submission { images: &images, waits: &waits, signals };
        // SAFETY: the semaphores are the swapchain's and nothing else uses them meanwhile, and the image is free when the wait is
        // over. The swapchain lives until this executor's frames are done.
        let submitted = unsafe { self.submit_with(source, &among) };
        let frame = submitted.inspect_err(|_| swapchain.give_up())?;
        if laid_over {
            swapchain.lay_over(&image).inspect_err(|_| swapchain.give_up())?;
        }
        Ok(match swapchain.show(&image)? {
            Shown::Right => Presentation::Shown(frame),
            Shown::Suboptimal => Presentation::Suboptimal(frame),
            Shown::OutOfDate => Presentation::OutOfDate,
        })
    }

    /// Takes the images of a swapchain for the output `name`, unless it has them.
    fn show_in(&mut self, swapchain: &Arc<SwapchainHandle>, name: &str) -> Result<(), Error> {
        let owner: Arc<dyn Any + Send + Sync> = swapchain.clone();
        if self.owners.iter().any(|(of, shown)| of == name && Arc::ptr_eq(shown, &owner)) {
            return Ok(());
        }
        let bad = |why: String| Error::BadResource { what: format!("`{name}` can't be shown: {why}") };
        let image = self.plan().images.iter().find(|image| *image.name == *name);
        let image = image.ok_or_else(|| bad("the Plan has no such image".to_owned()))?;
        if let Some(why) = swapchain.unfit(image) {
            return Err(bad(why));
        }
        let states = self.external_states(name).ok_or_else(|| bad("it doesn't leave the frame".to_owned()))?;
        if states.after.layout != ash::vk::ImageLayout::PRESENT_SRC_KHR {
            return Err(bad("the frame doesn't leave it as `Present`".to_owned()));
        }
        if states.before.layout != ash::vk::ImageLayout::UNDEFINED {
            return Err(bad("the frame needs its earlier contents".to_owned()));
        }
        // SAFETY: the images are as the Plan describes them and are kept as long as this executor may use them. Each is chosen
        // only when it is free.
        unsafe { self.import_images(name, &swapchain.images) }?;
        self.owners.retain(|(of, _)| of != name);
        self.owners.push((name.to_owned(), owner));
        Ok(())
    }
}
