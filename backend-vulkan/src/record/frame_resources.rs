//! What a frame's commands read of the draw source's, kept as long as the device may read it.

use crate::memory::RawBuffer;
use crate::pipeline::DescriptorSet;
use crate::resources::RawBindGroup;
use std::sync::Arc;

/// Resources of a frame's commands, kept until the device is done with them even if the draw source drops them.
#[derive(Default)]
pub(crate) struct HeldResources {
    pub(super) groups: FrameResources<RawBindGroup>,
    pub(super) buffers: FrameResources<RawBuffer>,
    /// Sets of groups that have several.
    pub(super) sets: FrameResources<DescriptorSet>,
    /// By set from 1 on: whether the pass that is being recorded has all that it reads of it.
    pub(super) bound: Vec<bool>,
    /// The vertex buffers that are bound for the pass that is being recorded: the number of each, and its bytes from where it is read on.
    pub(super) vertices: Vec<(u32, u64)>,
    /// By word of four bytes: whether the push constant is set for the pass that is being recorded.
    pub(super) pushed: Vec<bool>,
}

/// Resources in the order in which a frame's commands use them. What a frame uses as the frame before did stays as it is, since
/// to count references takes time.
pub(super) struct FrameResources<T> {
    list: Vec<Arc<T>>,
    /// How many of them the frame has used so far.
    used: usize,
}

impl<T> Default for FrameResources<T> {
    fn default() -> FrameResources<T> {
        FrameResources { list: Vec::new(), used: 0 }
    }
}

impl<T> FrameResources<T> {
    pub(super) fn hold(&mut self, resource: &Arc<T>) {
        match self.list.get_mut(self.used) {
            Some(held) if Arc::ptr_eq(held, resource) => {}
            Some(held) => *held = resource.clone(),
            None => self.list.push(resource.clone()),
        }
        self.used += 1;
    }

    /// The last ones of this number that were held.
    pub(super) fn last(&self, number: usize) -> &[Arc<T>] {
        &self.list[self.used.saturating_sub(number)..self.used]
    }
}

impl HeldResources {
    /// Begins a frame, which finds the resources of the one before. The device must be done with that.
    pub(super) fn begin(&mut self) {
        (self.groups.used, self.buffers.used, self.sets.used) = (0, 0, 0);
    }

    /// Lets go of what the frame before used and this one doesn't.
    pub(super) fn end(&mut self) {
        self.groups.list.truncate(self.groups.used);
        self.buffers.list.truncate(self.buffers.used);
        self.sets.list.truncate(self.sets.used);
    }
}
