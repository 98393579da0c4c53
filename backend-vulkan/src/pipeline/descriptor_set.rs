//! Descriptor sets.

use crate::base::Error;
use crate::gpu::{Gpu, LayoutBinding};
use ash::vk;
use std::sync::Arc;

/// A descriptor set in a pool of its own.
pub(crate) struct DescriptorSet {
    gpu: Arc<Gpu>,
    pool: vk::DescriptorPool,
    pub(crate) raw: vk::DescriptorSet,
}

/// The buffer or image view that a descriptor points to.
#[derive(Debug, Clone, Copy)]
pub(crate) enum DescriptorTarget {
    /// A whole buffer.
    Buffer(vk::Buffer),
    /// A part of a buffer: its offset, and bytes.
    BufferPart(vk::Buffer, u64, u64),
    /// A view, in the layout in which it will be, with a sampler or (storage images) without.
    Image(vk::ImageView, vk::ImageLayout, vk::Sampler),
    /// A sampler by itself.
    Sampler(vk::Sampler),
}

impl DescriptorSet {
    /// A set of these bindings, with a target for each of their elements. What they point to must outlive the set's use.
    pub(crate) fn new(
        gpu: &Arc<Gpu>,
        bindings: &[(LayoutBinding, Vec<DescriptorTarget>)],
    ) -> Result<DescriptorSet, Error> {
        const DOING: &str = "creating a descriptor set";
        let layout = gpu.set_layout(bindings.iter().map(|(binding, _)| *binding).collect())?;
        let sizes: Vec<_> = bindings
            .iter()
            .map(|(binding, _)| vk::DescriptorPoolSize { ty: binding.ty, descriptor_count: binding.count })
            .collect();
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        // SAFETY: the device lives.
        let pool = unsafe { gpu.raw.create_descriptor_pool(&info, None) }.map_err(Error::vulkan(DOING))?;
        let mut set = DescriptorSet { gpu: gpu.clone(), pool, raw: vk::DescriptorSet::null() };
        let layouts = [layout];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
        // SAFETY: the pool was made for exactly this set.
        let sets = unsafe { gpu.raw.allocate_descriptor_sets(&info) }.map_err(Error::vulkan(DOING))?;
        set.raw = sets.first().copied().unwrap_or_default();
        for (binding, targets) in bindings {
            for (element, target) in (0..).zip(targets) {
                set.write(*binding, element, *target);
            }
        }
        Ok(set)
    }

    /// Has an element of a binding point to something else. No frame in flight may read the set.
    pub(crate) fn write(&mut self, binding: LayoutBinding, element: u32, target: DescriptorTarget) {
        let write = vk::WriteDescriptorSet::default()
            .dst_set(self.raw)
            .dst_binding(binding.binding)
            .dst_array_element(element)
            .descriptor_type(binding.ty)
            .descriptor_count(1);
        let image = |image_view, image_layout, sampler| [vk::DescriptorImageInfo { sampler, image_view, image_layout }];
        match target {
            DescriptorTarget::Sampler(sampler) => {
                let info = image(vk::ImageView::null(), vk::ImageLayout::UNDEFINED, sampler);
                // SAFETY: the set is in no use, has this element, and the sampler lives.
                unsafe { self.gpu.raw.update_descriptor_sets(&[write.image_info(&info)], &[]) };
            }
            DescriptorTarget::Buffer(buffer) => {
                let info = [vk::DescriptorBufferInfo { buffer, offset: 0, range: vk::WHOLE_SIZE }];
                // SAFETY: the set is in no use, has this element, and the buffer lives.
                unsafe { self.gpu.raw.update_descriptor_sets(&[write.buffer_info(&info)], &[]) };
            }
            DescriptorTarget::BufferPart(buffer, offset, range) => {
                let info = [vk::DescriptorBufferInfo { buffer, offset, range }];
                // SAFETY: the set is in no use, has this element, and the buffer lives and holds as much.
                unsafe { self.gpu.raw.update_descriptor_sets(&[write.buffer_info(&info)], &[]) };
            }
            DescriptorTarget::Image(image_view, image_layout, sampler) => {
                let info = image(image_view, image_layout, sampler);
                // SAFETY: the set is in no use, has this element, and view and sampler live.
                unsafe { self.gpu.raw.update_descriptor_sets(&[write.image_info(&info)], &[]) };
            }
        }
    }
}

impl Drop for DescriptorSet {
    fn drop(&mut self) {
        if !self.gpu.is_abandoned() {
            // SAFETY: every submission is waited for, so the set isn't in use.
            unsafe { self.gpu.raw.destroy_descriptor_pool(self.pool, None) };
        }
    }
}
