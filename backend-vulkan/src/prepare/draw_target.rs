//! The picture that a pass draws into, and where its rectangles lie in the attachments.

use framewright_graph::frame::{EyeForm, Stereo};
use framewright_graph::vulkan::Rotation;

/// The picture that a pass draws into.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DrawTarget {
    /// Width and height, those of the turned picture; of two eyes one's.
    pub(crate) extent: [u32; 2],
    pub(crate) rotation: Rotation,
    /// How both eyes are drawn for at once, and into what, if they are.
    pub(crate) eyes: Option<(Stereo, EyeForm)>,
    /// The viewport of all of the upright picture: left and upper edge, width and height in the attachments.
    pub(crate) viewport: [f32; 4],
    /// The scissor of the same.
    pub(crate) scissor: [u32; 4],
}

impl DrawTarget {
    pub(super) fn new(extent: [u32; 2], rotation: Rotation, eyes: Option<(Stereo, EyeForm)>) -> DrawTarget {
        let target = DrawTarget { extent, rotation, eyes, viewport: [0.0; 4], scissor: [0; 4] };
        let all = target.turned(target.own(), 0);
        DrawTarget { viewport: viewport(all), scissor: scissor(all), ..target }
    }

    /// Whether it draws into both eyes' halves.
    pub(crate) fn halves(&self) -> bool {
        matches!(self.eyes, Some((_, EyeForm::Halves)))
    }

    /// Width and height of the upright picture.
    pub(crate) fn upright(&self) -> [u32; 2] {
        self.rotation.extent(self.extent)
    }

    /// All of one eye's upright picture.
    pub(crate) fn own(&self) -> [f64; 4] {
        let [width, height] = self.upright().map(f64::from);
        [0.0, 0.0, width, height]
    }

    /// Where a rectangle of an eye's upright picture lies in the turned one.
    pub(crate) fn turned(&self, [x, y, width, height]: [f64; 4], eye: u32) -> [f64; 4] {
        let [own_width, own_height] = self.upright().map(f64::from);
        let rectangle = match self.eyes {
            // Vertices are put in one half of clip space.
            Some((Stereo::Instanced, EyeForm::Halves)) => [x, y, 2.0 * width, height],
            _ => [x + f64::from(eye) * own_width, y, width, height],
        };
        let all = [if self.halves() { 2.0 * own_width } else { own_width }, own_height];
        self.rotation.rectangle(all, rectangle)
    }
}

/// The viewport of a rectangle of the turned picture.
#[allow(clippy::cast_possible_truncation, reason = "viewports are 32-bit floats")]
pub(crate) fn viewport(rectangle: [f64; 4]) -> [f32; 4] {
    rectangle.map(|side| side as f32)
}

/// The scissor of a rectangle of the turned picture.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole numbers within the picture")]
pub(crate) fn scissor(rectangle: [f64; 4]) -> [u32; 4] {
    rectangle.map(|side| side as u32)
}
