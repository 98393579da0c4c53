//! Where a pass draws: viewport and scissor of an eye's picture, and what it takes to draw for both eyes at once.

use super::Recorder;
use crate::prepare::{scissor, viewport};
use ash::vk;
use framewright_graph::frame::{EyeForm, Stereo};
use std::ops::Range;

/// Set in the number of an instance that is the right eye's.
const RIGHT_EYE: u32 = 1 << 31;

impl Recorder<'_> {
    /// How the pass draws for both eyes at once. Each draw of the recorder's own then draws for both eyes. Code that draws
    /// by [`Recorder::raw`] must do so itself. `None`: the pass draws for one eye, or into images that both eyes share.
    /// Width, height, viewport and scissor are those of one eye's picture.
    #[must_use]
    pub fn both_eyes(&self) -> Option<(Stereo, EyeForm)> {
        self.target.eyes
    }

    /// Says to which rectangle of the upright picture clip space is stretched from now on: its left and upper edge, then its
    /// width and height, in texels. At first it is all of the picture. Where instances draw into both eyes' halves it must be all
    /// of it.
    pub fn set_viewport(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
        let rectangle = [x, y, width, height];
        if !rectangle.into_iter().all(f64::is_finite) || width <= 0.0 || height <= 0.0 {
            return self.misused(|| format!("a viewport of {width}×{height} at {x}, {y}"));
        }
        self.viewport = self.other_than_all(rectangle);
        if self.may_differ_by_eye(self.viewport) {
            self.see(rectangle, 0);
        }
    }

    /// Says in which rectangle of the upright picture texels may change from now on: its left and upper edge, then its width
    /// and height, in texels. What lies outside the picture is left out. At first it is all of the picture. Where instances draw
    /// into both eyes' halves it must be all of it.
    pub fn set_scissor(&mut self, corner: [u32; 2], size: [u32; 2]) {
        let upright = self.extent();
        let begin = [0, 1].map(|axis| corner[axis].min(upright[axis]));
        let end = [0, 1].map(|axis| corner[axis].saturating_add(size[axis]).min(upright[axis]));
        let rectangle = [begin[0], begin[1], end[0] - begin[0], end[1] - begin[1]].map(f64::from);
        self.scissor = self.other_than_all(rectangle);
        if self.may_differ_by_eye(self.scissor) {
            self.cut(rectangle, 0);
        }
    }

    /// Sets viewport and scissor to all of the picture.
    pub(crate) fn see_all(&mut self) {
        self.record_viewport(self.target.viewport);
        self.record_scissor(self.target.scissor);
    }

    /// A rectangle that isn't all of one eye's picture, where both lie side by side.
    fn other_than_all(&self, rectangle: [f64; 4]) -> Option<[f64; 4]> {
        (self.target.halves() && rectangle != self.target.own()).then_some(rectangle)
    }

    /// Whether viewport or scissor can be as they are.
    fn may_differ_by_eye(&mut self, rectangle: Option<[f64; 4]>) -> bool {
        let instances = matches!(self.target.eyes, Some((Stereo::Instanced, EyeForm::Halves)));
        if rectangle.is_some() && instances {
            self.misused(|| "part of a picture while instances draw into both eyes' halves".to_owned());
        }
        rectangle.is_none() || !instances
    }

    /// Sets the viewport so that a rectangle of an eye's picture is seen.
    fn see(&mut self, rectangle: [f64; 4], eye: u32) {
        self.record_viewport(viewport(self.target.turned(rectangle, eye)));
    }

    /// Sets the scissor to a rectangle of an eye's picture; where instances draw into both eyes' halves it is all of both.
    fn cut(&mut self, rectangle: [f64; 4], eye: u32) {
        self.record_scissor(scissor(self.target.turned(rectangle, eye)));
    }

    /// Sets the viewport to a rectangle of the turned picture, unless it is that.
    fn record_viewport(&mut self, rectangle: [f32; 4]) {
        if !self.state.needs_viewport(rectangle) {
            return;
        }
        let [x, y, width, height] = rectangle;
        let [least, most] = self.gpu.limits.viewport_bounds_range;
        let [widest, highest] = self.gpu.limits.max_viewport_dimensions.map(f64::from);
        let inside = x >= least && y >= least && x + width <= most && y + height <= most;
        if !inside || f64::from(width) > widest || f64::from(height) > highest {
            return self.misused(|| format!("a viewport of {width}×{height} at {x}, {y}: more than the device has"));
        }
        let viewport = vk::Viewport { x, y, width, height, min_depth: 0.0, max_depth: 1.0 };
        // SAFETY: the command buffer is being recorded, the state is dynamic in every pipeline, and the numbers are in range.
        unsafe { self.gpu.raw.cmd_set_viewport(self.commands, 0, &[viewport]) };
    }

    /// Sets the scissor to a rectangle of the turned picture, unless it is that.
    fn record_scissor(&mut self, rectangle: [u32; 4]) {
        if !self.state.needs_scissor(rectangle) {
            return;
        }
        let [x, y, width, height] = rectangle;
        let offset = vk::Offset2D { x: x.cast_signed(), y: y.cast_signed() };
        let scissor = vk::Rect2D { offset, extent: vk::Extent2D { width, height } };
        // SAFETY: the command buffer is being recorded, the state is dynamic in every pipeline, and it lies within the target.
        unsafe { self.gpu.raw.cmd_set_scissor(self.commands, 0, &[scissor]) };
    }

    /// Records a draw of `instances` as often, and with as many, as it takes for both eyes.
    pub(super) fn for_eyes(&mut self, instances: Range<u32>, draw: impl Fn(&ash::Device, vk::CommandBuffer, u32, u32)) {
        let count = instances.end.saturating_sub(instances.start);
        let twice = |number: u32| number.checked_mul(2);
        match self.target.eyes {
            None | Some((Stereo::Off | Stereo::MultiPass | Stereo::Multiview, _)) => {
                draw(&self.gpu.raw, self.commands, instances.start, count);
            }
            Some((Stereo::Instanced, _)) => match (twice(instances.start), twice(count)) {
                (Some(first), Some(count)) => draw(&self.gpu.raw, self.commands, first, count),
                _ => self.misused(|| format!("instances {instances:?} for both eyes")),
            },
            Some((Stereo::DoubleWide, _)) => {
                if instances.end > RIGHT_EYE {
                    return self.misused(|| format!("instances {instances:?} for both eyes"));
                }
                for eye in [0, 1] {
                    self.see(self.viewport.unwrap_or_else(|| self.target.own()), eye);
                    // A draw that reaches over the seam would fill the other eye's half.
                    self.cut(self.scissor.unwrap_or_else(|| self.target.own()), eye);
                    draw(&self.gpu.raw, self.commands, instances.start | (eye * RIGHT_EYE), count);
                }
            }
        }
    }
}
