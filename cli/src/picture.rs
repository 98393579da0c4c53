//! Texels of any format as a PNG that people look at.
//!
//! Colour is shown as a display would show it: clamped to 0…1 and encoded with the sRGB curve, NaN as 0; bytes that are
//! encoded already stay as they are. Alpha is left out, since what lies on a screen is opaque. Depth is shown like light,
//! as a share of the image's own largest value: with reversed depth the nearest texel is white and infinitely far is black.
//! Integers are greys or colours of their own value, at
//! most 255. Images of fewer than three components are grey.

use framewright_graph::format::{Format, Numeric};
use image::error::{ImageError, ParameterError, ParameterErrorKind};
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

/// The PNG of `texels`, rows from the top without padding, in the machine's byte order. Of depth-stencil formats they hold
/// the depth alone.
///
/// # Errors
/// If there are fewer than `width` × `height` texels (those of further layers and slices are left out), or the encoder
/// fails.
pub(crate) fn png(format: Format, width: u32, height: u32, texels: &[u8]) -> Result<Vec<u8>, ImageError> {
    let grey = format.is_depth() || format.components() < 3;
    let texel_bytes = if format == Format::D32_SFLOAT_S8_UINT { 4 } else { format.texel_bytes() };
    let texel_bytes = usize::try_from(texel_bytes).unwrap_or(usize::MAX);
    let channels = if grey { 1 } else { 3 };
    let count = width as usize * height as usize;
    let texels = texels.chunks_exact(texel_bytes).take(count);
    let shown: Vec<u8> = if format.is_depth() {
        let depths: Vec<f32> = texels.map(|texel| depth(format, texel)).collect();
        let largest = depths.iter().copied().fold(0.0, f32::max);
        depths.into_iter().map(|depth| encode(depth / largest)).collect()
    } else {
        texels.flat_map(|texel| shown(format, texel).into_iter().take(channels)).collect()
    };
    if shown.len() != count * channels {
        return Err(ImageError::Parameter(ParameterError::from_kind(ParameterErrorKind::DimensionMismatch)));
    }
    let color = if grey { ExtendedColorType::L8 } else { ExtendedColorType::Rgb8 };
    let mut file = Vec::new();
    PngEncoder::new(&mut file).write_image(&shown, width, height, color)?;
    Ok(file)
}

/// Red, green and blue of one texel; a grey is in the first.
fn shown(format: Format, texel: &[u8]) -> [u8; 3] {
    use Format as F;
    let half = |at: usize| half(u16::from_ne_bytes([texel[at], texel[at + 1]]));
    let word = |at: usize| u32::from_ne_bytes([texel[at], texel[at + 1], texel[at + 2], texel[at + 3]]);
    let float = |at: usize| f32::from_bits(word(at));
    let unorm = |byte: u8| f32::from(byte) / 255.0;
    let word16 = |at: usize| f32::from(u16::from_ne_bytes([texel[at], texel[at + 1]])) / 65535.0;
    match format {
        F::R8G8B8A8_SRGB => [texel[0], texel[1], texel[2]],
        F::B8G8R8A8_SRGB => [texel[2], texel[1], texel[0]],
        F::R8_UINT => [texel[0], 0, 0],
        F::R8G8B8A8_UINT => [texel[0], texel[1], texel[2]],
        F::R32_UINT => [integer(word(0)), 0, 0],
        F::R32G32B32A32_UINT => [0, 4, 8].map(|at| integer(word(at))),
        F::R8_UNORM | F::R8G8_UNORM => [unorm(texel[0]), 0.0, 0.0].map(encode),
        F::R8G8B8A8_UNORM => [texel[0], texel[1], texel[2]].map(unorm).map(encode),
        F::B8G8R8A8_UNORM => [texel[2], texel[1], texel[0]].map(unorm).map(encode),
        F::A2B10G10R10_UNORM_PACK32 => [0, 10, 20].map(|shift| encode(bits(word(0), shift, 10))),
        F::R16G16B16A16_UNORM => [0, 2, 4].map(word16).map(encode),
        F::R16_SFLOAT | F::R16G16_SFLOAT => [half(0), 0.0, 0.0].map(encode),
        F::R16G16B16A16_SFLOAT => [half(0), half(2), half(4)].map(encode),
        F::R32_SFLOAT | F::R32G32_SFLOAT => [float(0), 0.0, 0.0].map(encode),
        F::R32G32B32A32_SFLOAT => [float(0), float(4), float(8)].map(encode),
        F::B10G11R11_UFLOAT_PACK32 => {
            // Halves without sign, cut short: 6 and 5 bits of mantissa.
            let cut = |shift: u32, count: u32| {
                let value = (word(0) >> shift) & ((1 << count) - 1);
                self::half(u16::try_from(value << (15 - count)).unwrap_or(u16::MAX))
            };
            [cut(0, 11), cut(11, 11), cut(22, 10)].map(encode)
        }
        F::D16_UNORM | F::X8_D24_UNORM_PACK32 | F::D32_SFLOAT | F::D24_UNORM_S8_UINT | F::D32_SFLOAT_S8_UINT => {
            [encode(depth(format, texel)); 3]
        }
    }
}

/// The depth of one texel of a depth format.
fn depth(format: Format, texel: &[u8]) -> f32 {
    match *texel {
        [a, b] => f32::from(u16::from_ne_bytes([a, b])) / 65535.0,
        [a, b, c, d] if format.numeric() == Numeric::Unorm => bits(u32::from_ne_bytes([a, b, c, d]), 0, 24),
        [a, b, c, d] => f32::from_ne_bytes([a, b, c, d]),
        _ => 0.0,
    }
}

