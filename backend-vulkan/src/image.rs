//! Images and their views.

use crate::convert;
use crate::device::Shared;
use crate::error::Error;
use crate::memory::Memory;
use ash::vk;
use framewright_graph::device::ImageDescriptor;
use framewright_graph::plan::Subresources;
use framewright_graph::vulkan::{Shape, Sharing};
use std::sync::Arc;

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
    pub(crate) shared: Arc<Shared>,
    pub(crate) raw: vk::Image,
    pub(crate) descriptor: ImageDescriptor,
    /// `None`: it belongs to somebody else.
    memory: Option<Arc<Memory>>,
}

impl Image {
    /// An image at `offset` of `memory`, which must be large enough and of a type that fits.
    pub(crate) fn new(
        shared: &Arc<Shared>,
        name: &str,
        descriptor: &ImageDescriptor,
        memory: Arc<Memory>,
        offset: u64,
    ) -> Result<Image, Error> {
        let info = create_info(descriptor, &shared.queues.families.indices);
        // SAFETY: the device lives; formats, extents and usages were checked against the device by whoever planned.
        let raw = unsafe { shared.raw.create_image(&info, None) }.map_err(Error::vulkan("creating an image"))?;
        let (block, begin) = memory.place();
        let image = Image { shared: shared.clone(), raw, descriptor: *descriptor, memory: Some(memory) };
        // SAFETY: the image is new; size, alignment and type of the memory were checked by whoever placed the image.
        unsafe { shared.raw.bind_image_memory(raw, block, begin + offset) }
            .map_err(Error::vulkan("binding an image to memory"))?;
        shared.name(raw, name);
        Ok(image)
    }

    /// An image with memory of its own.
    pub(crate) fn with_own_memory(
        shared: &Arc<Shared>,
        name: &str,
        descriptor: &ImageDescriptor,
    ) -> Result<Image, Error> {
        let needs = shared.memory_needs(descriptor);
        let requirements =
            vk::MemoryRequirements { size: needs.bytes, alignment: needs.alignment, memory_type_bits: needs.type_bits };
        let memory = Memory::new(shared, name, requirements, crate::memory::Kind::Images)?;
        Image::new(shared, name, descriptor, Arc::new(memory), 0)
    }

    /// Somebody else's image of this description.
    ///
    /// # Safety
    /// It must have been made by the same device and live as long as this.
    pub(crate) unsafe fn foreign(shared: &Arc<Shared>, descriptor: &ImageDescriptor, raw: vk::Image) -> Image {
        Image { shared: shared.clone(), raw, descriptor: *descriptor, memory: None }
    }

    /// Whether it belongs to somebody else.
    pub(crate) fn is_foreign(&self) -> bool {
        self.memory.is_none()
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        if self.memory.is_some() && !self.shared.is_abandoned() {
            // SAFETY: whoever uses the image waits for the device before letting go of it.
            unsafe { self.shared.raw.destroy_image(self.raw, None) };
        }
    }
}

/// How a view shows an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum ViewShape {
    /// One layer, flat.
    Flat,
    /// Layers.
    Layers,
    /// A volume.
    Volume,
    /// Six faces.
    Cube,
    /// Several times six faces.
    Cubes,
}

/// A view of an image, which lives at least as long.
pub(crate) struct View {
    image: Arc<Image>,
    pub(crate) raw: vk::ImageView,
}

impl View {
    /// A view of `range` of `image`.
    pub(crate) fn new(image: &Arc<Image>, range: Subresources, shape: ViewShape) -> Result<View, Error> {
        let info = vk::ImageViewCreateInfo::default()
            .image(image.raw)
            .view_type(match shape {
                ViewShape::Flat => vk::ImageViewType::TYPE_2D,
                ViewShape::Layers => vk::ImageViewType::TYPE_2D_ARRAY,
                ViewShape::Volume => vk::ImageViewType::TYPE_3D,
                ViewShape::Cube => vk::ImageViewType::CUBE,
                ViewShape::Cubes => vk::ImageViewType::CUBE_ARRAY,
            })
            .format(convert::format(image.descriptor.format))
            .subresource_range(convert::range(range));
        // SAFETY: the image lives, and the range was checked against it by whoever planned.
        let raw = unsafe { image.shared.raw.create_image_view(&info, None) }
            .map_err(Error::vulkan("creating an image view"))?;
        Ok(View { image: image.clone(), raw })
    }
}

impl View {
    /// Whether this device made it.
    pub(crate) fn is_of(&self, shared: &Shared) -> bool {
        std::ptr::eq(Arc::as_ptr(&self.image.shared), shared)
    }
}

impl Drop for View {
    fn drop(&mut self) {
        if !self.image.shared.is_abandoned() {
            // SAFETY: whoever uses the view waits for the device before letting go of it.
            unsafe { self.image.shared.raw.destroy_image_view(self.raw, None) };
        }
    }
}
