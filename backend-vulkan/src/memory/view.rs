//! Views of images.

use super::image::Image;
use crate::base::{Error, convert};
use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::vulkan::Subresources;
use std::sync::Arc;

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
        // SAFETY: the image lives, and the range was checked against it by `verify`.
        let raw =
            unsafe { image.gpu.raw.create_image_view(&info, None) }.map_err(Error::vulkan("creating an image view"))?;
        Ok(View { image: image.clone(), raw })
    }

    /// Whether this device made it.
    pub(crate) fn is_of(&self, gpu: &Gpu) -> bool {
        std::ptr::eq(Arc::as_ptr(&self.image.gpu), gpu)
    }
}

impl Drop for View {
    fn drop(&mut self) {
        if !self.image.gpu.is_abandoned() {
            // SAFETY: the owner of the view waits for the device before dropping it.
            unsafe { self.image.gpu.raw.destroy_image_view(self.raw, None) };
        }
    }
}
