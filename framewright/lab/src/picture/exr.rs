//! OpenEXR: every number of a floating-point image, bit for bit, and every integer. Colours are linear light with the primaries of Rec. 709,
//! which is what a file means that says nothing else.

use super::data::{EncodingError, Picture};
use super::texel;
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, SmallVec, WritableImage, f16};
use framewright_graph::vulkan::{Format, Numeric};
use std::io::Cursor;

/// Channels by the number of components.
const NAMES: [&[&str]; 4] = [&["Y"], &["R", "G"], &["R", "G", "B"], &["R", "G", "B", "A"]];

/// Whether a file can hold what an image of the format holds.
pub(super) fn holds(format: Format) -> bool {
    format.is_integer() || samples(format, &[]).is_some()
}

/// Writes the file.
pub(super) fn write(picture: &Picture<'_>) -> Result<Vec<u8>, EncodingError> {
    let format = picture.format;
    let bytes = picture.texels()?.flatten().copied().collect::<Vec<u8>>();
    let samples = match format.is_integer() {
        true => integers(format, &bytes),
        false => samples(format, &bytes).ok_or(EncodingError::IsShares)?,
    };
    let names = if format.is_depth() { &["Z"] } else { NAMES[samples.len().clamp(1, 4) - 1] };
    let channels = names.iter().zip(samples).map(|(name, samples)| AnyChannel::new(*name, samples));
    let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = channels.collect();
    let [width, height] = picture.extent.map(|size| size as usize);
    let image = Image::from_encoded_channels((width, height), Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels));
    let mut file = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut file)?;
    Ok(file.into_inner())
}

/// Whether a file holds the integers of an image as 32 bits in two's complement: a negative number is 2³² more there.
pub(super) fn wraps(format: Format, bytes: &[u8]) -> bool {
    let size = texel::bytes(format);
    let all = || bytes.chunks_exact(size).flat_map(|it| (0..format.components() as usize).map(move |at| (it, at)));
    let whole = |(it, at): (&[u8], usize)| texel::whole(format, it, at);
    format.numeric() == Numeric::Sint && !all().map(whole).all(is_exact) && all().map(whole).any(|value| value < 0)
}

/// Whether a 32-bit float holds an integer.
fn is_exact(value: i64) -> bool {
    (-(1 << 24)..=1 << 24).contains(&value)
}

/// The integers of each component: OpenEXR has them without a sign. What has one is written as floats where those hold all values, else
/// in two's complement.
#[allow(clippy::cast_precision_loss, reason = "only what a float holds")]
fn integers(format: Format, bytes: &[u8]) -> Vec<FlatSamples> {
    let texels = || bytes.chunks_exact(texel::bytes(format));
    let component = |at: usize| texels().map(move |it| texel::whole(format, it, at));
    let components = 0..format.components() as usize;
    let is_signed = format.numeric() == Numeric::Sint;
    if is_signed && components.clone().all(|at| component(at).all(is_exact)) {
        return components.map(|at| FlatSamples::F32(component(at).map(|value| value as f32).collect())).collect();
    }
    // The lower half of a negative number is its two's complement.
    let word = |value: i64| u32::try_from(value & i64::from(u32::MAX)).unwrap_or_default();
    components.map(|at| FlatSamples::U32(component(at).map(word).collect())).collect()
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
