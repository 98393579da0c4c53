//! Decodes one texel of any format.

use framewright_graph::vulkan::{Format, Numeric};
use framewright_passes::srgb;
use half::f16;

/// Bytes of one texel that was read back. Formats of depth and stencil have the depth alone.
pub(super) fn bytes(format: Format) -> usize {
    let bytes = if format == Format::D32_SFLOAT_S8_UINT { 4 } else { format.texel_bytes() };
    usize::try_from(bytes).unwrap_or(usize::MAX)
}

/// Red, green and blue of one texel as a display shows them; a grey is in the first.
pub(super) fn shown(format: Format, texel: &[u8]) -> [u8; 3] {
    use Format as F;
    let half = |at: usize| f16::from_ne_bytes([texel[at], texel[at + 1]]).to_f32();
    let word = |at: usize| u32::from_ne_bytes([texel[at], texel[at + 1], texel[at + 2], texel[at + 3]]);
    let float = |at: usize| f32::from_bits(word(at));
    let unorm = |byte: u8| f32::from(byte) / 255.0;
    match format {
        F::R8G8B8A8_SRGB => [texel[0], texel[1], texel[2]],
        F::B8G8R8A8_SRGB => [texel[2], texel[1], texel[0]],
        F::B8G8R8A8_UNORM => [texel[2], texel[1], texel[0]].map(unorm).map(encode),
        F::A2B10G10R10_UNORM_PACK32 => [0, 10, 20].map(|shift| encode(bits(word(0), shift, 10))),
        F::A2R10G10B10_UNORM_PACK32 => [20, 10, 0].map(|shift| encode(bits(word(0), shift, 10))),
        F::E5B9G9R9_UFLOAT_PACK32 => shared_exponent(word(0)).map(encode),
        F::R16_SFLOAT => [half(0), 0.0, 0.0].map(encode),
        F::R16G16_SFLOAT => [half(0), half(2), 0.0].map(encode),
        F::R16G16B16A16_SFLOAT => [half(0), half(2), half(4)].map(encode),
        F::R32_SFLOAT => [float(0), 0.0, 0.0].map(encode),
        F::R32G32_SFLOAT => [float(0), float(4), 0.0].map(encode),
        F::R32G32B32A32_SFLOAT => [float(0), float(4), float(8)].map(encode),
        F::B10G11R11_UFLOAT_PACK32 => [(0, 11), (11, 11), (22, 10)]
            .map(|(shift, count)| encode(f16::from_bits(cut(word(0), shift, count)).to_f32())),
        F::D16_UNORM | F::X8_D24_UNORM_PACK32 | F::D32_SFLOAT | F::D24_UNORM_S8_UINT | F::D32_SFLOAT_S8_UINT => {
            [encode(depth(format, texel)); 3]
        }
        // All others have components of one size, in order.
        _ => {
            let shown = if format.is_integer() { integer } else { encode };
            let components = format.components() as usize;
            std::array::from_fn(|at| if at < components { shown(component(format, texel, at)) } else { 0 })
        }
    }
}

/// A component of one texel of a format whose components have one size, in order, and are fixed-point numbers or integers.
#[allow(clippy::cast_precision_loss, reason = "a picture shows no more")]
pub(super) fn component(format: Format, texel: &[u8], number: usize) -> f32 {
    let value = whole(format, texel, number);
    let bytes = texel.len() / format.components() as usize;
    let bits = 8 * u32::try_from(bytes).unwrap_or(4);
    match format.numeric() {
        Numeric::Unorm => value as f32 / ((1_i64 << bits) - 1) as f32,
        Numeric::Snorm => (value as f32 / ((1_i64 << (bits - 1)) - 1) as f32).max(-1.0),
        _ => value as f32,
    }
}

/// The bits of a component of such a format as a whole number.
pub(super) fn whole(format: Format, texel: &[u8], number: usize) -> i64 {
    let bytes = texel.len() / format.components() as usize;
    let signed = matches!(format.numeric(), Numeric::Snorm | Numeric::Sint);
    match (texel.get(number * bytes..(number + 1) * bytes).unwrap_or_default(), signed) {
        (&[a], false) => i64::from(a),
        (&[a], true) => i64::from(a.cast_signed()),
        (&[a, b], false) => i64::from(u16::from_ne_bytes([a, b])),
        (&[a, b], true) => i64::from(i16::from_ne_bytes([a, b])),
        (&[a, b, c, d], false) => i64::from(u32::from_ne_bytes([a, b, c, d])),
        (&[a, b, c, d], true) => i64::from(i32::from_ne_bytes([a, b, c, d])),
        _ => 0,
    }
}

