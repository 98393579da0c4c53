//! Local reads: a pass that reads only the texel at its own position joins the rendering scope that drew it.
//!
//! Colour attachments with one sample can be read so. The passes of such a scope draw into different ones of its attachments.

use super::step::{Scope, Target};
use crate::compile::model::{AdaptedFrame, OpKind, Role, Use};
use crate::frame::{Frame, SampledImage};
use crate::vulkan::{AccessKind, Stages};

/// The entry of a use that samples only the texel at the fragment's own position.
pub(super) fn own_pixel<'f>(frame: &'f Frame, adapted: &AdaptedFrame, op: u32, used: &Use) -> Option<&'f SampledImage> {
    let OpKind::Draw(pass) = adapted.ops[op as usize].kind else { return None };
    if !used.role.is_sampled() {
        return None;
    }
    frame.passes[pass as usize].sampled.get(used.entry as usize).filter(|sampled| sampled.own_pixel)
}

/// Whether an operation samples an image only at its own pixel.
pub(super) fn has_own_pixel_reads(frame: &Frame, adapted: &AdaptedFrame, op: u32) -> bool {
    let OpKind::Draw(pass) = adapted.ops[op as usize].kind else { return false };
    frame.passes[pass as usize].sampled.iter().any(|sampled| sampled.own_pixel)
}

/// Whether a use can be a local read in a scope with these colour attachments.
pub(super) fn possible(frame: &Frame, adapted: &AdaptedFrame, op: u32, used: &Use, attached: &[Target]) -> bool {
    let target = Target::of(adapted, used);
    let once = || {
        let same = |other: &&Use| other.role.is_sampled() && Target::of(adapted, other) == target;
        adapted.uses(op).iter().filter(same).count() == 1
    };
    let obstacle = own_pixel(frame, adapted, op, used).map(|sampled| obstacle(adapted, sampled, used));
    obstacle == Some(None) && attached.contains(&target) && once()
}

/// Why a use can't be a local read on any device.
pub(super) fn obstacle(adapted: &AdaptedFrame, sampled: &SampledImage, used: &Use) -> Option<&'static str> {
    let image = adapted.resources[used.resource as usize].image()?;
    if image.format.is_depth() {
        Some("only colour is read from its scope")
    } else if image.samples > 1 {
        Some("it has several samples")
    } else if sampled.stages != Stages::FRAGMENT_SHADER {
        Some("not only the fragment shader reads it")
    } else if sampled.eye.is_some() {
        Some("it is one eye's part of it, whichever is drawn for")
    } else {
        None
    }
}

/// Turns uses, by index, into local reads.
pub(super) fn read_locally(uses: &mut [Use], local: &[u32]) {
    for index in local {
        let used = &mut uses[*index as usize];
        used.role = Role::Input;
        used.layout = AccessKind::InputAttachment.layout();
        used.stages = AccessKind::InputAttachment.stages();
        used.accesses = AccessKind::InputAttachment.accesses(true, false);
    }
}

impl Scope {
    /// Whether the colour attachments of a pass fit into the scope, next to those that it has.
    pub(super) fn colors_fit(&self, adapted: &AdaptedFrame, uses: &[Use], most: usize) -> bool {
        let colors = uses.iter().filter(|used| used.role.is_color());
        let mut new = 0;
        for used in colors {
            if !self.color.contains(&Target::of(adapted, used)) {
                new += 1;
                if self.overlaps(adapted, used) {
                    return false;
                }
            }
        }
        self.color.len() + new <= most
    }
}
