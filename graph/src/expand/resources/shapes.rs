//! Shape, layers and mip levels of an image.

use crate::base::Diagnostic;
use crate::frame::check::images;
use crate::frame::{Image, allocated_extent};
use crate::language::{self, ImageShape as Described, Layers};
use crate::vulkan::Shape;

/// How many mip levels are asked for.
#[derive(Clone, Copy)]
pub(super) enum Levels {
    Count(u32),
    /// Down to a single texel.
    Full,
}

/// Array layers of an image that follows `followed`, or none.
pub(in crate::expand) fn layers(image: &language::Image, followed: Option<u32>) -> Option<u32> {
    match image.layers.value {
        Layers::Default if image.shape.value == Described::Cube => Some(6),
        Layers::Default => Some(1),
        Layers::Count(count) => Some(count),
        Layers::Like(_) => followed,
    }
}

/// The image with its shape, layers and mip levels. `None` if they contradict each other.
pub(super) fn shaped(
    described: &language::Image,
    mut image: Image,
    layers: u32,
    levels: Levels,
    errors: &mut Vec<Diagnostic>,
) -> Option<Image> {
    image.shape = match described.shape.value {
        Described::D2 => Shape::D2,
        Described::Cube => Shape::Cube,
        Described::D3(depth) => {
            image.extent[2] = depth;
            Shape::D3
        }
    };
    image.layers = layers;
    image.mips = match levels {
        Levels::Count(count) => count,
        Levels::Full => images::most_levels(allocated_extent(image.extent, image.allocated)),
    };
    let before = errors.len();
    images::check(&image, described, errors);
    (errors.len() == before).then_some(image)
}
