//! Sets that the program makes and binds itself.

use crate::base::{Error, stage_flags};
use crate::gpu::{Gpu, LayoutBinding};
use ash::vk;
use framewright_graph::shader::{BindingFlags, DescriptorType, ProgramBinding, ProgramSet};

/// A descriptor set of the program's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RawSet(pub(crate) vk::DescriptorSet);

impl RawSet {
    /// Takes a set of the program's.
    ///
    /// # Safety
    /// It must be of the device of all that it is bound to, have the layout that the program's [`ProgramSet`] tells, and live until the
    /// last frame is done that it was bound in. Until then all that shaders read of it must be there, in the state that its descriptors
    /// tell, and what is written to it must be allowed by its flags. The program makes the barriers: no Plan knows what is in it.
    #[must_use]
    pub unsafe fn new(set: vk::DescriptorSet) -> RawSet {
        RawSet(set)
    }
}

/// The sets that an executor binds for all passes that read them.
#[derive(Debug, Clone)]
pub(crate) struct ProgramSets {
    /// The numbers of the sets that the program has told of.
    told: Vec<u32>,
    bound: Vec<(u32, RawSet, Vec<u32>)>,
}

impl ProgramSets {
    /// No sets.
    pub(crate) const NONE: &'static ProgramSets = &ProgramSets { told: Vec::new(), bound: Vec::new() };

    /// None is bound yet of those that the program has told of.
    pub(crate) fn new(told: &[ProgramSet]) -> ProgramSets {
        ProgramSets { told: told.iter().map(|set| set.set).collect(), bound: Vec::new() }
    }

    /// Whether the program has told of a set of this number.
    ///
    /// # Errors
    /// That it hasn't, in words.
    pub(crate) fn check(&self, number: u32) -> Result<(), String> {
        match self.told.contains(&number) {
            true => Ok(()),
            false => Err(format!(
                "set {number} is bound, and the program has told of none of that number (`DrawInterfaces::with_set`)"
            )),
        }
    }

    /// Whether all that are bound are sets that the program has told of.
    ///
    /// # Errors
    /// Those of [`ProgramSets::check`].
    pub(crate) fn check_all(&self) -> Result<(), String> {
        self.bound.iter().try_for_each(|(number, ..)| self.check(*number))
    }

    /// Has a set take the place of the one of its number.
    pub(crate) fn bind(&mut self, number: u32, set: RawSet, offsets: &[u32]) {
        self.unbind(number);
        self.bound.push((number, set, offsets.to_vec()));
    }

    /// Lets go of a set.
    pub(crate) fn unbind(&mut self, number: u32) {
        self.bound.retain(|(known, ..)| *known != number);
    }

    /// Takes over sets of numbers that it has none of.
    pub(crate) fn take_over(&mut self, before: &ProgramSets) {
        let new = before.bound.iter().filter(|(number, ..)| self.of(*number).is_none()).cloned().collect::<Vec<_>>();
        self.bound.extend(new);
    }

    /// The set of a number, with its dynamic offsets.
    pub(crate) fn of(&self, number: u32) -> Option<(RawSet, &[u32])> {
        self.bound.iter().find(|(known, ..)| *known == number).map(|(_, set, offsets)| (*set, &offsets[..]))
    }
}

/// The layout of a set of the program's, made as it says.
pub(crate) fn program_layout(gpu: &Gpu, set: &ProgramSet) -> Result<vk::DescriptorSetLayout, Error> {
    let binding = |it: &ProgramBinding| LayoutBinding {
        binding: it.binding,
        ty: descriptor_type(it.kind),
        count: it.count,
        stages: stage_flags(it.stages),
        flags: binding_flags(it.flags),
    };
    gpu.set_layout(set.bindings.iter().map(binding).collect())
}

/// What each dynamic offset of a set must be a multiple of, in the order in which they are told.
pub(crate) fn offset_alignments(gpu: &Gpu, set: &ProgramSet) -> Vec<u64> {
    let limits = &gpu.limits;
    let mut bindings: Vec<_> = set.bindings.iter().filter(|it| it.kind.is_dynamic()).collect();
    bindings.sort_by_key(|it| it.binding);
    let alignment = |it: &ProgramBinding| match it.kind {
        DescriptorType::UniformBufferDynamic => limits.min_uniform_buffer_offset_alignment,
        _ => limits.min_storage_buffer_offset_alignment,
    };
    bindings.iter().flat_map(|it| std::iter::repeat_n(alignment(it), it.count as usize)).collect()
}

fn descriptor_type(kind: DescriptorType) -> vk::DescriptorType {
    use vk::DescriptorType as Is;
    match kind {
        DescriptorType::Sampler => Is::SAMPLER,
        DescriptorType::CombinedImageSampler => Is::COMBINED_IMAGE_SAMPLER,
        DescriptorType::SampledImage => Is::SAMPLED_IMAGE,
        DescriptorType::StorageImage => Is::STORAGE_IMAGE,
        DescriptorType::UniformTexelBuffer => Is::UNIFORM_TEXEL_BUFFER,
        DescriptorType::StorageTexelBuffer => Is::STORAGE_TEXEL_BUFFER,
        DescriptorType::UniformBuffer => Is::UNIFORM_BUFFER,
        DescriptorType::StorageBuffer => Is::STORAGE_BUFFER,
        DescriptorType::UniformBufferDynamic => Is::UNIFORM_BUFFER_DYNAMIC,
        DescriptorType::StorageBufferDynamic => Is::STORAGE_BUFFER_DYNAMIC,
        DescriptorType::AccelerationStructure => Is::ACCELERATION_STRUCTURE_KHR,
    }
}

fn binding_flags(flags: BindingFlags) -> vk::DescriptorBindingFlags {
    use vk::DescriptorBindingFlags as Flags;
    let BindingFlags { partially_bound, update_after_bind, update_unused_while_pending, variable_count } = flags;
    let all = [
        (partially_bound, Flags::PARTIALLY_BOUND),
        (update_after_bind, Flags::UPDATE_AFTER_BIND),
        (update_unused_while_pending, Flags::UPDATE_UNUSED_WHILE_PENDING),
        (variable_count, Flags::VARIABLE_DESCRIPTOR_COUNT),
    ];
    all.into_iter().filter(|(set, _)| *set).fold(Flags::empty(), |all, (_, flag)| all | flag)
}
