//! Memory requirements of images and buffers, and whether the device can create them at all.

use super::{buffer, image};
use crate::base::convert;
use crate::gpu::{Device, Gpu};
use ash::vk;
use framewright_graph::device::{BufferDescriptor, ImageDescriptor, MemoryNeeds, MemoryProvider};
use framewright_graph::vulkan::{Shape, Usage};
use std::sync::Arc;

/// The memory requirements that an open device reports: exact.
pub struct LiveMemory {
    gpu: Arc<Gpu>,
}

impl MemoryProvider for LiveMemory {
    fn exact(&self) -> bool {
        true
    }

    fn image(&mut self, descriptor: &ImageDescriptor) -> MemoryNeeds {
        if self.gpu.can_make(descriptor) { self.gpu.memory_needs(descriptor) } else { IMPOSSIBLE }
    }

    fn buffer(&mut self, descriptor: &BufferDescriptor) -> MemoryNeeds {
        if self.gpu.can_make_buffer(descriptor) { self.gpu.buffer_memory_needs(descriptor) } else { IMPOSSIBLE }
    }
}

/// Device memory that is in use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryInUse {
    /// Heaps, images and buffers in it.
    pub allocations: usize,
    /// Bytes that they take.
    pub bytes: u64,
    /// Bytes that were got from the device; what is free of them serves what comes next.
    pub reserved_bytes: u64,
}

impl Device {
    /// Memory requirements of images and buffers on this device, for [`framewright_graph::compile`].
    #[must_use]
    pub fn memory(&self) -> LiveMemory {
        LiveMemory { gpu: self.gpu.clone() }
    }

    /// Memory of this device that everything made from it takes: executors, buffers, textures. With an allocator of the program's, that
    /// of the program is in it.
    #[must_use]
    pub fn memory_in_use(&self) -> MemoryInUse {
        let report = self.gpu.allocator().generate_report();
        MemoryInUse {
            allocations: report.allocations.len(),
            bytes: report.total_allocated_bytes,
            reserved_bytes: report.total_capacity_bytes,
        }
    }
}

/// The memory requirements of an image or buffer that the device can't create: no memory is enough.
const IMPOSSIBLE: MemoryNeeds = MemoryNeeds { bytes: u64::MAX, alignment: 1, type_bits: u32::MAX };

impl Gpu {
    /// Whether the device can make an image of this description.
    pub(crate) fn can_make(&self, descriptor: &ImageDescriptor) -> bool {
        let [width, height, depth] = descriptor.extent;
        let levels = u32::BITS - width.max(height).max(depth).leading_zeros();
        let attachment = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT;
        let square = width == height && depth == 1 && descriptor.layers.is_multiple_of(6);
        let shaped = match descriptor.shape {
            Shape::D2 => depth == 1,
            Shape::D3 => descriptor.layers == 1 && descriptor.samples == 1 && !attachment.intersects(descriptor.usage),
            Shape::Cube => square && descriptor.samples == 1,
        };
        let may_be_asked = shaped
            && !descriptor.usage.is_empty()
            && (attachment.intersects(descriptor.usage) || !descriptor.usage.contains(Usage::TRANSIENT_ATTACHMENT))
            && descriptor.samples.is_power_of_two()
            && (descriptor.samples == 1 || descriptor.mips == 1)
            // `shaderStorageImageMultisample` is off.
            && (descriptor.samples == 1 || !descriptor.usage.contains(Usage::STORAGE))
            && descriptor.mips <= levels;
        if !may_be_asked {
            return false;
        }
        let info = image::create_info(descriptor, &self.queues.families.indices);
        // SAFETY: the physical device belongs to the instance.
        let limits = unsafe {
            self.instance.raw.get_physical_device_image_format_properties(
                self.physical,
                info.format,
                info.image_type,
                info.tiling,
                info.usage,
                info.flags,
            )
        };
        limits.is_ok_and(|limits| {
            let most = [limits.max_extent.width, limits.max_extent.height, limits.max_extent.depth];
            descriptor.extent.iter().zip(most).all(|(extent, most)| (1..=most).contains(extent))
                && (1..=limits.max_mip_levels).contains(&descriptor.mips)
                && (1..=limits.max_array_layers).contains(&descriptor.layers)
                && limits.sample_counts.contains(convert::samples(descriptor.samples))
        })
    }

    /// Whether the device can make a buffer of this description.
    pub(crate) fn can_make_buffer(&self, descriptor: &BufferDescriptor) -> bool {
        (1..=self.max_buffer_size().saturating_sub(3)).contains(&descriptor.bytes) && !descriptor.usage.is_empty()
    }

    /// Memory requirements of an image of this description.
    pub(crate) fn memory_needs(&self, descriptor: &ImageDescriptor) -> MemoryNeeds {
        let create = image::create_info(descriptor, &self.queues.families.indices);
        let info = vk::DeviceImageMemoryRequirements::default().create_info(&create);
        let mut needs = vk::MemoryRequirements2::default();
        // SAFETY: maintenance4 is on, and both structures outlive the call.
        unsafe { self.raw.get_device_image_memory_requirements(&info, &mut needs) };
        memory_needs(needs.memory_requirements)
    }

    /// Memory requirements of a buffer of this description.
    pub(crate) fn buffer_memory_needs(&self, descriptor: &BufferDescriptor) -> MemoryNeeds {
        memory_needs(buffer::needs(self, &buffer::create_info(descriptor, &self.queues.families.indices)))
    }
}

fn memory_needs(requirements: vk::MemoryRequirements) -> MemoryNeeds {
    let vk::MemoryRequirements { size, alignment, memory_type_bits } = requirements;
    MemoryNeeds { bytes: size, alignment, type_bits: memory_type_bits }
}
