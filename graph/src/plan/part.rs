//! Which part of an image a frame uses.

use super::{BindingKind, Image, Pass, Plan};
use crate::frame::{EyeForm, allocated_extent};
use std::sync::Arc;

impl Image {
    /// Width, height and depth that it is made with.
    #[must_use]
    pub fn made(&self) -> [u32; 3] {
        EyeForm::extent(self.eyes, allocated_extent(self.extent, self.allocated), self.rotation)
    }

    /// Array layers that it is made with.
    #[must_use]
    pub fn made_layers(&self) -> u32 {
        EyeForm::layers(self.eyes, self.layers)
    }

    /// Where the part in use, of two eyes the left one's, lies among all of the upright image: its width and height as shares,
    /// and where it begins; the right eye's begins where it ends. A place in the part, 0 to 1 from its upper left corner, is
    /// `place * [0..2] + [2..4]` in the image.
    #[must_use]
    pub fn part(&self) -> [f32; 4] {
        #[allow(clippy::cast_possible_truncation, reason = "shaders calculate with as many bits")]
        let share = |used: u32, all: u32| (f64::from(used) / f64::from(all)) as f32;
        let [width, height, _] = self.made();
        [share(self.extent[0], width), share(self.extent[1], height), 0.0, 0.0]
    }
}

impl Plan {
    /// Sampled images of the pass that may be used in part: the shader's names, in the order of the push constants, and
    /// [`Image::part`] of each.
    pub fn parts<'p>(&'p self, pass: &'p Pass) -> impl Iterator<Item = (&'p Arc<str>, [f32; 4])> {
        pass.accesses.iter().filter_map(|access| {
            let binding = access.binding.as_ref().filter(|it| matches!(it.kind, BindingKind::Sampled(_)))?;
            let image = self.image(access.image);
            image.allocated.map(|_| (&binding.name, image.part()))
        })
    }
}
