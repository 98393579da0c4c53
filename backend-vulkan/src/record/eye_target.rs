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

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::vulkan::Rotation;

    /// DO-12: in a turned picture the halves lie where the turned upright ones do, and fill what is made for both.
    #[test]
    fn do_12_halves_of_turned_pictures_are_each_eyes_own() {
        let sides = |rotation, extent: [u32; 2]| {
            // Instances draw into both halves by one viewport, and yet each half is one eye's.
            let eyes = Some((Stereo::Instanced, EyeForm::Halves));
            let target = DrawTarget { extent, rotation, eyes, viewport: [0.0; 4], scissor: [0; 4] };
            let targets = EyeTarget::of_both(&target).expect("it is for both");
            assert_eq!(targets.map(|it| (it.eye, it.layer)), [(Eye::Left, 0), (Eye::Right, 0)]);
            targets.map(|EyeTarget { viewport, scissor: vk::Rect2D { offset, extent }, .. }| {
                assert_eq!([viewport.x, viewport.y], [offset.x as f32, offset.y as f32]);
                assert_eq!([viewport.width, viewport.height], [extent.width as f32, extent.height as f32]);
                (offset.x, offset.y, extent.width, extent.height)
            })
        };
        assert_eq!(sides(Rotation::Identity, [8, 4]), [(0, 0, 8, 4), (8, 0, 8, 4)]);
        assert_eq!(sides(Rotation::Rotate90, [4, 8]), [(0, 0, 4, 8), (0, 8, 4, 8)]);
        assert_eq!(sides(Rotation::Rotate180, [8, 4]), [(8, 0, 8, 4), (0, 0, 8, 4)]);
        assert_eq!(sides(Rotation::Rotate270, [4, 8]), [(0, 8, 4, 8), (0, 0, 4, 8)]);
    }
}
