//! The state of a command buffer: what is set already isn't set again.

use ash::vk;
use framewright_graph::vulkan::{CullMode, FrontFace};

/// Pipelines and dynamic state that a command buffer was given so far. Dynamic state outlasts pipelines and scopes, since it is
/// dynamic in every pipeline.
#[derive(Default)]
pub(crate) struct CommandState {
    /// Whether the program has recorded commands of its own, after which nothing is known.
    unknown: bool,
    graphics: Option<vk::Pipeline>,
    compute: Option<vk::Pipeline>,
    viewport: Option<[f32; 4]>,
    scissor: Option<[u32; 4]>,
    cull_mode: Option<CullMode>,
    front_face: Option<FrontFace>,
}

impl CommandState {
    /// Nothing is set in a new command buffer.
    pub(super) fn begin_commands(&mut self) {
        *self = CommandState::default();
    }

    /// Forgets what the program's own commands may have changed. It recorded them before this pass.
    pub(super) fn begin_pass(&mut self) {
        if self.unknown {
            *self = CommandState::default();
        }
    }

    /// The program may record commands of its own until the pass ends.
    pub(super) fn lose_track(&mut self) {
        self.unknown = true;
    }

    /// Whether the graphics pipeline must be bound. It counts as bound from now on. The methods below answer in the same way.
    pub(super) fn needs_graphics(&mut self, pipeline: vk::Pipeline) -> bool {
        self.graphics.replace(pipeline) != Some(pipeline) || self.unknown
    }

    pub(super) fn needs_compute(&mut self, pipeline: vk::Pipeline) -> bool {
        self.compute.replace(pipeline) != Some(pipeline) || self.unknown
    }

    pub(super) fn needs_viewport(&mut self, rectangle: [f32; 4]) -> bool {
        self.viewport.replace(rectangle) != Some(rectangle) || self.unknown
    }

    pub(super) fn needs_scissor(&mut self, rectangle: [u32; 4]) -> bool {
        self.scissor.replace(rectangle) != Some(rectangle) || self.unknown
    }

    pub(super) fn needs_cull_mode(&mut self, mode: CullMode) -> bool {
        self.cull_mode.replace(mode) != Some(mode) || self.unknown
    }

    pub(super) fn needs_front_face(&mut self, face: FrontFace) -> bool {
        self.front_face.replace(face) != Some(face) || self.unknown
    }
}
