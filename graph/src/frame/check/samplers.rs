//! How a pass samples its images: what no device does with an image of their format.

use super::CheckContext;
use crate::base::{Code, Diagnostic};
use crate::frame::Pass;
use crate::vulkan::{Aspects, Format};

/// Reports images that no device samples as the pass says.
#[inline]
pub(crate) fn check(context: &impl CheckContext, pass: &Pass, errors: &mut Vec<Diagnostic>) {
    for sampled in &pass.sampled {
        let Some(image) = context.image(sampled.image) else { continue };
        // A stencil is read as integers.
        let stencil = sampled.range.aspects == Aspects::STENCIL;
        let format = if stencil { Format::R8_UINT } else { image.format };
        if let Some(mistake) = sampled.sampler.mistake(format) {
            let message = format!("pass `{}` can't sample `{}` so: {mistake}", pass.name, sampled.binding);
            errors.push(Diagnostic::new(Code::SAMPLER_UNFIT, sampled.span, message));
        }
    }
}
