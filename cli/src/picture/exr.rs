//! OpenEXR: every number of a floating-point image, bit for bit. Colours are linear light with the primaries of Rec. 709,
//! which is what a file means that says nothing else.

use super::data::{EncodingError, Picture};
use super::texel;
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, SmallVec, WritableImage, f16};
use framewright_graph::vulkan::Format;
use std::io::Cursor;

/// Channels by the number of components.
const NAMES: [&[&str]; 4] = [&["Y"], &["R", "G"], &["R", "G", "B"], &["R", "G", "B", "A"]];

/// Whether a file can hold what an image of the format holds.
pub(super) fn holds(format: Format) -> bool {
    samples(format, &[]).is_some()
}

/// Writes the file.
pub(super) fn write(picture: &Picture<'_>) -> Result<Vec<u8>, EncodingError> {
    let format = picture.format;
    let bytes = picture.texels()?.flatten().copied().collect::<Vec<u8>>();
    let samples = samples(format, &bytes).ok_or(EncodingError::NotFloats)?;
    let names = if format.is_depth() { &["Z"] } else { NAMES[samples.len().clamp(1, 4) - 1] };
    let channels = names.iter().zip(samples).map(|(name, samples)| AnyChannel::new(*name, samples));
    let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = channels.collect();
    let [width, height] = picture.extent.map(|size| size as usize);
    let image = Image::from_channels((width, height), AnyChannels::sort(channels));
    let mut file = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut file)?;
    Ok(file.into_inner())
}

/// The samples of each component; `None` if they aren't floating-point numbers.
fn samples(format: Format, bytes: &[u8]) -> Option<Vec<FlatSamples>> {
    use Format as F;
    let texels = || bytes.chunks_exact(texel::bytes(format));
    let halves = |at: usize| {
        FlatSamples::F16(texels().map(|it| f16::from_bits(u16::from_ne_bytes([it[at], it[at + 1]]))).collect())
    };
    let floats = |at: usize| {
        let float = |it: &[u8]| f32::from_ne_bytes([it[at], it[at + 1], it[at + 2], it[at + 3]]);
        FlatSamples::F32(texels().map(float).collect())
    };
    let small = |(shift, bits): (u32, u32)| {
        let half =
            |it: &[u8]| f16::from_bits(texel::cut(u32::from_ne_bytes([it[0], it[1], it[2], it[3]]), shift, bits));
        FlatSamples::F16(texels().map(half).collect())
    };
    Some(match format {
        F::R16_SFLOAT => vec![halves(0)],
        F::R16G16_SFLOAT => [0, 2].map(halves).into(),
        F::R16G16B16A16_SFLOAT => [0, 2, 4, 6].map(halves).into(),
        F::R32_SFLOAT | F::D32_SFLOAT | F::D32_SFLOAT_S8_UINT => vec![floats(0)],
        F::R32G32_SFLOAT => [0, 4].map(floats).into(),
        F::R32G32B32A32_SFLOAT => [0, 4, 8, 12].map(floats).into(),
        F::B10G11R11_UFLOAT_PACK32 => [(0, 11), (11, 11), (22, 10)].map(small).into(),
        _ => return None,
    })
}
