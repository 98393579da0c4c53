//! The draw source's sets, bound for a pass.

use super::bindings::bind_set;
use super::frame_resources::HeldResources;
use crate::gpu::Gpu;
use crate::prepare::{SuppliedBlock, SuppliedSet, SuppliedSets};
use crate::resources::BindGroup;
use ash::vk;

/// The sets from 1 on of a pass that is being recorded, and which of them were bound.
pub(super) struct BoundSets<'f> {
    gpu: &'f Gpu,
    point: vk::PipelineBindPoint,
    supplied: &'f SuppliedSets,
    pub(super) held: &'f mut HeldResources,
}

impl<'f> BoundSets<'f> {
    /// The sets of another pass: none is bound.
    pub(super) fn new(
        gpu: &'f Gpu,
        point: vk::PipelineBindPoint,
        supplied: &'f SuppliedSets,
        held: &'f mut HeldResources,
    ) -> BoundSets<'f> {
        held.bound.clear();
        held.bound.extend(supplied.sets.iter().map(|set| !set.is_read));
        BoundSets { gpu, point, supplied, held }
    }

    /// Binds a group to the set number `set`, from 1 on.
    ///
    /// # Errors
    /// In words: a group of another device, or one that doesn't fit.
    pub(super) fn bind(&mut self, commands: vk::CommandBuffer, set: u32, group: &BindGroup) -> Result<(), String> {
        if !group.0.is_of(self.gpu) {
            return Err("the bind group belongs to another device".to_owned());
        }
        let index = (set as usize).wrapping_sub(1);
        match self.supplied.sets.get(index) {
            None => Err(format!("the draw interface has no set {set}")),
            Some(known) if known.layout != group.0.layout => {
                Err(format!("the bind group was made for another set than {set}, or another draw interface"))
            }
            Some(known) => {
                check_blocks(known, group)?;
                self.held.bound[index] = true;
                self.held.groups.hold(&group.0);
                let mut copies = 0;
                for buffer in group.0.dynamic_buffers() {
                    self.held.buffers.hold(&buffer.0.current());
                    copies += 1;
                }
                let (buffers, sets) = (&self.held.buffers, &mut self.held.sets);
                let raw = group.0.set(buffers.last(copies), |set| sets.hold(set)).map_err(|error| error.to_string())?;
                bind_set(self.gpu, commands, self.point, self.supplied.layout, set, raw);
                Ok(())
            }
        }
    }

    /// The first set that the shader reads and that isn't bound.
    pub(super) fn missing(&self) -> Option<usize> {
        self.held.bound.iter().position(|bound| !bound).map(|index| index + 1)
    }
}

/// Each uniform block of the shader lies within the buffer that the group has for it: else it would read zeros behind the end.
fn check_blocks(set: &SuppliedSet, group: &BindGroup) -> Result<(), String> {
    set.blocks.iter().try_for_each(|SuppliedBlock { binding, name, bytes }| match group.0.bytes_of(*binding) {
        Some(held) if u64::from(*bytes) > held.next_multiple_of(16) => {
            Err(format!("the block `{name}` takes {bytes} bytes, and its buffer holds {held}"))
        }
        _ => Ok(()),
    })
}
