//! Which part of an image a frame uses.

use super::{Access, BindingKind, Image, Pass, Plan};
use crate::frame::{EyeForm, allocated_extent, level_extent};
use crate::vulkan::extent_at;
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

    /// Width, height and depth of a mip level in texels where the image is used as far as `extent`, which is [`Image::extent`] or what
    /// it was in an earlier frame.
    #[must_use]
    pub fn level(&self, extent: [u32; 3], mip: u32) -> [u32; 3] {
        level_extent(extent, self.allocated, mip)
    }

    /// Where the part in use of a mip level, of two eyes the left one's, lies among all of the level of the upright image: its width
    /// and height as shares, and where it begins; the right eye's begins where it ends. A place in the part, 0 to 1 from its upper
    /// left corner, is `place * [0..2] + [2..4]` in the level. The image is used as far as `extent`: see [`Image::level`].
    #[must_use]
    pub fn part(&self, extent: [u32; 3], mip: u32) -> [f32; 4] {
        #[allow(clippy::cast_possible_truncation, reason = "shaders calculate with as many bits")]
        let share = |used: u32, all: u32| (f64::from(used) / f64::from(all)) as f32;
        let ([width, height, _], [wide, high, _]) = (self.level(extent, mip), extent_at(self.made(), mip));
        [share(width, wide), share(height, high), 0.0, 0.0]
    }
}

impl Plan {
    /// Images that the pass's shader sees and that may be used in part: the shader's names, in the order of the push constants, and
    /// the accesses.
    pub fn parts<'p>(&'p self, pass: &'p Pass) -> impl Iterator<Item = (&'p Arc<str>, &'p Access)> {
        pass.accesses.iter().filter_map(|access| {
            let binding = access.binding.as_ref().filter(|it| it.kind != BindingKind::InputAttachment)?;
            self.image(access.image).allocated.map(|_| (&binding.name, access))
        })
    }
}
