//! Descriptor set layouts and pipeline layouts, one for each description.

use crate::base::{Error, ShaderStage};
use crate::gpu::{Gpu, LayoutBinding};
use ash::vk;
use framewright_graph::shader::MOST_PARTS;

/// The stages that see the push constants: each may ask which part of an image is in use.
pub(crate) const PARTS_STAGES: vk::ShaderStageFlags = ShaderStage::FLAGS;
/// The size of the push constants, in bytes: four numbers for each image that is used in part.
const PARTS_BYTES: u32 = 16 * MOST_PARTS as u32;

impl Gpu {
    /// The set layout with these bindings, in any order.
    pub(crate) fn set_layout(&self, mut bindings: Vec<LayoutBinding>) -> Result<vk::DescriptorSetLayout, Error> {
        bindings.sort();
        self.caches.set_layouts.get(&bindings, |bindings| {
            let flags: Vec<_> = bindings.iter().map(|it| it.flags).collect();
            let bindings: Vec<_> = bindings
                .iter()
                .map(|it| {
                    vk::DescriptorSetLayoutBinding::default()
                        .binding(it.binding)
                        .descriptor_type(it.ty)
                        .descriptor_count(it.count)
                        .stage_flags(it.stages)
                })
                .collect();
            let mut flagged = vk::DescriptorSetLayoutBindingFlagsCreateInfo::default().binding_flags(&flags);
            let mut info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            if flags.iter().any(|flags| flags.contains(vk::DescriptorBindingFlags::UPDATE_AFTER_BIND)) {
                info = info.flags(vk::DescriptorSetLayoutCreateFlags::UPDATE_AFTER_BIND_POOL);
            }
            if flags.iter().any(|flags| !flags.is_empty()) {
                info = info.push_next(&mut flagged);
            }
            // SAFETY: the device lives.
            unsafe { self.raw.create_descriptor_set_layout(&info, None) }
                .map_err(Error::vulkan("creating a descriptor set layout"))
        })
    }

    /// The pipeline layout with these set layouts. Its one range of push constants, which all stages see, holds `pushed` bytes, and the
    /// parts of images that passes use.
    pub(crate) fn pipeline_layout(
        &self,
        sets: Vec<vk::DescriptorSetLayout>,
        pushed: u32,
    ) -> Result<vk::PipelineLayout, Error> {
        self.caches.pipeline_layouts.get(&(sets, PARTS_BYTES.max(pushed)), |(sets, size)| {
            let parts = [vk::PushConstantRange { stage_flags: PARTS_STAGES, offset: 0, size: *size }];
            let info = vk::PipelineLayoutCreateInfo::default().set_layouts(sets).push_constant_ranges(&parts);
            // SAFETY: the set layouts live as long as the device.
            unsafe { self.raw.create_pipeline_layout(&info, None) }.map_err(Error::vulkan("creating a pipeline layout"))
        })
    }
}
