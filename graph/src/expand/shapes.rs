//! Shape, layers and mip levels of an image, and their contradictions.

use crate::base::Diagnostic;
use crate::frame::Image;
use crate::language::{self, Decided, ImageShape as Described, Layers, Lifetime};
use crate::vulkan::Shape;

/// How many mip levels are asked for.
#[derive(Clone, Copy)]
pub(super) enum Levels {
    Count(u32),
    /// Down to a single texel.
    Full,
}

/// Array layers of an image that follows `followed`, or none.
pub(super) fn layers(image: &language::Image, followed: Option<u32>) -> Option<u32> {
    match image.layers.value {
        Layers::Default if image.shape.value == Described::Cube => Some(6),
        Layers::Default => Some(1),
        Layers::Count(count) => Some(count),
        Layers::Like(_) => followed,
    }
}

/// Mip levels from the largest down to a single texel.
const fn full(extent: [u32; 3]) -> u32 {
    let [width, height, depth] = extent;
    (width | height | depth).ilog2() + 1
}

/// A mistake in a property of an image, with the decision that made the property.
#[track_caller]
fn at<T>(property: &Decided<T>, message: String) -> Diagnostic {
    Diagnostic::new(property.span, message).remark(property.remark())
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
    let most = full(image.extent);
    image.mips = match levels {
        Levels::Count(count) => count,
        Levels::Full => most,
    };
    let name = &image.name;
    let [width, height, depth] = image.extent;
    let before = errors.len();
    if image.mips > most {
        let extent = if depth > 1 { format!("{width}×{height}×{depth}") } else { format!("{width}×{height}") };
        let message = format!("`{name}` can't have {} mip levels: {extent} texels have {most}", image.mips);
        errors.push(at(&described.mips, message).help("write `Full`: as many as there are"));
    }
    if image.shape == Shape::Cube && width != height {
        let message = format!("`{name}` is a cube, but its sides are {width}×{height}");
        errors.push(at(&described.size, message).help("the sides of a cube are square"));
    }
    if image.shape == Shape::Cube && !layers.is_multiple_of(6) {
        let message = format!("`{name}` is a cube and can't have {layers} layers");
        errors.push(at(&described.layers, message).help("write `6`, or `12` for two cubes, and so on"));
    }
    if image.shape == Shape::D3 && layers > 1 {
        let message = format!("`{name}` is three-dimensional and can't have {layers} layers");
        errors.push(at(&described.layers, message).label(described.shape.span, "its shape"));
    }
    if image.shape == Shape::D3 && image.format.is_depth() {
        let message = format!("`{name}` is three-dimensional and can't hold depth ({})", image.format);
        errors.push(at(&described.format, message).label(described.shape.span, "its shape"));
    }
    if image.allocated.is_some() {
        let alone = [
            (image.shape != Shape::D2, described.shape.span, "its shape"),
            (image.mips > 1, described.mips.span, "its mip levels"),
            (!matches!(described.lifetime.value, Lifetime::Transient), described.lifetime.span, "its lifetime"),
        ];
        if let Some((_, span, remark)) = alone.into_iter().find(|(wrong, ..)| *wrong) {
            let message =
                format!("`{name}` changes its size, so it is transient, two-dimensional and has one mip level");
            errors.push(at(&described.size, message).label(span, remark));
        }
    }
    if image.samples > 1 {
        let samples = image.samples;
        let alone = if image.shape == Shape::D2 { None } else { Some((described.shape.span, "its shape")) };
        let alone = alone.or((image.mips > 1).then_some((described.mips.span, "its mip levels")));
        if let Some((span, remark)) = alone {
            let message = format!("`{name}` has {samples} samples, so it is two-dimensional and has one mip level");
            errors.push(at(&described.samples, message).label(span, remark));
        }
    }
    (errors.len() == before).then_some(image)
}
