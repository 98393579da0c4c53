//! Sizes of physical images: as far as a frame uses them, and as they are made.

use super::model::{AdaptedFrame, Kind, PhysicalIndex};
use crate::device::ImageDescriptor;
use crate::frame::{EyeForm, allocated_extent, level_extent};
use crate::vulkan::Subresources;

impl AdaptedFrame {
    /// The allocated width and height of a physical image, if its size may change.
    pub(super) fn allocated(&self, resource: PhysicalIndex) -> Option<[u32; 2]> {
        // Few frames have any.
        if self.allocated.is_empty() { None } else { self.allocated.get(&resource).copied() }
    }

    /// Width, height and depth of a mip level of a physical image: of its part in use, if more is allocated.
    pub(super) fn extent_at(&self, resource: PhysicalIndex, image: &ImageDescriptor, mip: u32) -> [u32; 3] {
        level_extent(image.extent, self.allocated(resource), mip)
    }

    /// How a physical image holds both eyes' parts, if it does.
    pub(super) fn eyes(&self, resource: PhysicalIndex) -> Option<EyeForm> {
        if self.eyes.is_empty() { None } else { self.eyes.get(&resource).map(|(form, _)| *form) }
    }

    /// The descriptor that a physical image is made with.
    pub(super) fn made(&self, resource: PhysicalIndex, image: &ImageDescriptor) -> ImageDescriptor {
        // Few frames have any.
        if self.allocated.is_empty() && self.eyes.is_empty() { *image } else { self.made_larger(resource, image) }
    }

    /// The descriptor of an image whose size may change, or that may hold both eyes' parts.
    fn made_larger(&self, resource: PhysicalIndex, image: &ImageDescriptor) -> ImageDescriptor {
        let extent = allocated_extent(image.extent, self.allocated(resource));
        let Some((form, rotation)) = self.eyes.get(&resource).copied() else {
            return ImageDescriptor { extent, ..*image };
        };
        let (extent, layers) =
            (EyeForm::extent(Some(form), extent, rotation), EyeForm::layers(Some(form), image.layers));
        ImageDescriptor { extent, layers, ..*image }
    }

    /// Bytes of a buffer, or of a part of an image as far as it is in use, for both eyes if it holds both.
    pub(super) fn bytes(&self, resource: PhysicalIndex, part: Subresources) -> u64 {
        match &self.resources[resource as usize].kind {
            Kind::Buffer(buffer) => buffer.bytes,
            Kind::Image(image) => image.bytes(part).saturating_mul(EyeForm::parts(self.eyes(resource))),
        }
    }

    /// Bytes of a buffer, or of a part of an image as it is allocated.
    pub(super) fn most_bytes(&self, resource: PhysicalIndex, part: Subresources) -> u64 {
        match (&self.resources[resource as usize].kind, self.allocated(resource)) {
            (Kind::Image(image), Some(allocated)) => {
                let all = ImageDescriptor { extent: allocated_extent(image.extent, Some(allocated)), ..*image };
                all.bytes(part).saturating_mul(EyeForm::parts(self.eyes(resource)))
            }
            _ => self.bytes(resource, part),
        }
    }
}
