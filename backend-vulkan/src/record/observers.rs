//! What is recorded beside a frame's commands, to learn of the frame.

use super::breadcrumbs::Breadcrumbs;
use super::fragments::FragmentCounts;
use super::pass_watch::PassWatch;
use super::timing::Timing;
use crate::base::Error;
use crate::prepare::Frame;
use ash::vk;
use framewright_graph::plan::Queue;

/// Observers of one frame in flight, each if it is asked for.
pub(crate) struct Observers {
    pub(crate) timing: Option<Timing>,
    pub(crate) fragments: Option<FragmentCounts>,
    pub(crate) breadcrumbs: Option<Breadcrumbs>,
    pub(crate) watch: Option<PassWatch>,
}

impl Observers {
    /// Begins a frame. The one before must have been waited for.
    pub(crate) fn begin_frame(&mut self) -> Result<(), Error> {
        if let Some(timing) = &mut self.timing {
            timing.begin_frame();
        }
        if let Some(fragments) = &mut self.fragments {
            fragments.begin_frame();
        }
        if let Some(watch) = &mut self.watch {
            watch.begin_frame();
        }
        self.breadcrumbs.as_mut().map_or(Ok(()), Breadcrumbs::begin_frame)
    }

    /// Begins the command buffer of a batch.
    pub(super) fn begin_batch(&mut self, commands: vk::CommandBuffer, queue: Queue) {
        if let Some(timing) = &mut self.timing {
            timing.begin_batch(commands, queue);
        }
        if let Some(fragments) = &mut self.fragments {
            fragments.begin_batch(commands, queue);
        }
    }

    /// Begins a step.
    pub(super) fn begin_step(&mut self, commands: vk::CommandBuffer, step: usize) {
        if let Some(breadcrumbs) = &self.breadcrumbs {
            breadcrumbs.begin_step(commands, step);
        }
    }

    /// Begins the work of a step, whose barriers were recorded.
    pub(super) fn begin_work(
        &mut self,
        frame: &Frame<'_>,
        commands: vk::CommandBuffer,
        step: usize,
    ) -> Result<(), Error> {
        self.watch.as_mut().map_or(Ok(()), |watch| watch.begin(frame, commands, step))
    }

    /// Whether a query is open in the command buffer that is being recorded, which secondary ones would have to inherit.
    pub(super) fn has_query(&self) -> bool {
        self.fragments.as_ref().is_some_and(FragmentCounts::is_open)
    }

    /// Ends the work of a step.
    pub(super) fn end_work(&mut self, frame: &Frame<'_>, commands: vk::CommandBuffer) {
        if let Some(watch) = &mut self.watch {
            watch.end(frame, commands);
        }
    }

    /// Ends a pass or a step.
    pub(super) fn stamp(&mut self, commands: vk::CommandBuffer) {
        if let Some(timing) = &mut self.timing {
            timing.stamp(commands);
        }
    }

    /// Ends the command buffer of a batch.
    pub(super) fn end_batch(&mut self, commands: vk::CommandBuffer) {
        if let Some(fragments) = &mut self.fragments {
            fragments.end_batch(commands);
        }
        if let Some(breadcrumbs) = &mut self.breadcrumbs {
            breadcrumbs.end_batch(commands);
        }
    }
}
