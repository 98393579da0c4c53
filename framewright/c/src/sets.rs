//! The layouts of descriptor sets that the program makes and binds itself.

use crate::arguments::list;
use crate::status::Problem;
use framewright::graph::vulkan::Stages;
use framewright::vulkan::ash::vk;
use framewright::{BindingFlags, DescriptorType, DrawInterfaces, ProgramBinding, ProgramSet, SetLayouts};

/// The layout of a descriptor set that the program makes and binds itself.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightSet {
    /// Its number, 1 to 3. The draws of a scene have set 1 and set 2.
    pub set: u32,
    /// Its bindings: types of buffers, texel buffers, images, samplers and acceleration structures, for vertex, fragment and compute shaders. Other stages take a
    /// `layout`.
    pub bindings: *const vk::DescriptorSetLayoutBinding<'static>,
    /// The flags of each binding; NULL: none has any.
    pub flags: *const vk::DescriptorBindingFlags,
    /// How many bindings there are.
    pub binding_count: usize,
    /// The layout that the program made so, which lives as long as the device; NULL: one is made of the bindings. Immutable samplers take one.
    pub layout: vk::DescriptorSetLayout,
}

/// Takes the sets of a program.
///
/// # Safety
/// They are as the fields say.
pub(crate) unsafe fn program_sets(
    sets: *const FramewrightSet,
    count: usize,
    mut draws: DrawInterfaces,
) -> Result<(DrawInterfaces, SetLayouts), Problem> {
    let mut layouts = SetLayouts::default();
    // SAFETY: the caller's word.
    for given in unsafe { list(sets, count, "sets")? } {
        if draws.sets().iter().any(|known| known.set == given.set) {
            return Err(Problem::Misuse(format!("set {} stands twice in `sets`", given.set)));
        }
        // SAFETY: the caller's word.
        let bindings = unsafe { list(given.bindings, given.binding_count, "bindings")? };
        let flags = if given.flags.is_null() {
            &[]
        } else {
            // SAFETY: the caller's word.
            unsafe { list(given.flags, given.binding_count, "flags")? }
        };
        let has_layout = given.layout != vk::DescriptorSetLayout::null();
        let all = bindings.iter().enumerate().map(|(at, it)| {
            if !it.p_immutable_samplers.is_null() && !has_layout {
                let what = format!(
                    "binding {} of set {} has immutable samplers, and the set no `layout`",
                    it.binding, given.set
                );
                return Err(Problem::Misuse(what));
            }
            let made = vk::ShaderStageFlags::from_raw(Stages::of_sets().iter().fold(0, |all, (_, bit, _)| all | bit));
            if !made.contains(it.stage_flags) && !has_layout {
                let what = format!(
                    "binding {} of set {} is for other stages, and the set has no `layout`",
                    it.binding, given.set
                );
                return Err(Problem::Misuse(what));
            }
            binding(given.set, it, flags.get(at).copied().unwrap_or_default())
        });
        draws = draws.with_set(ProgramSet::new(given.set, all.collect::<Result<Vec<_>, _>>()?));
        if has_layout {
            // SAFETY: the caller's word.
            layouts = unsafe { layouts.with(given.set, given.layout) };
        }
    }
    match draws.set_faults().into_iter().next() {
        Some(fault) => Err(Problem::Misuse(format!("`sets`: {}", fault.message))),
        None => Ok((draws, layouts)),
    }
}

fn binding(
    set: u32,
    it: &vk::DescriptorSetLayoutBinding<'_>,
    flags: vk::DescriptorBindingFlags,
) -> Result<ProgramBinding, Problem> {
    use DescriptorType as Is;
    use vk::DescriptorBindingFlags as Flags;
    const KINDS: [(vk::DescriptorType, DescriptorType); 11] = [
        (vk::DescriptorType::SAMPLER, Is::Sampler),
        (vk::DescriptorType::COMBINED_IMAGE_SAMPLER, Is::CombinedImageSampler),
        (vk::DescriptorType::SAMPLED_IMAGE, Is::SampledImage),
        (vk::DescriptorType::STORAGE_IMAGE, Is::StorageImage),
        (vk::DescriptorType::UNIFORM_TEXEL_BUFFER, Is::UniformTexelBuffer),
        (vk::DescriptorType::STORAGE_TEXEL_BUFFER, Is::StorageTexelBuffer),
        (vk::DescriptorType::UNIFORM_BUFFER, Is::UniformBuffer),
        (vk::DescriptorType::STORAGE_BUFFER, Is::StorageBuffer),
        (vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC, Is::UniformBufferDynamic),
        (vk::DescriptorType::STORAGE_BUFFER_DYNAMIC, Is::StorageBufferDynamic),
        (vk::DescriptorType::ACCELERATION_STRUCTURE_KHR, Is::AccelerationStructure),
    ];
    let misuse = |what: &str| Problem::Misuse(format!("binding {} of set {set} has {what}", it.binding));
    let kind = KINDS.iter().find(|(ty, _)| *ty == it.descriptor_type).map(|(_, kind)| *kind);
    let kind = kind.ok_or_else(|| misuse("a type that no set of a program has"))?;
    let known = Flags::PARTIALLY_BOUND
        | Flags::UPDATE_AFTER_BIND
        | Flags::UPDATE_UNUSED_WHILE_PENDING
        | Flags::VARIABLE_DESCRIPTOR_COUNT;
    if !known.contains(flags) {
        return Err(misuse("flags that aren't known"));
    }
    let stages = Stages::of_sets().into_iter().filter(|(_, bit, _)| it.stage_flags.as_raw() & bit != 0);
    let flags = BindingFlags {
        partially_bound: flags.contains(Flags::PARTIALLY_BOUND),
        update_after_bind: flags.contains(Flags::UPDATE_AFTER_BIND),
        update_unused_while_pending: flags.contains(Flags::UPDATE_UNUSED_WHILE_PENDING),
        variable_count: flags.contains(Flags::VARIABLE_DESCRIPTOR_COUNT),
    };
    Ok(ProgramBinding::new(it.binding, kind)
        .with_count(it.descriptor_count)
        .with_stages(stages.fold(Stages::empty(), |all, (.., stage)| all | stage))
        .with_flags(flags))
}
