//! Which draws keep the contents of their targets, and which replace every texel, so that earlier contents don't matter.

use super::{Blend, ColorTarget, DepthTarget, Draw, Image, Pass, StencilState, Work};
use crate::vulkan::{Aspects, CompareOp, StencilOp, Subresources};

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

    /// Whether the draw into `target`, a part of `image`, replaces every texel.
    fn covers_color(&self, target: &ColorTarget, image: &Image) -> bool {
        target.blend == Blend::Replace && self.reaches_every_texel(image, target.range)
    }

    /// Whether the draw into one plane of `target`, a part of `image`, replaces every texel.
    fn covers_plane(&self, target: &DepthTarget, plane: Aspects, image: &Image) -> bool {
        let sets = |stencil: StencilState| matches!(stencil.pass, StencilOp::Replace | StencilOp::Zero);
        let written = if plane == Aspects::STENCIL { target.stencil.is_some_and(sets) } else { target.write };
        written && self.reaches_every_texel(image, target.range)
    }

    /// Whether it draws a fragment that passes all tests at every sample. A triangle reaches only one of several layers.
    fn reaches_every_texel(&self, image: &Image, range: Subresources) -> bool {
        let full_screen = matches!(self.work, Work::Draw { draw: Draw::FullScreen, discards: false, .. });
        let passes = |depth: &DepthTarget| {
            depth.test == CompareOp::Always && depth.stencil.is_none_or(|stencil| stencil.test == CompareOp::Always)
        };
        full_screen
            && !self.alpha_to_coverage
            && image.part(range).layers == 1
            && self.depth.as_ref().is_none_or(passes)
    }
}
