//! Properties of an image in expressions: its size, mip levels, layers and samples, as soon as it is evaluated.

use crate::base::Diagnostic;
use crate::language::model::{Image, ImageRef, ImageShape, Layers, Mips, Samples, Size, area};
use crate::language::scope::{Properties, ScopeValues};

/// Properties of an image that is evaluated in `scope`.
pub(crate) fn of(image: &Image, scope: &ScopeValues<'_>) -> Result<Properties, Diagnostic> {
    let (known, frame) = (scope.properties.unwrap_or_default(), scope.surroundings.extent);
    let followed = |of: &ImageRef| known.get(of.index.0 as usize).copied().flatten().unwrap_or_default();
    let follows = match &image.size.value {
        Size::Like(of) | Size::Scaled { of: Some(of), .. } | Size::Dynamic { of: Some(of), .. } => followed(of).area,
        _ => None,
    };
    let area = area(image, frame, follows)?;
    let samples = match &image.samples.value {
        Samples::Count(count) => Some(*count),
        Samples::Like(of) => followed(of).samples,
    };
    let layers = match &image.layers.value {
        Layers::Default if image.shape.value == ImageShape::Cube => Some(6),
        Layers::Default => Some(1),
        Layers::Count(count) => Some(*count),
        Layers::Like(of) => followed(of).layers,
    };
    let depth = if let ImageShape::D3(depth) = image.shape.value { depth } else { 1 };
    let mips = match &image.mips.value {
        Mips::Count(count) => Some(*count),
        Mips::Full => area.map(|area| {
            let [width, height] = area.allocated.unwrap_or(area.extent);
            (width | height | depth).max(1).ilog2() + 1
        }),
        Mips::Like(of) => followed(of).mips,
    };
    Ok(Properties { area, mips, layers, samples })
}
