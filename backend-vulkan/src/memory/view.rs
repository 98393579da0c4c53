//! Views of images.

use super::image::Image;
use crate::base::{Error, convert};
use ash::vk;
use framewright_graph::vulkan::Subresources;
use std::sync::{Mutex, PoisonError};

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

/// The views that were made of an image.
pub(super) type Views = Mutex<Vec<(Subresources, ViewShape, vk::ImageView)>>;

impl Image {
    /// The view of `range` that shows it so. It lives as long as the image.
    pub(crate) fn view(&self, range: Subresources, shape: ViewShape) -> Result<vk::ImageView, Error> {
        let mut views = self.views.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((.., made)) = views.iter().find(|(of, so, _)| (*of, *so) == (range, shape)) {
            return Ok(*made);
        }
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw)
            .view_type(match shape {
                ViewShape::Flat => vk::ImageViewType::TYPE_2D,
                ViewShape::Layers => vk::ImageViewType::TYPE_2D_ARRAY,
                ViewShape::Volume => vk::ImageViewType::TYPE_3D,
                ViewShape::Cube => vk::ImageViewType::CUBE,
                ViewShape::Cubes => vk::ImageViewType::CUBE_ARRAY,
            })
            .format(convert::format(self.descriptor.format))
            .subresource_range(convert::range(range));
        // SAFETY: the image lives. `verify` checked the range against it, and refuses attachments that are three-dimensional;
        // sampled and storage images have the shape that shaders declare.
        let made =
            unsafe { self.gpu.raw.create_image_view(&info, None) }.map_err(Error::vulkan("creating an image view"))?;
        views.push((range, shape, made));
        Ok(made)
    }
}
