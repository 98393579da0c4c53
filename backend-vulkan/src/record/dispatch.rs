//! How a draw source binds its sets for a compute pass.

use super::bound_sets::BoundSets;
use super::eye_target::eye_of;
use super::frame_resources::HeldResources;
use crate::prepare::{Frame, SuppliedSets};
use crate::resources::{BindGroup, RawSet};
use ash::vk;
use framewright_graph::frame::Eye;
use framewright_graph::plan;

/// Binds what the draw source brings along to one compute pass. The Plan says how many workgroups are dispatched afterwards.
///
/// No method fails at once: the first misuse is kept, what follows is ignored, and [`crate::Executor::frame`] returns it
/// as [`crate::Error::Recording`].
pub struct DispatchRecorder<'f> {
    commands: vk::CommandBuffer,
    sets: BoundSets<'f>,
    plan: &'f plan::Pass,
    frame: &'f Frame<'f>,
    misuse: Option<String>,
}

impl<'f> DispatchRecorder<'f> {
    pub(super) fn new(
        commands: vk::CommandBuffer,
        supplied: &'f SuppliedSets,
        held: &'f mut HeldResources,
        (plan, frame): (&'f plan::Pass, &'f Frame<'f>),
    ) -> DispatchRecorder<'f> {
        let sets = BoundSets::new(frame.gpu, vk::PipelineBindPoint::COMPUTE, supplied, held, frame.sets);
        DispatchRecorder { commands, sets, plan, frame, misuse: None }
    }

    /// The pass's name.
    #[must_use]
    pub fn pass(&self) -> &str {
        &self.plan.name
    }

    /// The view that the pass works for, in the list of the Plan; `None` if the Plan has none. A compute pass never works for both
    /// eyes at once: its view is that of one eye, or that of both if nothing that it touches is an eye's own.
    #[must_use]
    pub fn view(&self) -> Option<plan::ViewId> {
        self.plan.view
    }

    /// The eye that the pass works for; `None`: there is one, or it works for what both share.
    #[must_use]
    pub fn eye(&self) -> Option<Eye> {
        eye_of(self.frame.plan, self.plan)
    }

    /// The name of the pass's shader.
    #[must_use]
    pub fn shader(&self) -> &str {
        &self.plan.shader
    }

    /// The number of the frame, as [`Executor::submit`](crate::Executor::submit) returns it.
    #[must_use]
    pub fn frame(&self) -> u64 {
        self.frame.told
    }

    /// Binds a group to the set number `set`, from 1 on.
    pub fn bind_group(&mut self, set: u32, group: &BindGroup) {
        if self.misuse.is_none() {
            self.misuse = self.sets.bind(self.commands, set, group).err();
        }
    }

    /// Binds a set that the program makes itself to its number, with its dynamic offsets. One that the pass's shader doesn't read is left
    /// out. What [`crate::Executor::bind_set`] bound is bound already.
    pub fn bind_set(&mut self, number: u32, set: RawSet, offsets: &[u32]) {
        if self.misuse.is_none() {
            self.misuse = self.sets.bind_raw(self.commands, number, set, offsets).err();
        }
    }

    /// The first misuse if there was any. That a set is missing is one.
    pub(super) fn finish(self) -> Result<(), String> {
        let missing = self.sets.missing().map(|set| format!("a dispatch without {set}"));
        self.misuse.or(missing).map_or(Ok(()), Err)
    }
}
