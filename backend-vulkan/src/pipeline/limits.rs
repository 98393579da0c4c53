//! How many resources a device lets shaders see.

use ash::vk;
use framewright_graph::shader::{Binding, BindingKind, PASS_SET, ShaderInterface, Supplied, SuppliedKind};

/// What resources of one kind are called, whether a binding is one, the kind that a draw source brings along, and the device's limits
/// with Vulkan's names.
type Counted = (&'static str, fn(&BindingKind) -> bool, Option<SuppliedKind>, Vec<(&'static str, u32)>);

/// Checks the device's limits for one stage, which are also held by all stages together: the number of resources of each kind and of all
/// kinds with the pass's `targets`, where each element of an array counts, and the size of a block. Resources that the draw source brings
/// along count whether the shader reads them or not.
pub(crate) fn check_limits<'s>(
    limits: &vk::PhysicalDeviceLimits,
    shader: &ShaderInterface,
    brought: impl Iterator<Item = &'s Supplied> + Clone,
    targets: usize,
) -> Result<(), String> {
    let own = || shader.bindings.iter().filter(|it| it.set == PASS_SET);
    for (what, is_own, supplied, most) in counted(limits) {
        let own = own().filter(|it| is_own(&it.kind)).map(|it| (&*it.name, Binding::count(it)));
        let brought = brought.clone().filter(|it| Some(it.kind) == supplied).map(|it| (&*it.name, it.count));
        let all = own.chain(brought);
        let count: u64 = all.clone().map(|(_, count)| u64::from(count)).sum();
        let Some((limit, most)) = most.into_iter().min_by_key(|(_, most)| *most) else { continue };
        if count > u64::from(most) {
            let array = all.max_by_key(|(_, count)| *count).filter(|(_, count)| *count > 1);
            let array = array.map_or_else(String::new, |(name, count)| format!(", {count} of them as `{name}`"));
            return Err(format!("{count} {what} are bound{array}, and this device allows {most} ({limit})"));
        }
    }
    let counts = own().map(|it| u64::from(it.count())).chain(brought.clone().map(|it| u64::from(it.count)));
    let all = counts.sum::<u64>().saturating_add(targets as u64);
    if all > u64::from(limits.max_per_stage_resources) {
        let most = limits.max_per_stage_resources;
        return Err(format!(
            "{all} resources and colour targets are bound, and this device allows {most} (maxPerStageResources)"
        ));
    }
    let block = shader.bindings.iter().find_map(|it| match &it.kind {
        BindingKind::UniformBlock(block) if block.bytes > limits.max_uniform_buffer_range => {
            Some((&it.name, block.bytes))
        }
        _ => None,
    });
    block.map_or(Ok(()), |(name, bytes)| {
        Err(format!("the block `{name}` takes {bytes} bytes, more than this device allows"))
    })
}

