//! Where each eye's picture lies, for a program that draws both at once with pipelines of its own.

use crate::base::convert;
use crate::prepare::{DrawTarget, scissor, viewport};
use ash::vk;
use framewright_graph::frame::{Eye, EyeForm, Stereo};
use framewright_graph::plan::{Pass, Plan};

/// Where the picture of an eye lies in what a pass draws into.
#[derive(Debug, Clone, Copy)]
pub struct EyeTarget {
    /// Which eye.
    pub eye: Eye,
    /// The viewport of all of its picture: its half, or all of the attachments.
    pub viewport: vk::Viewport,
    /// The scissor of the same: what lies outside is the other eye's.
    pub scissor: vk::Rect2D,
    /// The layer of the attachments. With a view mask (`ScopeFormats::view_mask`) the device chooses it, and `gl_ViewIndex` is its number;
    /// without one, a vertex shader does so (`gl_Layer`).
    pub layer: u32,
}

/// The eye that a pass is drawn for, if it is drawn for one of two.
pub(super) fn eye_of(plan: &Plan, pass: &Pass) -> Option<Eye> {
    plan.views.get(pass.view?.0 as usize)?.eye.map(|of| of.eye)
}

impl EyeTarget {
    /// Those of both eyes, the left one first, if `target` holds both.
    pub(super) fn of_both(target: &DrawTarget) -> Option<[EyeTarget; 2]> {
        let (_, form) = target.eyes?;
        // Each half is one eye's, also where Framewright's own draws fill both with one.
        let target = match form {
            EyeForm::Halves => DrawTarget { eyes: Some((Stereo::DoubleWide, form)), ..*target },
            EyeForm::Layers => *target,
        };
        Some(Eye::BOTH.map(|eye| {
            let number = eye as u32;
            let (beside, layer) = match form {
                EyeForm::Halves => (number, 0),
                EyeForm::Layers => (0, number),
            };
            let all = target.turned(target.own(), beside);
            let ([x, y, width, height], scissor) = (viewport(all), scissor(all));
            let viewport = vk::Viewport { x, y, width, height, min_depth: 0.0, max_depth: 1.0 };
            EyeTarget { eye, viewport, scissor: convert::rectangle(scissor), layer }
        }))
    }
}
