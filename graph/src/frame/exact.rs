//! Frames that round nowhere between their passes: for pictures that others are held against.

use super::{Blend, Frame, Image, ImageIndex, Lifetime, Resource};
use crate::device::Profile;
use crate::vulkan::Format;

impl Frame {
    /// Gives images the most exact formats of their kind that the device has: colour 32 bits of floating point a channel, depth too.
    /// These images keep their format: integers, images from outside, storage images that shaders write, and images whose bytes are
    /// moved. So do images that leave the frame in an encoding, which their format must hold.
    pub fn make_exact(&mut self, device: &Profile) {
        let fixed = self.images_with_fixed_formats();
        let wanted: Vec<Option<Format>> =
            self.images.iter().zip((0..).map(ImageIndex)).map(|(image, at)| self.exact(image, at, device)).collect();
        for ((image, fixed), wanted) in self.images.iter_mut().zip(fixed).zip(wanted) {
            if let Some(format) = wanted.filter(|_| !fixed) {
                (image.format, image.chosen) = (format, None);
            }
        }
    }

    /// For each image, whether something relies on its very format.
    fn images_with_fixed_formats(&self) -> Vec<bool> {
        let outside = |image: &Image| matches!(image.lifetime, Lifetime::Imported { .. } | Lifetime::File(_));
        let mut fixed: Vec<bool> = self.images.iter().map(outside).collect();
        let format = |image: ImageIndex| self.images.get(image.0 as usize).map(|image| image.format);
        let relied_on = self.passes.iter().flat_map(|pass| {
            pass.accesses().filter(|access| pass.relies_on_format(access, format)).filter_map(|it| it.image_index())
        });
        let encoded = self.outputs.iter().filter(|output| output.encoding.is_some());
        let encoded = encoded.filter_map(|output| match output.resource {
            Resource::Image(image) => Some(image),
            Resource::Buffer(_) => None,
        });
        for image in relied_on.chain(encoded) {
            if let Some(fixed) = fixed.get_mut(image.0 as usize) {
                *fixed = true;
            }
        }
        fixed
    }

    /// The most exact format for an image, if the device can use it as the image is used.
    fn exact(&self, image: &Image, at: ImageIndex, device: &Profile) -> Option<Format> {
        let format = match image.format {
            Format::D16_UNORM | Format::X8_D24_UNORM_PACK32 | Format::D32_SFLOAT => Format::D32_SFLOAT,
            format if format.is_depth() => Format::D32_SFLOAT_S8_UINT,
            format if format.is_integer() => return None,
            // A component that isn't there is read as 0.
            format if format.components() == 1 => Format::R32_SFLOAT,
            format if format.components() == 2 => Format::R32G32_SFLOAT,
            _ => Format::R32G32B32A32_SFLOAT,
        };
        let support = device.format(format)?;
        let mut sampled = self.passes.iter().flat_map(|pass| &pass.sampled).filter(|sampled| sampled.image == at);
        let filters = sampled.any(|sampled| sampled.sampler.is_linear());
        let mut targets = self.passes.iter().flat_map(|pass| &pass.color).filter(|target| target.image == at);
        let blends = targets.any(|target| target.blend != Blend::Replace);
        let fits = (support.linear_filter || !filters || format.is_depth()) && (support.blend || !blends);
        fits.then_some(format)
    }
}
