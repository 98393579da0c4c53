//! Frames of a Plan that are shown in a window.

use super::handle::SwapchainHandle;
use super::swapchain::{PresentOutcome, Swapchain};
use crate::base::{Error, convert};
use crate::execute::{Executor, SemaphorePoint, Submission};
use crate::record::DrawSource;
use ash::vk;
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

/// A frame that is drawn over another one before that is shown, such as a list of settings or times. The frame below, what it leaves
/// and its times stay as they are.
pub struct Overlay<'o> {
    /// Draws the frame. The Plan must find and leave the image as `Present`, and be made with the swapchain's format, size and rotation.
    pub executor: &'o mut Executor,
    /// Draws what the Plan has no shaders for.
    pub source: &'o mut dyn DrawSource,
    /// The image that is shown.
    pub name: &'o str,
}

impl Executor {
    /// Draws a frame into the next image of a window, and has it shown. `name` is the output that is shown: the frame must have been
    /// made with the swapchain's format, size and rotation, and leave it as `Present`.
    ///
    /// Nothing is waited for but a free image, and the oldest frame on its way if as many are as may be.
    ///
    /// # Errors
    /// Those of [`Executor::submit`]; [`Error::BadResource`] if there is no such output, or the window's images are none for it or of
    /// another device; [`Error::SurfaceLost`]; [`Error::Timeout`] if no image becomes free.
    pub fn present(
        &mut self,
        source: &mut dyn DrawSource,
        swapchain: &mut Swapchain,
        name: &str,
    ) -> Result<Presentation, Error> {
        self.present_below(source, swapchain, name, None)
    }

    /// Does the same, and draws a frame of another executor over it first.
    ///
    /// # Errors
    /// Those of [`Executor::present`], of both executors.
    pub fn present_with_overlay(
        &mut self,
        source: &mut dyn DrawSource,
        swapchain: &mut Swapchain,
        name: &str,
        overlay: Overlay<'_>,
    ) -> Result<Presentation, Error> {
        self.present_below(source, swapchain, name, Some(overlay))
    }

    fn present_below(
        &mut self,
        source: &mut dyn DrawSource,
        swapchain: &mut Swapchain,
        name: &str,
        mut overlay: Option<Overlay<'_>>,
    ) -> Result<Presentation, Error> {
        let over = overlay.as_ref().map_or(vk::ImageUsageFlags::empty(), |over| over.executor.usage_of(over.name));
        let as_before = swapchain.allow(self.usage_of(name) | over)?;
        let Some(current) = swapchain.current().cloned() else { return Ok(Presentation::NoArea) };
        if !as_before {
            return Ok(Presentation::OutOfDate);
        }
        self.show_in(&current, name, vk::ImageLayout::UNDEFINED)?;
        self.make_room()?;
        if let Some(Overlay { executor, name, .. }) = &mut overlay {
            executor.show_in(&current, name, vk::ImageLayout::PRESENT_SRC_KHR)?;
            executor.make_room()?;
        }
        let Some(image) = swapchain.acquire()? else { return Ok(Presentation::OutOfDate) };
        let (done, value) = image.done;
        let number = image.number as usize;
        let (done, drawn) = (SemaphorePoint::timeline(done, value), SemaphorePoint::binary(image.drawn));
        // Under an overlay the image isn't drawn yet when the frame is done.
        let signals: &[SemaphorePoint] = if overlay.is_some() { &[done] } else { &[done, drawn] };
        let waits = [SemaphorePoint::binary(image.free)];
        let among = Submission { images: &[(name, number)], waits: &waits, signals };
        // SAFETY: the semaphores are the swapchain's and nothing else uses them meanwhile, and the image is free when the wait is
        // over. The swapchain lives until this executor's frames are done.
        let submitted = unsafe { self.submit_with(source, &among) };
        let frame = submitted.inspect_err(|_| swapchain.give_up())?;
        if let Some(Overlay { executor, source, name }) = overlay {
            let among = Submission { images: &[(name, number)], waits: &[done], signals: &[drawn] };
            // SAFETY: as above; when the wait is over the frame below has left the image as `Present`.
            let submitted = unsafe { executor.submit_with(source, &among) };
            submitted.inspect_err(|_| swapchain.give_up())?;
        }
        Ok(match swapchain.show(&image)? {
            PresentOutcome::Right => Presentation::Shown(frame),
            PresentOutcome::Suboptimal => Presentation::Suboptimal(frame),
            PresentOutcome::OutOfDate => Presentation::OutOfDate,
        })
    }

    /// How the Plan uses the image `name`.
    fn usage_of(&self, name: &str) -> vk::ImageUsageFlags {
        let image = self.plan().images.iter().find(|image| *image.name == *name);
        image.map_or(vk::ImageUsageFlags::empty(), |image| convert::usage(image.usage))
    }

    /// Takes the images of a swapchain for the output `name`, unless it has them. The frame finds them in the layout `found`.
    fn show_in(&mut self, swapchain: &Arc<SwapchainHandle>, name: &str, found: vk::ImageLayout) -> Result<(), Error> {
        let bad = |why: &str| Error::BadResource { what: format!("`{name}` can't be shown: {why}") };
        if !Arc::ptr_eq(&self.gpu, &swapchain.gpu) {
            return Err(bad("the window belongs to another device"));
        }
        let image = self.plan().images.iter().find(|image| *image.name == *name);
        let image = image.ok_or_else(|| bad("the Plan has no such image"))?;
        if let Some(why) = swapchain.unfit(image) {
            return Err(bad(&why));
        }
        let states = self.external_states(name).ok_or_else(|| bad("it doesn't leave the frame"))?;
        if states.after.layout != vk::ImageLayout::PRESENT_SRC_KHR {
            return Err(bad("the frame doesn't leave it as `Present`"));
        }
        if states.before.layout != found {
            return Err(bad(match found {
                vk::ImageLayout::UNDEFINED => "the frame needs its earlier contents",
                _ => "the frame doesn't find it as `Present`",
            }));
        }
        // Last: an executor that has the images may have got them below an overlay, or as one.
        let owner: Arc<dyn Any + Send + Sync> = swapchain.clone();
        if self.owners.iter().any(|(of, shown)| of == name && Arc::ptr_eq(shown, &owner)) {
            return Ok(());
        }
        // SAFETY: the images are as the Plan describes them and are kept as long as this executor may use them. Each is chosen
        // only when it is free.
        unsafe { self.import_images(name, &swapchain.images) }?;
        self.owners.push((name.to_owned(), owner));
        Ok(())
    }
}
