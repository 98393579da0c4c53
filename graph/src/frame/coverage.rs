//! Which draws keep the contents of their targets, and which replace every texel, so that earlier contents don't matter. All that
//! depends on it asks here: `expand/shader/coverage.rs` finds out what a shader may leave as it was.

use super::{Blend, ColorTarget, DepthTarget, Draw, Frame, Image, ImageIndex, Pass, Resource, StencilState, Work};
use crate::vulkan::{Aspects, ColorComponents, CompareOp, StencilOp, Subresources};
use std::sync::Arc;

impl Pass {
    /// Whether `target`, a part of `image`, needs its earlier contents: it is neither cleared nor covered.
    pub(crate) fn keeps_color(&self, target: &ColorTarget, image: &Image) -> bool {
        target.clear.is_none() && !self.covers_color(target, image)
    }

    /// Whether one plane of `target`, a part of `image`, needs its earlier contents.
    pub(crate) fn keeps_plane(&self, target: &DepthTarget, plane: Aspects, image: &Image) -> bool {
        let clears = match plane == Aspects::STENCIL {
            true => target.stencil.is_some_and(|stencil| stencil.clear.is_some()),
            false => target.clear.is_some(),
        };
        !clears && !self.covers_plane(target, plane, image)
    }

    /// Why the draw into `target`, a part of `image`, may leave texels as they were, if it would replace every one otherwise.
    pub(crate) fn untouched_color(&self, target: &ColorTarget, image: &Image) -> Option<&Arc<str>> {
        self.untouched.as_ref().filter(|_| target.replaces(image) && self.fills(image, target.range))
    }

    /// The same of one plane of `target`.
    pub(crate) fn untouched_plane(&self, target: &DepthTarget, plane: Aspects, image: &Image) -> Option<&Arc<str>> {
        self.untouched.as_ref().filter(|_| target.replaces(plane) && self.fills(image, target.range))
    }

    /// Whether the draw into `target`, a part of `image`, replaces every texel.
    fn covers_color(&self, target: &ColorTarget, image: &Image) -> bool {
        target.replaces(image) && self.reaches_every_texel(image, target.range)
    }

    /// Whether the draw into one plane of `target`, a part of `image`, replaces every texel.
    fn covers_plane(&self, target: &DepthTarget, plane: Aspects, image: &Image) -> bool {
        target.replaces(plane) && self.reaches_every_texel(image, target.range)
    }

    /// Whether it draws a fragment that passes all tests at every sample, or is promised to.
    fn reaches_every_texel(&self, image: &Image, range: Subresources) -> bool {
        let leaves_out = self.work.discards() || self.alpha_to_coverage || self.untouched.is_some();
        // Which face a full-screen triangle shows isn't known of every shader, so that any culling may leave it out.
        let drawn = !leaves_out && !self.raster.culls() && self.fills(image, range);
        !self.raster.draws_nothing() && (self.covers && image.part(range).layers == 1 || drawn)
    }

    /// Whether it draws over a part of `image`, and no test fails. A triangle reaches only one of several layers.
    fn fills(&self, image: &Image, range: Subresources) -> bool {
        let passes = self.depth.as_ref().is_none_or(DepthTarget::passes);
        passes && self.work.draws(Draw::is_full_screen) && image.part(range).layers == 1
    }
}

impl Frame {
    /// The words of the file by which the pass `pass` promises to set all that it writes of `image`, if it is believed by them.
    #[must_use]
    pub fn promise(&self, pass: &str, image: &str) -> Option<&'static str> {
        let at = self.passes.iter().position(|it| *it.name == *pass)?;
        let (earlier, pass) = (&self.passes[..at], &self.passes[at]);
        let index = ImageIndex(u32::try_from(self.images.iter().position(|it| *it.name == *image)?).ok()?);
        let of = Resource::Image(index);
        let writes = |pass: &Pass| {
            pass.accesses().any(|it| it.resource() == of && it.writes(pass, self.images.get(index.0 as usize)))
        };
        let held = || self.images[index.0 as usize].lifetime.has_contents(of) || earlier.iter().any(writes);
        if pass.covers && pass.attachments().any(|(target, _)| target == index) {
            Some("covers: true")
        } else if pass.storage.iter().any(|it| it.image == index && it.write && !it.read) && held() {
            Some("access: Write")
        } else if matches!(pass.work, Work::Custom { .. })
            && pass.transfers.iter().any(|it| it.write && it.resource == of)
            // What it reads too may stay as it is in part.
            && !pass.transfers.iter().any(|it| !it.write && (it.resource, it.frames_ago) == (of, 0))
        {
            Some("writes")
        } else {
            None
        }
    }
}

impl ColorTarget {
    /// Whether fragments set all channels of `image`, and nothing of the old ones goes into them.
    fn replaces(&self, image: &Image) -> bool {
        self.blend == Blend::Replace && self.write_mask.contains(ColorComponents::first(image.format.components()))
    }
}

impl DepthTarget {
    /// Whether fragments set all bits of a plane. A test reads the planes, whatever a pass promises.
    fn replaces(&self, plane: Aspects) -> bool {
        let sets = |stencil: StencilState| matches!(stencil.pass, StencilOp::Replace | StencilOp::Zero);
        let written = if plane == Aspects::STENCIL { self.stencil.is_some_and(sets) } else { self.write };
        written && self.passes()
    }

    /// Whether fragments pass all its tests.
    fn passes(&self) -> bool {
        self.test == CompareOp::Always && self.stencil.is_none_or(|stencil| stencil.test == CompareOp::Always)
    }
}
