//! Images and their memory.

use super::block::{MemoryBlock, MemoryUse};
use super::view::Views;
use crate::base::{Error, convert};
use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::device::ImageDescriptor;
use framewright_graph::vulkan::{Shape, Sharing};
use std::sync::{Arc, PoisonError};

/// How an image of this description is created: the one place that knows, so that memory needs are those of the image.
/// `families` are all that may use a shared image.
pub(crate) fn create_info<'f>(descriptor: &ImageDescriptor, families: &'f [u32]) -> vk::ImageCreateInfo<'f> {
    let info = vk::ImageCreateInfo::default()
        .image_type(if descriptor.shape == Shape::D3 { vk::ImageType::TYPE_3D } else { vk::ImageType::TYPE_2D })
        .format(convert::format(descriptor.format))
        .extent(convert::extent(descriptor.extent))
        .mip_levels(descriptor.mips)
        .array_layers(descriptor.layers)
        .samples(convert::samples(descriptor.samples))
        .tiling(vk::ImageTiling::OPTIMAL)
        .usage(convert::usage(descriptor.usage))
        .flags(match descriptor.shape {
            Shape::Cube => vk::ImageCreateFlags::CUBE_COMPATIBLE,
            Shape::D2 | Shape::D3 => vk::ImageCreateFlags::empty(),
        })
        .initial_layout(vk::ImageLayout::UNDEFINED);
    if descriptor.sharing == Sharing::Concurrent && families.len() > 1 {
        info.sharing_mode(vk::SharingMode::CONCURRENT).queue_family_indices(families)
    } else {
        info
    }
}

/// An image bound to memory. The memory lives at least as long.
pub(crate) struct Image {
    pub(crate) gpu: Arc<Gpu>,
    pub(crate) raw: vk::Image,
    pub(crate) descriptor: ImageDescriptor,
    /// `None`: it belongs to somebody else.
    memory: Option<Arc<MemoryBlock>>,
    pub(super) views: Views,
}

impl Image {
    /// An image at `offset` of `memory`, which must be large enough and of a type that fits.
    pub(crate) fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        descriptor: &ImageDescriptor,
        memory: Arc<MemoryBlock>,
        offset: u64,
    ) -> Result<Image, Error> {
        let info = create_info(descriptor, &gpu.queues.families.indices);
        // SAFETY: the device lives; formats, extents and usages were checked against the device when the Plan was made.
        let raw = unsafe { gpu.raw.create_image(&info, None) }.map_err(Error::vulkan("creating an image"))?;
        let (block, begin) = memory.place();
        let image =
            Image { gpu: gpu.clone(), raw, descriptor: *descriptor, memory: Some(memory), views: Views::default() };
        // SAFETY: the image is new; size, alignment and type of the memory were checked when the image was placed.
        unsafe { gpu.raw.bind_image_memory(raw, block, begin + offset) }
            .map_err(Error::vulkan("binding an image to memory"))?;
        gpu.name(raw, name);
        Ok(image)
    }

    /// An image with memory of its own.
    pub(crate) fn with_own_memory(gpu: &Arc<Gpu>, name: &str, descriptor: &ImageDescriptor) -> Result<Image, Error> {
        let needs = gpu.memory_needs(descriptor);
        let requirements =
            vk::MemoryRequirements { size: needs.bytes, alignment: needs.alignment, memory_type_bits: needs.type_bits };
        let memory = MemoryBlock::new(gpu, name, requirements, MemoryUse::Images)?;
        Image::new(gpu, name, descriptor, Arc::new(memory), 0)
    }

    /// Somebody else's image of this description.
    ///
    /// # Safety
    /// It must have been made by the same device and live as long as this.
    pub(crate) unsafe fn foreign(gpu: &Arc<Gpu>, descriptor: &ImageDescriptor, raw: vk::Image) -> Image {
        Image { gpu: gpu.clone(), raw, descriptor: *descriptor, memory: None, views: Views::default() }
    }

    /// Whether this device made it.
    pub(crate) fn is_of(&self, gpu: &Gpu) -> bool {
        std::ptr::eq(Arc::as_ptr(&self.gpu), gpu)
    }

    /// Whether it belongs to somebody else.
    pub(crate) fn is_foreign(&self) -> bool {
        self.memory.is_none()
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        if self.gpu.is_abandoned() {
            return;
        }
        for (.., view) in self.views.get_mut().unwrap_or_else(PoisonError::into_inner) {
            // SAFETY: the owner of the image waits for the device before dropping it.
            unsafe { self.gpu.raw.destroy_image_view(*view, None) };
        }
        if self.memory.is_some() {
            self.gpu.followers.tell(self.raw);
            // SAFETY: as above, and its views are gone.
            unsafe { self.gpu.raw.destroy_image(self.raw, None) };
        }
    }
}
