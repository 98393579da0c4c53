//! Errors as a picture.

use crate::picture::{EncodingError, FileFormat, Picture};
use framewright_graph::vulkan::Format;

/// A PNG of FLIP's values from 0, which is black, to 1, which is nearly white, in the colours of `magma`.
///
/// # Errors
/// If the encoder fails.
pub fn heat_map(flip: &[f64], [width, height]: [u32; 2]) -> Result<Vec<u8>, EncodingError> {
    let texel = |value: &f64| {
        let color = colorous::MAGMA.eval_continuous(value.clamp(0.0, 1.0));
        [color.r, color.g, color.b, u8::MAX]
    };
    let bytes: Vec<u8> = flip.iter().flat_map(texel).collect();
    let picture = Picture { format: Format::R8G8B8A8_SRGB, encoding: None, extent: [width, height], bytes: &bytes };
    FileFormat::Png.encode(&picture)
}
