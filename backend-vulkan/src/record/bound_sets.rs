//! The sets of draw source and program, bound for a pass.

use super::bindings::bind_set;
use super::frame_resources::HeldResources;
use crate::gpu::Gpu;
use crate::prepare::{SuppliedBlock, SuppliedSet, SuppliedSets};
use crate::resources::{BindGroup, ProgramSets, RawSet};
use ash::vk;

/// The sets from 1 on of a pass that is being recorded, and which of them were bound.
pub(super) struct BoundSets<'f> {
    gpu: &'f Gpu,
    point: vk::PipelineBindPoint,
    supplied: &'f SuppliedSets,
    program: &'f ProgramSets,
    pub(super) held: &'f mut HeldResources,
}

impl<'f> BoundSets<'f> {
    /// The sets of another pass: none is bound, but for those that the program bound for all passes.
    pub(super) fn new(
        gpu: &'f Gpu,
        point: vk::PipelineBindPoint,
        supplied: &'f SuppliedSets,
        held: &'f mut HeldResources,
        program: &'f ProgramSets,
    ) -> BoundSets<'f> {
        held.bound.clear();
        held.vertices.clear();
        held.pushed.clear();
        let for_all = |number, set: &SuppliedSet| set.program.is_some() && program.of(number).is_some();
        let bound = (1..).zip(&supplied.sets).map(|(number, set)| !set.is_read || for_all(number, set));
        held.bound.extend(bound);
        BoundSets { gpu, point, supplied, program, held }
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
            Some(known) if known.program.is_some() => {
                Err(format!("a bind group for set {set}, which the program binds itself: `bind_set` takes its own"))
            }
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
                bind_set(self.gpu, commands, self.point, self.supplied.layout, (set, raw, &[]));
                Ok(())
            }
        }
    }

    /// Binds a set of the program's to its number. One that the shader doesn't read is left out.
    ///
    /// # Errors
    /// In words: a set that the program doesn't bind itself, or dynamic offsets that don't fit.
    pub(super) fn bind_raw(
        &mut self,
        commands: vk::CommandBuffer,
        number: u32,
        set: RawSet,
        offsets: &[u32],
    ) -> Result<(), String> {
        let index = (number as usize).checked_sub(1);
        let known = index.and_then(|index| self.supplied.sets.get(index));
        if known.is_some_and(|known| known.program.is_none() && known.is_read) {
            return Err(format!("set {number} is the draw source's: `bind_group` takes it"));
        }
        self.program.check(number)?;
        let (Some(index), Some(_)) = (index, known) else { return Ok(()) };
        bind_program_set(self.gpu, commands, self.point, self.supplied, (number, set, offsets))?;
        self.held.bound[index] = true;
        Ok(())
    }

    /// The first set that the shader reads and that isn't bound, in words.
    pub(super) fn missing(&self) -> Option<String> {
        let index = self.held.bound.iter().position(|bound| !bound)?;
        Some(match self.supplied.sets[index].program {
            None => format!("a bind group for set {}", index + 1),
            Some(_) => format!("set {}, which the program binds itself by `bind_set`", index + 1),
        })
    }
}

/// Binds the sets that the program bound for all passes and the shader reads. Returns the first that it hasn't bound.
///
/// # Errors
/// In words: dynamic offsets that don't fit.
pub(super) fn bind_program_sets(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    point: vk::PipelineBindPoint,
    supplied: &SuppliedSets,
    program: &ProgramSets,
) -> Result<Option<u32>, String> {
    let mut missing = None;
    for (number, _) in (1..).zip(&supplied.sets).filter(|(_, set)| set.program.is_some()) {
        match program.of(number) {
            Some((set, offsets)) => bind_program_set(gpu, commands, point, supplied, (number, set, offsets))?,
            None => missing = missing.or(Some(number)),
        }
    }
    Ok(missing)
}

/// Binds a set of the program's, if the shader reads it.
fn bind_program_set(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    point: vk::PipelineBindPoint,
    supplied: &SuppliedSets,
    (number, set, offsets): (u32, RawSet, &[u32]),
) -> Result<(), String> {
    let Some(alignments) = &supplied.sets[number as usize - 1].program else { return Ok(()) };
    if set.0 == vk::DescriptorSet::null() {
        return Err(format!("set {number} of the program is VK_NULL_HANDLE"));
    }
    if offsets.len() != alignments.len() {
        let (needed, given) = (alignments.len(), offsets.len());
        return Err(format!("set {number} of the program takes {needed} dynamic offsets and was given {given}"));
    }
    let odd =
        offsets.iter().zip(alignments).find(|(offset, alignment)| !u64::from(**offset).is_multiple_of(**alignment));
    if let Some((offset, alignment)) = odd {
        return Err(format!("the dynamic offset {offset} of set {number} is no multiple of {alignment}"));
    }
    bind_set(gpu, commands, point, supplied.layout, (number, set.0, offsets));
    Ok(())
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
