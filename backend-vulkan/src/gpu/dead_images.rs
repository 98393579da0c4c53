//! News of images that died, for programs that keep views of them.

use ash::vk;
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// The images that died since they were asked for last.
type Dead = Mutex<Vec<vk::Image>>;

/// Tells which images of a device died. A program that keeps views of images that it was told, by
/// [`Recorder::image`](crate::Recorder::image) and the like, destroys those views then: another image may be made in the place of a
/// dead one, and have the same handle.
#[derive(Debug)]
pub struct DeadImages(Arc<Dead>);

/// All who follow the images of a device.
#[derive(Default)]
pub(crate) struct Followers(Mutex<Vec<Weak<Dead>>>);

impl DeadImages {
    /// The images that were destroyed since the last call, or since this was made. No commands that use them, or views of them, are on
    /// their way any more, but for those that the program submitted by itself.
    ///
    /// Call it in the code that records a pass, before a view is looked up by its image. A new image may have the handle of one that
    /// died between frames.
    #[must_use]
    pub fn take(&self) -> Vec<vk::Image> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Followers {
    pub(super) fn add(&self) -> DeadImages {
        let dead = Arc::<Dead>::default();
        let mut followers = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        followers.retain(|follower| follower.strong_count() > 0);
        followers.push(Arc::downgrade(&dead));
        DeadImages(dead)
    }

    /// Tells all that an image dies now.
    pub(crate) fn tell(&self, image: vk::Image) {
        let followers = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        for dead in followers.iter().filter_map(Weak::upgrade) {
            dead.lock().unwrap_or_else(PoisonError::into_inner).push(image);
        }
    }
}