/// The kinds of resources that devices limit.
fn counted(limits: &vk::PhysicalDeviceLimits) -> [Counted; 5] {
    [
        (
            "sampled images",
            |it| matches!(it, BindingKind::SampledImage(_) | BindingKind::ComparedDepth(_)),
            Some(SuppliedKind::SampledImage),
            vec![
                ("maxPerStageDescriptorSampledImages", limits.max_per_stage_descriptor_sampled_images),
                ("maxPerStageDescriptorSamplers", limits.max_per_stage_descriptor_samplers),
                ("maxDescriptorSetSampledImages", limits.max_descriptor_set_sampled_images),
                ("maxDescriptorSetSamplers", limits.max_descriptor_set_samplers),
            ],
        ),
        (
            "storage images",
            |it| matches!(it, BindingKind::StorageImage { .. }),
            None,
            vec![
                ("maxPerStageDescriptorStorageImages", limits.max_per_stage_descriptor_storage_images),
                ("maxDescriptorSetStorageImages", limits.max_descriptor_set_storage_images),
            ],
        ),
        (
            "uniform blocks",
            |it| matches!(it, BindingKind::UniformBlock(_)),
            Some(SuppliedKind::UniformBlock),
            vec![
                ("maxPerStageDescriptorUniformBuffers", limits.max_per_stage_descriptor_uniform_buffers),
                ("maxDescriptorSetUniformBuffers", limits.max_descriptor_set_uniform_buffers),
            ],
        ),
        (
            "storage blocks",
            |it| matches!(it, BindingKind::StorageBlock { .. }),
            Some(SuppliedKind::StorageBlock),
            vec![
                ("maxPerStageDescriptorStorageBuffers", limits.max_per_stage_descriptor_storage_buffers),
                ("maxDescriptorSetStorageBuffers", limits.max_descriptor_set_storage_buffers),
            ],
        ),
        (
            "input attachments",
            |it| matches!(it, BindingKind::InputAttachment { .. }),
            None,
            vec![
                ("maxPerStageDescriptorInputAttachments", limits.max_per_stage_descriptor_input_attachments),
                ("maxDescriptorSetInputAttachments", limits.max_descriptor_set_input_attachments),
            ],
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A device of the least that Vulkan demands (EM-5): 16 sampled images in a stage, 96 in all sets.
    fn least() -> vk::PhysicalDeviceLimits {
        vk::PhysicalDeviceLimits {
            max_per_stage_descriptor_samplers: 16,
            max_per_stage_descriptor_sampled_images: 16,
            max_descriptor_set_samplers: 96,
            max_descriptor_set_sampled_images: 96,
            max_per_stage_descriptor_uniform_buffers: 12,
            max_descriptor_set_uniform_buffers: 72,
            max_per_stage_resources: 128,
            ..vk::PhysicalDeviceLimits::default()
        }
    }

    fn refused(limits: &vk::PhysicalDeviceLimits, textures: u32) -> String {
        refused_with(limits, textures, 0)
    }

    fn refused_with(limits: &vk::PhysicalDeviceLimits, textures: u32, targets: usize) -> String {
        let brought = [
            Supplied::new(1, 0, "sky", SuppliedKind::SampledImage),
            Supplied::new(2, 0, "textures", SuppliedKind::SampledImage).with_count(textures),
        ];
        check_limits(limits, &ShaderInterface::default(), brought.iter(), targets).err().unwrap_or_default()
    }

    #[test]
    fn each_element_of_an_array_counts_and_the_limit_has_its_name() {
        assert_eq!(refused(&least(), 15), "");
        let said = "17 sampled images are bound, 16 of them as `textures`, and this device allows 16 ";
        assert_eq!(refused(&least(), 16), format!("{said}(maxPerStageDescriptorSampledImages)"));
        let few_samplers = vk::PhysicalDeviceLimits { max_per_stage_descriptor_sampled_images: 128, ..least() };
        assert_eq!(refused(&few_samplers, 16), format!("{said}(maxPerStageDescriptorSamplers)"));
        let few_in_sets = vk::PhysicalDeviceLimits { max_descriptor_set_sampled_images: 8, ..least() };
        assert_eq!(
            refused(&few_in_sets, 15),
            "16 sampled images are bound, 15 of them as `textures`, and this device allows 8 \
             (maxDescriptorSetSampledImages)"
        );
    }

    #[test]
    fn resources_of_all_kinds_count_together_with_colour_targets() {
        let many = vk::PhysicalDeviceLimits {
            max_per_stage_descriptor_samplers: 1000,
            max_per_stage_descriptor_sampled_images: 1000,
            max_descriptor_set_samplers: 1000,
            max_descriptor_set_sampled_images: 1000,
            ..least()
        };
        assert_eq!(refused_with(&many, 123, 4), "");
        let said = "129 resources and colour targets are bound, and this device allows 128 (maxPerStageResources)";
        assert_eq!(refused_with(&many, 124, 4), said);
    }

    #[test]
    fn arrays_longer_than_any_number_are_refused_too() {
        assert!(refused(&least(), u32::MAX).starts_with("4294967296 sampled images are bound"));
    }
}