/// The half that `count` bits of `word` from `shift` on are: one without a sign, cut short to 6 or 5 bits of mantissa.
pub(super) fn cut(word: u32, shift: u32, count: u32) -> u16 {
    let value = (word >> shift) & ((1 << count) - 1);
    u16::try_from(value << (15 - count)).unwrap_or(u16::MAX)
}

/// Red, green and blue of three mantissas of 9 bits with one exponent.
#[allow(clippy::cast_precision_loss, reason = "9 bits, which an f32 holds exactly")]
pub(super) fn shared_exponent(word: u32) -> [f32; 3] {
    let scale = 2_f32.powi((word >> 27).cast_signed() - 24);
    [0, 9, 18].map(|shift| ((word >> shift) & 511) as f32 * scale)
}

/// The depth of one texel of a depth format.
pub(super) fn depth(format: Format, texel: &[u8]) -> f32 {
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

/// Whether shares of colour are stored in more than 8 bits.
pub(super) fn is_wide(format: Format) -> bool {
    use Format as F;
    matches!(
        format,
        F::A2R10G10B10_UNORM_PACK32
            | F::A2B10G10R10_UNORM_PACK32
            | F::R16_UNORM
            | F::R16G16_UNORM
            | F::R16G16B16A16_UNORM
    )
}

/// Red, green and blue of one texel as they are stored, as shares of 65535; a grey is in the first. `None` of formats that
/// don't hold shares from 0 to 1 of colour.
pub(super) fn stored(format: Format, texel: &[u8]) -> Option<[u16; 3]> {
    use Format as F;
    let byte = |byte: u8| u16::from(byte) * 257;
    let short = |at: usize| u16::from_ne_bytes([texel[at], texel[at + 1]]);
    let ten = |shift: u32| {
        let word = u32::from_ne_bytes([texel[0], texel[1], texel[2], texel[3]]);
        u16::try_from((((word >> shift) & 1023) * 65535 + 511) / 1023).unwrap_or(u16::MAX)
    };
    Some(match format {
        F::R8_UNORM => [byte(texel[0]), 0, 0],
        F::R8G8_UNORM => [byte(texel[0]), byte(texel[1]), 0],
        F::R8G8B8A8_UNORM | F::R8G8B8A8_SRGB => [texel[0], texel[1], texel[2]].map(byte),
        F::B8G8R8A8_UNORM | F::B8G8R8A8_SRGB => [texel[2], texel[1], texel[0]].map(byte),
        F::A2R10G10B10_UNORM_PACK32 => [20, 10, 0].map(ten),
        F::A2B10G10R10_UNORM_PACK32 => [0, 10, 20].map(ten),
        F::R16_UNORM => [short(0), 0, 0],
        F::R16G16_UNORM => [short(0), short(2), 0],
        F::R16G16B16A16_UNORM => [0, 2, 4].map(short),
        _ => return None,
    })
}

/// A linear value 0…1 through the sRGB curve (IEC 61966-2-1), as a byte; NaN as 0.
pub(super) fn encode(linear: f32) -> u8 {
    let linear = if linear > 0.0 { f64::from(linear.min(1.0)) } else { 0.0 };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0…255")]
    let byte = (srgb::encode(linear) * 255.0).round() as u8;
    byte
}

/// An integer as a byte, clamped.
fn integer(value: f32) -> u8 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, as it should")]
    let byte = value as u8;
    byte
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn signed_and_wide_formats_show_what_a_picture_can() {
        assert_eq!(shown(Format::R16_UNORM, &0x8000_u16.to_ne_bytes()), [188, 0, 0]);
        assert_eq!(shown(Format::R8G8B8A8_SNORM, &[0x40, 0x81, 0x7f, 0]), [188, 0, 255]);
        assert_eq!(shown(Format::R16G16B16A16_SINT, &[9, 0, 0xff, 0xff, 0, 1, 0, 0]), [9, 0, 255]);
        assert_eq!(shown(Format::R32G32_UINT, &[7, 0, 0, 0, 8, 0, 0, 0]), [7, 8, 0]);
    }

    #[test]
    fn blue_and_red_stay_apart_whatever_their_order_in_memory() {
        assert_eq!(shown(Format::R8G8B8A8_SRGB, &[1, 2, 3, 4]), [1, 2, 3]);
        assert_eq!(shown(Format::B8G8R8A8_SRGB, &[1, 2, 3, 4]), [3, 2, 1]);
        assert_eq!(shown(Format::B8G8R8A8_UNORM, &[0, 0, 255, 0]), [255, 0, 0]);
    }
}
