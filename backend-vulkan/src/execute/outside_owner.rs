//! Images and buffers of the program's that somebody outside of the device has between frames: each frame takes them over, and gives
//! them back.

use super::executor::Executor;
use super::import::Import;
use crate::base::{Error, convert};
use crate::prepare::Frame;
use ash::vk;
use framewright_graph::plan::{Resource, StepId};
use framewright_graph::vulkan::{Layout, Sharing, State, Subresources};

/// Who has an image or buffer of the program's between frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum OutsideOwner {
    /// Another device of Vulkan, of the same driver: its memory was handed over as an opaque one (`VK_QUEUE_FAMILY_EXTERNAL`).
    External,
    /// Anything else, as a camera, a decoder or a compositor that shares a DMA-BUF (`VK_QUEUE_FAMILY_FOREIGN_EXT`). The device must have
    /// `VK_EXT_queue_family_foreign` on.
    Foreign,
}

impl OutsideOwner {
    const fn family(self) -> u32 {
        match self {
            OutsideOwner::External => vk::QUEUE_FAMILY_EXTERNAL,
            OutsideOwner::Foreign => vk::QUEUE_FAMILY_FOREIGN_EXT,
        }
    }
}

impl Executor {
    /// Says who has the external image or buffer `name` between frames; `None`: the queues of this device, as at first. Each frame then
    /// takes it over before its first use, from the state `before` of [`Executor::external_states`], and gives it back in the state
    /// `after`. What was to be left as it was, and is in the layout `UNDEFINED` before the frame, isn't taken over: its contents are lost.
    /// The other owner gives and takes it by barriers of its own, in the same layouts. Frames in flight are waited for.
    ///
    /// # Errors
    /// [`Error::BadResource`] if there is no such external image or buffer, or the device can't take anything from that owner.
    pub fn set_owner(&mut self, name: &str, owner: Option<OutsideOwner>) -> Result<(), Error> {
        if owner == Some(OutsideOwner::Foreign) && !self.gpu.takes_foreign {
            let what = format!(
                "`{name}` can't have a foreign owner: {} was created without VK_EXT_queue_family_foreign",
                self.gpu.summary.name
            );
            return Err(Error::BadResource { what });
        }
        let resource = self.external(name);
        let unknown = || Error::BadResource { what: format!("the Plan has no external image or buffer `{name}`") };
        let resource = resource.ok_or_else(unknown)?;
        self.frames.wait_for_all()?;
        let import = self.imports.iter_mut().find(|import| import.resource == resource);
        import.ok_or_else(unknown)?.owner = owner;
        Ok(())
    }

    /// Whether somebody outside of the device has it between frames.
    pub(super) fn is_outside(&self, resource: Resource) -> bool {
        let physical = &self.prepared.physical;
        self.imports.iter().any(|it| it.resource == resource && it.owner.is_some() && !it.is_own(physical))
    }
}

/// The two ways of a change of owner.
#[derive(Clone, Copy)]
enum Way {
    Take,
    Give,
}

impl Import {
    /// Records what takes it over from its outside owner, before its first step.
    pub(super) fn record_taking(&self, frame: &Frame<'_>, commands: vk::CommandBuffer) {
        self.change_owner(frame, commands, Way::Take);
    }

    /// Records what gives it back to its outside owner, after its last step.
    pub(crate) fn record_giving(&self, frame: &Frame<'_>, commands: vk::CommandBuffer) {
        self.change_owner(frame, commands, Way::Give);
    }

    fn change_owner(&self, frame: &Frame<'_>, commands: vk::CommandBuffer, way: Way) {
        let Some(owner) = self.owner.filter(|_| !self.is_own(frame.physical)) else { return };
        let (state, step) = match way {
            Way::Take => (self.before, self.first),
            Way::Give => (self.after, self.last),
        };
        let (own, outside) = (self.own_family(frame, step), owner.family());
        let (from, to) = match way {
            Way::Take => (outside, own),
            Way::Give => (own, outside),
        };
        let [src, dst] = ends(state, way);
        match self.resource {
            // Its contents aren't needed.
            Resource::Image(_) if state.layout == Layout::Undefined => {}
            Resource::Image(id) => {
                let image = frame.plan.image(id);
                let whole = Subresources::all(image.format, image.mips, image.made_layers());
                let layout = convert::layout(state.layout);
                let barrier = [vk::ImageMemoryBarrier2::default()
                    .src_stage_mask(src.0)
                    .src_access_mask(src.1)
                    .dst_stage_mask(dst.0)
                    .dst_access_mask(dst.1)
                    .old_layout(layout)
                    .new_layout(layout)
                    .src_queue_family_index(from)
                    .dst_queue_family_index(to)
                    .image(frame.image(id).raw)
                    .subresource_range(convert::range(whole))];
                record(frame, commands, vk::DependencyInfo::default().image_memory_barriers(&barrier));
            }
            Resource::Buffer(id) => {
                let barrier = [vk::BufferMemoryBarrier2::default()
                    .src_stage_mask(src.0)
                    .src_access_mask(src.1)
                    .dst_stage_mask(dst.0)
                    .dst_access_mask(dst.1)
                    .src_queue_family_index(from)
                    .dst_queue_family_index(to)
                    .buffer(frame.buffer(id).raw)
                    .size(vk::WHOLE_SIZE)];
                record(frame, commands, vk::DependencyInfo::default().buffer_memory_barriers(&barrier));
            }
        }
    }

    /// The queue family of a step; that of none, if all families of the device share it.
    fn own_family(&self, frame: &Frame<'_>, step: StepId) -> u32 {
        let families = &frame.gpu.queues.families;
        let sharing = match self.resource {
            Resource::Image(id) => frame.plan.image(id).sharing,
            Resource::Buffer(id) => frame.plan.buffers[id.0 as usize].sharing,
        };
        match sharing == Sharing::Concurrent && families.indices.len() > 1 {
            true => vk::QUEUE_FAMILY_IGNORED,
            false => families.family(frame.plan.steps[step.0 as usize].queue).index,
        }
    }
}

/// Stages and accesses of both ends of the barrier. The outside half has none of its own: semaphores order it.
fn ends(state: State, way: Way) -> [(vk::PipelineStageFlags2, vk::AccessFlags2); 2] {
    let all = vk::PipelineStageFlags2::ALL_COMMANDS;
    let stages = convert::stages(state.stages);
    let own = (if stages.is_empty() { all } else { stages }, convert::accesses(state.accesses));
    match way {
        Way::Take => [(all, vk::AccessFlags2::NONE), own],
        Way::Give => [own, (vk::PipelineStageFlags2::NONE, vk::AccessFlags2::NONE)],
    }
}

fn record(frame: &Frame<'_>, commands: vk::CommandBuffer, info: vk::DependencyInfo<'_>) {
    // SAFETY: the command buffer is being recorded outside a scope, and what the barrier names lives.
    unsafe { frame.gpu.raw.cmd_pipeline_barrier2(commands, &info) };
}