/// `count` bits of `word` from `shift` on, as a value 0…1.
#[allow(clippy::cast_precision_loss, reason = "at most 24 bits, which an f32 holds exactly")]
fn bits(word: u32, shift: u32, count: u32) -> f32 {
    let most = (1 << count) - 1;
    ((word >> shift) & most) as f32 / most as f32
}

/// A linear value 0…1 through the sRGB curve (IEC 61966-2-1), as a byte; NaN as 0.
fn encode(linear: f32) -> u8 {
    let linear = if linear > 0.0 { f64::from(linear.min(1.0)) } else { 0.0 };
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0…255")]
    let byte = (encoded * 255.0).round() as u8;
    byte
}

fn integer(value: u32) -> u8 {
    u8::try_from(value).unwrap_or(u8::MAX)
}

/// A 16-bit float (IEEE 754 binary16).
fn half(bits: u16) -> f32 {
    let sign = if bits & 0x8000 == 0 { 1.0 } else { -1.0 };
    let mantissa = f32::from(bits & 0x3ff);
    sign * match (bits >> 10) & 0x1f {
        0 => mantissa * 2.0_f32.powi(-24),
        31 if mantissa == 0.0 => f32::INFINITY,
        31 => f32::NAN,
        exponent => (1024.0 + mantissa) * 2.0_f32.powi(i32::from(exponent) - 25),
    }
}

/// What a picture of the format doesn't show of the image's values, in words for the user.
#[must_use]
pub(crate) fn loses(format: Format) -> Option<&'static str> {
    match format.numeric() {
        _ if format.is_depth() => Some("the nearest texel is white"),
        Numeric::Sfloat | Numeric::Ufloat => Some("values outside 0…1 are clamped"),
        Numeric::Uint => Some("values above 255 are clamped"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_mean_what_ieee_754_says() {
        for (bits, value) in [
            (0x0000, 0.0),
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x7bff, 65504.0),
            (0x0001, 5.960_464_5e-8),
            (0x3555, 0.333_251_95),
        ] {
            assert_eq!(half(bits), value, "{bits:#06x}");
        }
        assert_eq!(half(0x7c00), f32::INFINITY);
        assert!(half(0x7e00).is_nan());
    }

    #[test]
    fn light_outside_what_a_display_shows_is_clamped_and_nan_is_black() {
        assert_eq!([f32::NAN, -1.0, 0.0, 1.0, 100.0, f32::INFINITY].map(encode), [0, 0, 0, 255, 255, 255]);
        assert_eq!(encode(0.5), 188);
        assert_eq!(encode(0.001), 3);
    }

    #[test]
    fn one_and_the_same_grey_comes_out_of_every_colour_format() {
        let half = 0x3800_u16.to_ne_bytes();
        let float = 0.5_f32.to_ne_bytes();
        let shown = |format, texel: &[u8]| super::shown(format, texel)[0];
        assert_eq!(shown(Format::R8G8B8A8_SRGB, &[188; 4]), 188);
        assert_eq!(shown(Format::R8G8B8A8_UNORM, &[128; 4]), 188);
        assert_eq!(shown(Format::R16G16B16A16_SFLOAT, &half.repeat(4)), 188);
        assert_eq!(shown(Format::R32G32B32A32_SFLOAT, &float.repeat(4)), 188);
        assert_eq!(shown(Format::A2B10G10R10_UNORM_PACK32, &512_u32.to_ne_bytes()), 188);
        // 0.5 is exponent 14 in both small floats.
        assert_eq!(
            super::shown(Format::B10G11R11_UFLOAT_PACK32, &((14 << 6) | (14 << 17) | (14_u32 << 27)).to_ne_bytes()),
            [188; 3]
        );
    }

    #[test]
    fn the_nearest_depth_is_white_and_infinitely_far_is_black() {
        let depths: Vec<u8> = [0.02_f32, 0.01, 0.0].iter().flat_map(|depth| depth.to_ne_bytes()).collect();
        let file = png(Format::D32_SFLOAT, 3, 1, &depths).expect("a picture");
        assert_eq!(image::load_from_memory(&file).expect("a PNG").into_luma8().into_raw(), [255, 188, 0]);
        let nothing = png(Format::D32_SFLOAT, 1, 1, &[0; 4]).expect("a picture");
        assert_eq!(image::load_from_memory(&nothing).expect("a PNG").into_luma8().into_raw(), [0]);
    }

    #[test]
    fn blue_and_red_stay_apart_whatever_their_order_in_memory() {
        assert_eq!(shown(Format::R8G8B8A8_SRGB, &[1, 2, 3, 4]), [1, 2, 3]);
        assert_eq!(shown(Format::B8G8R8A8_SRGB, &[1, 2, 3, 4]), [3, 2, 1]);
        assert_eq!(shown(Format::B8G8R8A8_UNORM, &[0, 0, 255, 0]), [255, 0, 0]);
    }

    #[test]
    fn every_format_gives_a_picture_of_its_size() {
        for format in Format::ALL {
            let bytes = if *format == Format::D32_SFLOAT_S8_UINT { 4 } else { format.texel_bytes() };
            let texels = vec![0x3f; usize::try_from(bytes * 6).expect("few")];
            let file = png(*format, 3, 2, &texels).expect("a picture");
            let picture = image::load_from_memory(&file).expect("a PNG");
            assert_eq!((picture.width(), picture.height()), (3, 2), "{format}");
        }
    }

    #[test]
    fn too_few_texels_are_refused() {
        assert!(png(Format::R8G8B8A8_SRGB, 2, 2, &[0; 12]).is_err());
    }
}
