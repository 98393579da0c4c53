//! A frame among the program's own work: the semaphores that it waits for and signals, which of the program's images it uses, and
//! the states in which it finds and leaves them.

use crate::base::convert;
use ash::vk;
use framewright_graph::vulkan::State;

/// A semaphore of the program's, and stages that wait for it or that it waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SemaphorePoint {
    /// A binary semaphore or a timeline semaphore.
    pub semaphore: vk::Semaphore,
    /// The value of a timeline semaphore. It means nothing for a binary one.
    pub value: u64,
    /// The stages of the frame that wait, or that must be over before it is signalled.
    pub stages: vk::PipelineStageFlags2,
}

/// What a frame has to do with the program's own work. The default: nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Submission<'s> {
    /// The images and buffers that the frame uses: the name of an external one, and a number among those that
    /// [`import_images`](crate::Executor::import_images) or [`import_buffers`](crate::Executor::import_buffers) took for it. An image that
    /// isn't listed is the one of the frame before; a buffer is the one whose turn it is.
    pub images: &'s [(&'s str, usize)],
    /// What the frame waits for before it begins.
    pub waits: &'s [SemaphorePoint],
    /// What it signals at its end.
    pub signals: &'s [SemaphorePoint],
}

/// The states of an external image or buffer, in Vulkan's words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExternalStates {
    /// The state in which each frame finds it.
    pub before: ResourceState,
    /// The state in which each frame leaves it.
    pub after: ResourceState,
}

/// The state of an image or buffer: the stages and accesses that used it last, or that use it next, and the layout of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResourceState {
    /// Stages; none: no command before, or none after without a semaphore between.
    pub stages: vk::PipelineStageFlags2,
    /// Accesses.
    pub accesses: vk::AccessFlags2,
    /// The layout of an image; `UNDEFINED` for a buffer, and for an image whose contents the frame doesn't need.
    pub layout: vk::ImageLayout,
}

impl SemaphorePoint {
    /// A binary semaphore, for all stages.
    #[must_use]
    pub fn binary(semaphore: vk::Semaphore) -> SemaphorePoint {
        SemaphorePoint::timeline(semaphore, 0)
    }

    /// A timeline semaphore at a value, for all stages.
    #[must_use]
    pub fn timeline(semaphore: vk::Semaphore, value: u64) -> SemaphorePoint {
        SemaphorePoint { semaphore, value, stages: vk::PipelineStageFlags2::ALL_COMMANDS }
    }

    pub(super) fn info(&self) -> vk::SemaphoreSubmitInfo<'static> {
        let SemaphorePoint { semaphore, value, stages } = *self;
        vk::SemaphoreSubmitInfo::default().semaphore(semaphore).value(value).stage_mask(stages)
    }
}

impl ResourceState {
    pub(super) fn of(state: State) -> ResourceState {
        ResourceState {
            stages: convert::stages(state.stages),
            accesses: convert::accesses(state.accesses),
            layout: convert::layout(state.layout),
        }
    }
}
