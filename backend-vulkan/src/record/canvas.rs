//! What a pass draws into: viewport and scissor of an eye's picture, and the draws that it takes to draw for both eyes at once.

use super::state::CommandState;
use crate::base::{convert, numbers};
use crate::gpu::Gpu;
use crate::prepare::{DrawTarget, Faces, scissor, viewport};
use ash::vk;
use framewright_graph::frame::{EyeForm, Stereo};
use framewright_graph::vulkan::{CullMode, FrontFace};
use std::ops::Range;

/// Set in the number of an instance that is the right eye's.
const RIGHT_EYE: u32 = 1 << 31;

/// What a pass draws into, and the state of the command buffer that belongs to it. Errors say what was misused.
pub(super) struct Canvas<'f> {
    pub(super) gpu: &'f Gpu,
    pub(super) commands: vk::CommandBuffer,
    pub(super) state: &'f mut CommandState,
    pub(super) target: &'f DrawTarget,
    faces: Faces,
    /// The rectangles of viewport and scissor, where they aren't all of the picture and each eye's half has its own.
    viewport: Option<[f64; 4]>,
    scissor: Option<[f64; 4]>,
}

impl<'f> Canvas<'f> {
    pub(super) fn new(
        gpu: &'f Gpu,
        commands: vk::CommandBuffer,
        state: &'f mut CommandState,
        target: &'f DrawTarget,
        faces: Faces,
    ) -> Canvas<'f> {
        Canvas { gpu, commands, state, target, faces, viewport: None, scissor: None }
    }

    /// Sets viewport and scissor to all of the picture, and what faces are as each pass finds it.
    pub(super) fn begin(&mut self) -> Result<(), String> {
        self.set_cull_mode(CullMode::None);
        self.set_front_face(FrontFace::CounterClockwise);
        self.record_scissor(self.target.scissor);
        self.record_viewport(self.target.viewport)
    }

    /// Says which faces are left out from now on, unless the pass says that.
    pub(super) fn set_cull_mode(&mut self, mode: CullMode) {
        let mode = self.faces.cull_mode.unwrap_or(mode);
        if !self.state.needs_cull_mode(mode) {
            return;
        }
        let mode = convert::cull_mode(mode);
        // SAFETY: the command buffer is being recorded, and the state is dynamic in every pipeline.
        unsafe { self.gpu.raw.cmd_set_cull_mode(self.commands, mode) };
    }

    /// Says which side is the front from now on, after the projection, which flips y. A pass may turn all faces over.
    pub(super) fn set_front_face(&mut self, face: FrontFace) {
        let face = if self.faces.turned_over { face.turned_over() } else { face };
        if !self.state.needs_front_face(face) {
            return;
        }
        let face = convert::front_face(face);
        // SAFETY: the command buffer is being recorded, and the state is dynamic in every pipeline.
        unsafe { self.gpu.raw.cmd_set_front_face(self.commands, face) };
    }

    /// Says to which rectangle of the upright picture clip space is stretched from now on.
    pub(super) fn set_viewport(&mut self, rectangle: [f64; 4]) -> Result<(), String> {
        self.viewport = self.other_than_all(rectangle);
        self.check_halves(self.viewport)?;
        self.see(rectangle, 0)
    }

    /// Says in which rectangle of the upright picture texels may change from now on.
    pub(super) fn set_scissor(&mut self, rectangle: [f64; 4]) -> Result<(), String> {
        self.scissor = self.other_than_all(rectangle);
        self.check_halves(self.scissor)?;
        self.cut(rectangle, 0);
        Ok(())
    }

    /// A rectangle that isn't all of one eye's picture, where both lie side by side.
    fn other_than_all(&self, rectangle: [f64; 4]) -> Option<[f64; 4]> {
        (self.target.halves() && rectangle != self.target.own()).then_some(rectangle)
    }

    /// Whether viewport or scissor can be as they are.
    fn check_halves(&self, rectangle: Option<[f64; 4]>) -> Result<(), String> {
        let instances = matches!(self.target.eyes, Some((Stereo::Instanced, EyeForm::Halves)));
        if rectangle.is_some() && instances {
            return Err("part of a picture while instances draw into both eyes' halves".to_owned());
        }
        Ok(())
    }

    /// Sets the viewport so that a rectangle of an eye's picture is seen.
    fn see(&mut self, rectangle: [f64; 4], eye: u32) -> Result<(), String> {
        self.record_viewport(viewport(self.target.turned(rectangle, eye)))
    }

    /// Sets the scissor to a rectangle of an eye's picture; where instances draw into both eyes' halves it is all of both.
    fn cut(&mut self, rectangle: [f64; 4], eye: u32) {
        self.record_scissor(scissor(self.target.turned(rectangle, eye)));
    }

    /// Sets the viewport to a rectangle of the turned picture, unless it is that.
    fn record_viewport(&mut self, rectangle: [f32; 4]) -> Result<(), String> {
        if !self.state.needs_viewport(rectangle) {
            return Ok(());
        }
        let [x, y, width, height] = rectangle;
        let [least, most] = self.gpu.limits.viewport_bounds_range;
        let [widest, highest] = self.gpu.limits.max_viewport_dimensions.map(f64::from);
        let inside = x >= least && y >= least && x + width <= most && y + height <= most;
        if !inside || f64::from(width) > widest || f64::from(height) > highest {
            return Err(format!("a viewport of {width}×{height} at {x}, {y}: more than the device has"));
        }
        let viewport = vk::Viewport { x, y, width, height, min_depth: 0.0, max_depth: 1.0 };
        // SAFETY: the command buffer is being recorded, the state is dynamic in every pipeline, and the numbers are in range.
        unsafe { self.gpu.raw.cmd_set_viewport(self.commands, 0, &[viewport]) };
        Ok(())
    }

    /// Sets the scissor to a rectangle of the turned picture, unless it is that.
    fn record_scissor(&mut self, rectangle: [u32; 4]) {
        if !self.state.needs_scissor(rectangle) {
            return;
        }
        let scissor = convert::rectangle(rectangle);
        // SAFETY: the command buffer is being recorded, the state is dynamic in every pipeline, and it lies within the target.
        unsafe { self.gpu.raw.cmd_set_scissor(self.commands, 0, &[scissor]) };
    }

    /// Records a draw of `instances` as often, and with as many, as it takes for both eyes.
    pub(super) fn for_eyes(
        &mut self,
        instances: Range<u32>,
        draw: impl Fn(&ash::Device, vk::CommandBuffer, u32, u32),
    ) -> Result<(), String> {
        let count = instances.end.saturating_sub(instances.start);
        let twice = |number: u32| number.checked_mul(2);
        let too_many = || format!("instances {} for both eyes", numbers(&instances));
        match self.target.eyes {
            None | Some((Stereo::Off | Stereo::MultiPass | Stereo::Multiview, _)) => {
                draw(&self.gpu.raw, self.commands, instances.start, count);
            }
            Some((Stereo::Instanced, _)) => {
                let (first, count) = twice(instances.start).zip(twice(count)).ok_or_else(too_many)?;
                draw(&self.gpu.raw, self.commands, first, count);
            }
            Some((Stereo::DoubleWide, _)) => {
                if instances.end > RIGHT_EYE {
                    return Err(too_many());
                }
                for eye in [0, 1] {
                    self.see(self.viewport.unwrap_or_else(|| self.target.own()), eye)?;
                    // A draw that reaches over the seam would fill the other eye's half.
                    self.cut(self.scissor.unwrap_or_else(|| self.target.own()), eye);
                    draw(&self.gpu.raw, self.commands, instances.start | (eye * RIGHT_EYE), count);
                }
            }
        }
        Ok(())
    }
}
