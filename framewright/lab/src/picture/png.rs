//! PNG: what people look at, and signals for displays.

use super::data::{EncodingError, Picture};
use super::texel;
use framewright_graph::vulkan::Encoding;
use png::chunk::ChunkType;
use png::{BitDepth, ColorType, Compression, Encoder, SrgbRenderingIntent};

/// Coding-independent code points (ITU-T H.273): primaries of Rec. 2020, the curve of SMPTE ST 2084, no matrix, full range.
const HDR10: [u8; 4] = [9, 16, 0, 1];

/// Writes the file.
pub(super) fn write(picture: &Picture<'_>) -> Result<Vec<u8>, EncodingError> {
    let format = picture.format;
    let encoding = picture.encoding.or_else(|| Encoding::of(format));
    let grey = format.is_depth() || format.components() == 1;
    let channels = if grey { 1 } else { 3 };
    let (depth, samples) = match encoding {
        Some(Encoding::Srgb | Encoding::Unorm | Encoding::Hdr10) => stored(picture, channels)?,
        Some(Encoding::Linear) | None => (BitDepth::Eight, shown(picture, channels)?),
    };
    let mut file = Vec::new();
    let [width, height] = picture.extent;
    let mut encoder = Encoder::new(&mut file, width, height);
    encoder.set_color(if grey { ColorType::Grayscale } else { ColorType::Rgb });
    encoder.set_depth(depth);
    encoder.set_compression(Compression::Fast);
    match encoding {
        Some(Encoding::Unorm | Encoding::Hdr10) => {}
        None if format.is_integer() => {}
        Some(Encoding::Srgb | Encoding::Linear) | None => encoder.set_source_srgb(SrgbRenderingIntent::Perceptual),
    }
    let mut writer = encoder.write_header()?;
    if encoding == Some(Encoding::Hdr10) {
        writer.write_chunk(ChunkType(*b"cICP"), &HDR10)?;
    }
    writer.write_image_data(&samples)?;
    writer.finish()?;
    Ok(file)
}

/// Samples as they are stored: 8 bits each where the format has 8, else 16.
fn stored(picture: &Picture<'_>, channels: usize) -> Result<(BitDepth, Vec<u8>), EncodingError> {
    let format = picture.format;
    let wide = picture.texels()?.map(|texel| texel::stored(format, texel).ok_or(EncodingError::NotShares));
    let wide: Vec<[u16; 3]> = wide.collect::<Result<_, _>>()?;
    let wide = wide.iter().flat_map(|texel| &texel[..channels]);
    // 8 bits were widened by 257: either byte is the value.
    Ok(if texel::is_wide(format) {
        (BitDepth::Sixteen, wide.flat_map(|value| value.to_be_bytes()).collect())
    } else {
        (BitDepth::Eight, wide.map(|value| value.to_be_bytes()[0]).collect())
    })
}

/// Bytes as a display shows them. Depth is shown like light, as a share of the image's own largest value.
fn shown(picture: &Picture<'_>, channels: usize) -> Result<Vec<u8>, EncodingError> {
    let (format, texels) = (picture.format, picture.texels()?);
    if format.is_depth() {
        let depths: Vec<f32> = texels.map(|texel| texel::depth(format, texel)).collect();
        let largest = depths.iter().copied().fold(0.0, f32::max);
        return Ok(depths.into_iter().map(|depth| texel::encode(depth / largest)).collect());
    }
    Ok(texels.flat_map(|texel| texel::shown(format, texel).into_iter().take(channels)).collect())
}
