//! The passes that a Plan takes to replace the contents of their attachments. Earlier contents of these attachments aren't loaded.
//!
//! `verify` asks the same by rules of its own.

use super::{Attachment, Pass, RenderScope};
use crate::frame::{Blend, Draw};
use crate::vulkan::{ColorComponents, CompareOp, StencilOp};

impl Pass {
    /// Whether a Plan takes the pass to set every texel of an attachment. `scope` is the rendering scope of the pass. An executor checks that
    /// the shader leaves no texel out.
    #[must_use]
    pub fn is_taken_to_cover(&self, scope: &RenderScope) -> bool {
        let untested = self.depth.is_none_or(|depth| depth.test == CompareOp::Always)
            && self.stencil.is_none_or(|stencil| stencil.test == CompareOp::Always);
        let leaves_out = self.discards || self.alpha_to_coverage || self.untouched.is_some();
        let fills = untested && !leaves_out && !self.raster.culls() && self.draw.is_some_and(Draw::is_full_screen);
        let draws_into = |target: &Attachment| {
            let to = (target.image, target.range);
            self.accesses.iter().any(|access| access.binding.is_none() && (access.image, access.range) == to)
        };
        let mut colors = scope.color().iter().enumerate().zip(&self.blend);
        let deep = self.depth.is_some_and(|depth| depth.write);
        let marks = self.stencil.is_some_and(|it| matches!(it.pass, StencilOp::Zero | StencilOp::Replace));
        scope.layers == 1
            && !self.raster.draws_nothing()
            && (self.covers || fills)
            && (untested && (deep || marks)
                || colors.any(|((at, target), blend)| {
                    let whole = *blend == Blend::Replace && self.write_mask(at) == ColorComponents::RGBA;
                    whole && draws_into(target)
                }))
    }
}
